// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Colour maps that colour-blind people can read, and in which brighter always means more.

// Every sixteenth of the way; viridis and cividis (CC0), between them straight.
const STOPS = {
  viridis: "440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30 d8e219 fde725",
  cividis: "00224e 002e6a 1a386f 32436d 434e6c 535a6d 61656f 6f7073 7d7c78 8c8878 9b9476 aba072 bcae6c cdbb63 dec958 f0d846 fee838",
  greys: "141414 ffffff",
};

/** Length of a table. */
export const STEPS = 1024;

const tables = new Map();

/** The colours of a map from nothing to the top of the scale, each as the four bytes of a pixel. */
export function table(name) {
  if (!tables.has(name)) tables.set(name, made(STOPS[name].split(" ")));
  return tables.get(name);
}

/** The map as a background of CSS, from left to right. */
export function gradient(name) {
  return `linear-gradient(to right, ${STOPS[name].split(" ").map((stop) => `#${stop}`).join(", ")})`;
}

function made(stops) {
  const parts = stops.map((stop) => [0, 2, 4].map((at) => parseInt(stop.slice(at, at + 2), 16)));
  const bytes = new Uint8ClampedArray(4 * STEPS);
  for (let step = 0; step < STEPS; step += 1) {
    const way = (step / (STEPS - 1)) * (parts.length - 1);
    const index = Math.min(Math.floor(way), parts.length - 2);
    const share = way - index;
    for (let part = 0; part < 3; part += 1) {
      bytes[4 * step + part] = parts[index][part] * (1 - share) + parts[index + 1][part] * share;
    }
    bytes[4 * step + 3] = 255;
  }
  return new Uint32Array(bytes.buffer);
}
