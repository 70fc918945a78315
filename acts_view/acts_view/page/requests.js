// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the page asks the server for, and what is answered.

const PATIENCE_MS = 15000;

let send = () => false;
let number = 0;
const waiting = new Map();

/** Ask through this from now on. */
export function useConnection(sender) {
  send = sender;
}

/** Ask for something; resolves to {done, text}, whatever happens. */
export function ask(what, details = {}) {
  number += 1;
  const id = number;
  if (!send({ id, do: what, ...details })) return Promise.resolve({ done: false, text: "the server is gone" });
  return new Promise((resolve) => {
    const timer = setTimeout(() => settle(id, { done: false, text: "the server did not answer" }), PATIENCE_MS);
    waiting.set(id, { resolve, timer });
  });
}

/** An answer has come. */
export function answered(message) {
  settle(message.id, { done: message.done, text: message.text });
}

/** The connection is lost: nothing that waits will be answered. */
export function forgetAll() {
  for (const id of waiting.keys()) settle(id, { done: false, text: "the connection was lost before the answer" });
}

function settle(id, answer) {
  const one = waiting.get(id);
  if (!one) return;
  waiting.delete(id);
  clearTimeout(one.timer);
  one.resolve(answer);
}
