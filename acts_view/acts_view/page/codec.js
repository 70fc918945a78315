// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Messages from the server: a JSON header and typed arrays. acts_view/web/codec.py describes and writes them.

const TYPES = { uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array, float32: Float32Array };

/** The header of a message, each of its arrays as {data, shape} under its name in `arrays`. */
export function decode(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const arrays = {};
  let at = 4 + length;
  for (const [name, type, shape] of header.arrays) {
    const data = new TYPES[type](buffer, at, shape.reduce((product, side) => product * side, 1));
    arrays[name] = { data, shape };
    at += Math.ceil(data.byteLength / 4) * 4;
  }
  return { ...header, arrays };
}
