// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Files from the server, and to the person's disk.

import { socketUrl } from "./connection.js";

const WHOLE = 1000; // how a socket is closed behind a file that is whole
const SILENT_MS = 15000; // a server that sends nothing for so long is gone, as after this machine was asleep

/** A file from the server, by a socket of its own, since that is where the server checks who asks; onSent(bytes) meanwhile. */
export function fetchFile(path, onSent) {
  const socket = new WebSocket(socketUrl(path));
  socket.binaryType = "blob"; // the browser may keep it on disk
  return new Promise((resolve, reject) => {
    const pieces = [];
    let sent = 0;
    let watchdog = 0;
    const fail = () => {
      socket.close();
      reject(new Error("the server did not send it to its end; try again"));
    };
    const heard = () => {
      clearTimeout(watchdog);
      watchdog = setTimeout(fail, SILENT_MS);
    };
    heard();
    socket.onmessage = ({ data }) => {
      heard();
      pieces.push(data);
      sent += data.size;
      onSent(sent);
    };
    socket.onclose = ({ code }) => {
      clearTimeout(watchdog);
      if (code === WHOLE) resolve(held(new Blob(pieces)));
      else fail();
    };
  });
}

/** A file that is complete, unless this browser could not hold all of it, which is seen only where it is read. */
async function held(file) {
  try {
    await file.slice(-1).arrayBuffer();
  } catch {
    throw new Error("too large for this browser; copy it from the machine that serves this page");
  }
  return file;
}

/** Give pieces of a file to the person, under a name. */
export function save(name, pieces, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(pieces, { type }));
  link.download = name;
  link.click();
  // The browser has begun to read it by then.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
