// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Lists of which what stays is left alone.

/**
 * Children for these keys, in their order, which is always the same: what is there stays where it is, since a person
 * may be about to press it, or typing in it.
 */
export function arrange(parent, keys, make) {
  for (const child of Array.from(parent.children)) if (!keys.includes(child.dataset.key)) child.remove();
  keys.forEach((key, index) => {
    const present = parent.children[index];
    if (present?.dataset.key === key) return;
    const made = make(key);
    made.dataset.key = key;
    parent.insertBefore(made, present ?? null);
  });
}
