// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the nodes can be asked for, as far as the server lets a page ask, and what they have answered.

import { ask } from "./requests.js";

const BUTTONS = [
  { do: "tare", title: "Tare" },
  { do: "calibrate", title: "Calibrate" },
  { do: "balance", title: "Start balancing", moves: true },
  { do: "stop_balancing", title: "Stop balancing", stops: true },
  { do: "grasp", title: "Grasp", moves: true },
  { do: "release", title: "Release", moves: true },
  { do: "stop_grasp", title: "Stop the hand", stops: true },
];
const FIELDS = [
  { name: "scheme", title: "Scheme" },
  { name: "m", title: "Taxels a frame", least: 0, note: "0: the board's own" },
  { name: "threshold_counts", title: "Threshold", least: -1, note: "counts; -1: the board's own" },
];

export class Controls {
  constructor(element) {
    this.element = element;
    this.groups = new Map();
    this.key = "";
  }

  /** The newest of what can be asked for; hidden where that is nothing. */
  show({ offers = [], settings = {}, schemes = [] }) {
    this.element.hidden = !offers.length;
    const key = JSON.stringify([offers, schemes]);
    if (key !== this.key) {
      this.key = key;
      this.#build(offers, schemes);
    }
    for (const [of, values] of Object.entries(settings)) this.#showValues(of, values);
  }

  #build(offers, schemes) {
    this.groups.clear();
    for (const of of [...new Set(offers.map(([, namespace]) => namespace))].sort()) {
      const group = document.createElement("div");
      group.className = "group";
      group.dataset.of = of;
      const title = document.createElement("h3");
      title.textContent = of || "/";
      group.append(title);
      const offered = new Set(offers.filter(([, namespace]) => namespace === of).map(([what]) => what));
      for (const button of BUTTONS) if (offered.has(button.do)) group.append(this.#button(of, button));
      if (offered.has("set")) for (const field of FIELDS) group.append(...this.#field(of, field, schemes));
      this.groups.set(of, group);
    }
    this.element.querySelector(".groups").replaceChildren(...this.groups.values());
  }

  #button(of, { do: what, title, moves, stops }) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = title;
    button.dataset.do = what;
    if (moves) button.dataset.moves = "";
    if (stops) button.dataset.stops = "";
    button.onclick = () => this.#ask(`${title}, ${of || "/"}`, what, { skin: of });
    return button;
  }

  #field(of, { name, title, least, note }, schemes) {
    const label = document.createElement("label");
    label.textContent = title;
    const field = document.createElement(name === "scheme" ? "select" : "input");
    field.dataset.name = name;
    if (name === "scheme") {
      for (const scheme of ["", ...schemes]) field.add(new Option(scheme || "the board's own", scheme));
    } else {
      Object.assign(field, { type: "number", step: 1, min: least, title: note });
    }
    const refused = document.createElement("span");
    refused.className = "refused";
    refused.dataset.refused = name;
    refused.setAttribute("role", "status");
    field.onchange = () => {
      const value = name === "scheme" ? field.value : field.valueAsNumber;
      // An empty field is NaN.
      const isNone = name !== "scheme" && !(Number.isInteger(value) && value >= least);
      refused.textContent = isNone ? `not set: needed is a whole number from ${least} on` : "";
      if (isNone) return;
      this.#ask(`${title}, ${of || "/"}`, "set", { skin: of, name, value });
    };
    label.append(field);
    return [label, refused];
  }

  #showValues(of, values) {
    for (const [name, value] of Object.entries(values)) {
      const field = this.groups.get(of)?.querySelector(`[data-name=${name}]`);
      if (field && document.activeElement !== field) field.value = value;
    }
  }

  async #ask(title, what, details) {
    const line = this.element.querySelector(".answer");
    line.dataset.done = "waiting";
    line.textContent = `${title}: asked …`;
    const { done, text } = await ask(what, details);
    line.dataset.done = String(done);
    line.textContent = `${title}: ${text}`;
  }
}
