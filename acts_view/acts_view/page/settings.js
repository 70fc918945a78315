// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a person has chosen; it survives a reload.

const KEY = "acts_view";
const CHOICES = {
  scale: ["fixed", "adaptive"],
  unit: ["counts", "newtons"],
  colours: ["viridis", "cividis", "greys"],
  window: ["5", "10", "30", "60"],
  smooth: [false, true],
  contacts: [true, false],
  outlines: [true, false],
  unsure: [false, true],
  measured: [false, true],
  theme: ["auto", "light", "dark"],
  keys: [true, false],
};

function load() {
  let kept = {};
  try {
    kept = JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    // Storage is forbidden, or holds something else: the first of the choices.
  }
  const values = {};
  for (const [name, choices] of Object.entries(CHOICES)) {
    values[name] = choices.includes(kept[name]) ? kept[name] : choices[0];
  }
  return values;
}

/** The values in force, by name. */
export const settings = load();

const listeners = [];

/** Call this after every change. */
export function onChange(listener) {
  listeners.push(listener);
}

/** Choose a value. */
export function set(name, value) {
  settings[name] = value;
  try {
    // Another page of this browser may have chosen something else since this one was opened.
    localStorage.setItem(KEY, JSON.stringify({ ...load(), [name]: value }));
  } catch {
    // Not kept, but in force.
  }
  for (const listener of listeners) listener();
}

/** Choose the next of the values. */
export function next(name) {
  const choices = CHOICES[name];
  set(name, choices[(choices.indexOf(settings[name]) + 1) % choices.length]);
}
