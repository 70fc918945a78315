// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the nodes say of themselves: a line each, with what to do, and its values when it is opened.

import { advice } from "./advice.js";
import { setText } from "./words.js";

const LEVELS = ["OK", "Warning", "Error", "Stale"];
const STALE_S = 3;

export class Diagnostics {
  constructor(section) {
    this.section = section;
    this.nodes = new Map();
    this.values = new Map();
  }

  /** The newest of all. */
  show(diagnostics) {
    this.section.hidden = !diagnostics.length;
    this.values = new Map(diagnostics.map(({ name, values }) => [name, values]));
    for (const { name, level, message, age_s } of diagnostics) {
      const isStale = age_s > STALE_S;
      const word = LEVELS[isStale ? 3 : Math.min(level, 3)];
      const node = this.#node(name);
      node.dataset.level = word.toLowerCase();
      setText(node.querySelector(".level"), word);
      setText(node.querySelector(".message"), isStale ? `nothing heard of it for ${Math.round(age_s)} s; before: ${message}` : message);
      setText(node.querySelector(".advice"), advice(word.toLowerCase(), message));
      if (node.open) this.#showValues(name);
    }
    const names = new Set(diagnostics.map(({ name }) => name));
    for (const [name, node] of this.nodes) {
      if (names.has(name)) continue;
      node.remove();
      this.nodes.delete(name);
    }
  }

  #node(name) {
    if (!this.nodes.has(name)) {
      const node = document.createElement("details");
      node.innerHTML = `<summary><span class="level"></span><span class="name"></span><span class="message"></span><span class="advice"></span></summary><dl></dl>`;
      node.querySelector(".name").textContent = name;
      // At once: the server may tell them again only a second later, or be gone.
      node.ontoggle = () => this.#showValues(name);
      const after = [...this.nodes.keys()].filter((other) => other > name).sort()[0];
      this.section.querySelector(".nodes").insertBefore(node, this.nodes.get(after) ?? null);
      this.nodes.set(name, node);
    }
    return this.nodes.get(name);
  }

  #showValues(name) {
    const terms = (this.values.get(name) ?? []).flatMap(([key, value]) => [term("dt", key), term("dd", value)]);
    this.nodes.get(name)?.querySelector("dl").replaceChildren(...terms);
  }
}

function term(kind, words) {
  const element = document.createElement(kind);
  element.textContent = words;
  return element;
}
