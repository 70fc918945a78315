// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Numbers in words, where they stand, and how large.

/** With so many digits behind the point; what is rounded to zero has no sign. */
export function rounded(value, digits) {
  const words = value.toFixed(digits);
  return Number(words) === 0 ? (0).toFixed(digits) : words;
}

/** A namespace as it is said: that of the root is empty. */
export function nameOf(namespace) {
  return namespace || "/";
}

/** Let an element say these; one that says so already is not touched, since what changes may be read out. */
export function setText(element, words) {
  if (element.textContent !== words) element.textContent = words;
}

/** How much larger than usual a person has text in this browser: what is drawn does not follow by itself. */
export function textScale() {
  return parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
}
