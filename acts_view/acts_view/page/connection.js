// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The socket to the server: comes back by itself, and notices a server that is silent.

import { decode } from "./codec.js";

const SILENT_MS = 4000; // the server says something every second
const AGAIN_MS = [300, 600, 1200, 2400];

/** Where the server has a socket, beside the page. */
export function socketUrl(path) {
  const url = new URL(path, location.href);
  url.protocol = "ws:";
  url.search = location.search; // the token, if there is one
  return url;
}

async function isServed() {
  try {
    return (await fetch("index.html", { cache: "no-store", signal: AbortSignal.timeout(SILENT_MS) })).ok;
  } catch {
    return false;
  }
}

/**
 * Calls onMessage(message) and onState("connecting" | "live" | "gone" | "refused"); every "live" begins anew; "refused":
 * there is a server, but it takes no socket of this page. Returns send(object), which tells whether there was somebody
 * to send to.
 */
export function connect(onMessage, onState) {
  let tries = 0;
  let present = null;
  let watchdog = 0;

  function open() {
    const socket = new WebSocket(socketUrl("stream"));
    socket.binaryType = "arraybuffer";
    let isOver = false;
    let wasOpen = false;
    const over = async (isClosed = false) => {
      if (isOver) return;
      isOver = true;
      present = null;
      clearTimeout(watchdog);
      socket.close();
      // A browser does not tell why there is no socket; a page that is served tells that there is a server.
      onState(isClosed && !wasOpen && (await isServed()) ? "refused" : "gone");
      setTimeout(open, AGAIN_MS[Math.min(tries, AGAIN_MS.length - 1)]);
      tries += 1;
    };
    const heard = () => {
      clearTimeout(watchdog);
      watchdog = setTimeout(over, SILENT_MS);
    };
    heard();
    socket.onopen = () => {
      tries = 0;
      wasOpen = true;
      present = socket;
      onState("live");
      heard();
    };
    socket.onmessage = (event) => {
      if (isOver) return;
      heard();
      onMessage(decode(event.data));
    };
    socket.onclose = () => over(true);
  }

  onState("connecting");
  open();
  return (content) => {
    present?.send(JSON.stringify(content));
    return present !== null;
  };
}
