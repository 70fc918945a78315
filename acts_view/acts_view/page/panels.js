// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Which skins have a panel: those of the server, and for a while those that only an earlier server had.

import { Panel } from "./skin/panel.js";

const PATIENCE_MS = 5000; // so long a server that was started again may look for its skins

export class Panels {
  /** Panels in `element`; calls onHold() when a person has chosen a part of a plot. */
  constructor(element, onHold) {
    this.element = element;
    this.onHold = onHold;
    this.isHeld = false;
    this.begun_ms = Infinity;
    this.panels = new Map();
    this.offered = new Set();
  }

  get size() {
    return this.panels.size;
  }

  [Symbol.iterator]() {
    return this.panels.values();
  }

  /** The panel of a skin that the server has. */
  of(name) {
    this.offered.add(name);
    if (!this.panels.has(name)) this.#add(name);
    return this.panels.get(name);
  }

  /** The server has skins of these names. */
  offer(names) {
    for (const name of names) this.offered.add(name);
  }

  /** There is a server, maybe another one than before. */
  begin() {
    this.begun_ms = performance.now();
    this.offered.clear();
    for (const one of this) one.forget();
  }

  /** There is none. */
  end() {
    this.begun_ms = Infinity;
  }

  /** Hold what is shown, or go on. */
  hold(isHeld) {
    this.isHeld = isHeld;
    for (const one of this) one.hold(isHeld);
  }

  /** Now and then; see Panel. */
  tick(isStill) {
    if (performance.now() - this.begun_ms > PATIENCE_MS) this.#removeGone();
    for (const [name, one] of this.panels) one.tick(isStill, !this.offered.has(name));
  }

  #add(name) {
    // In their places, so that nothing moves twice.
    this.#removeGone();
    const made = new Panel(name, this.onHold);
    const after = [...this.panels.keys()].filter((other) => other > name).sort()[0];
    this.element.insertBefore(made.element, this.panels.get(after)?.element ?? null);
    this.panels.set(name, made);
    this.element.dataset.count = this.size;
    made.redraw();
    if (this.isHeld) made.hold(true);
  }

  #removeGone() {
    // Of a pause nothing is taken away.
    if (this.isHeld) return;
    for (const [name, one] of this.panels) {
      if (this.offered.has(name)) continue;
      one.remove();
      this.panels.delete(name);
    }
    this.element.dataset.count = this.size;
  }
}
