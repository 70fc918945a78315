// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Numbers in words.

/** With so many digits behind the point; what is rounded to zero has no sign. */
export function rounded(value, digits) {
  const words = value.toFixed(digits);
  return Number(words) === 0 ? (0).toFixed(digits) : words;
}
