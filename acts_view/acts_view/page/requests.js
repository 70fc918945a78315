// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the page asks the server for, and what is answered.

const PATIENCE_MS = 15000;
const DRIFT_S = 0.001; // from one status to the next, a second later

let send = () => false;
let number = 0;
// The server's clock before this page's, as a message told it that came soonest.
let ahead_s = null;
const waiting = new Map();

/** Ask through this from now on. */
export function useConnection(sender) {
  send = sender;
}

/** The server has told its clock; how much longer that took than at best [s], as where a slow line holds much. */
export function heardClock(clock_s) {
  const told_s = clock_s - performance.now() / 1000;
  // No two clocks are equally fast.
  ahead_s = ahead_s === null ? told_s : Math.max(told_s, ahead_s - DRIFT_S);
  return ahead_s - told_s;
}

/** Ask for something; resolves to {done, text}, whatever happens. */
export function ask(what, details = {}) {
  number += 1;
  const id = number;
  // A line may stand still: the server does not do what comes late.
  const asked_s = ahead_s === null ? null : Number((ahead_s + performance.now() / 1000).toFixed(3));
  if (!send({ id, do: what, asked_s, ...details })) return Promise.resolve({ done: false, text: "the server is gone" });
  return new Promise((resolve) => {
    const timer = setTimeout(() => settle(id, { done: false, text: "the server did not answer; it may still be done" }), PATIENCE_MS);
    waiting.set(id, { resolve, timer });
  });
}

/** An answer has come. */
export function answered(message) {
  settle(message.id, { done: message.done, text: message.text });
}

/** The connection is lost: nothing that waits will be answered. */
export function forgetAll() {
  for (const id of waiting.keys()) settle(id, { done: false, text: "the connection was lost before the answer; it may be done all the same" });
  // Another server may follow.
  ahead_s = null;
}

function settle(id, answer) {
  const one = waiting.get(id);
  if (!one) return;
  waiting.delete(id);
  clearTimeout(one.timer);
  one.resolve(answer);
}
