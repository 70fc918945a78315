// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the nodes can be asked for, as far as the server lets a page ask, and what they have answered.

import { arrange } from "./arrange.js";
import { ask } from "./requests.js";
import { nameOf } from "./words.js";

const BUTTONS = [
  { do: "tare", title: "Tare" },
  { do: "calibrate", title: "Calibrate" },
  { do: "balance", title: "Start balancing", moves: true },
  { do: "stop_balancing", title: "Stop balancing", stops: true },
  { do: "put_back", title: "Put the ball back", moves: true },
  { do: "grasp", title: "Grasp", moves: true },
  { do: "release", title: "Release", moves: true },
  { do: "stop_grasp", title: "Stop the hand", stops: true },
];
// As acts_view/nodes/control.py has them.
const FIELDS = [
  { name: "scheme", title: "Scheme" },
  { name: "m", title: "Taxels a frame", least: 0, most: 4096, note: "0: the board's own" },
  { name: "threshold_counts", title: "Threshold", least: -1, most: 1023, note: "counts; -1: the board's own" },
];

export class Controls {
  constructor(element) {
    this.element = element;
    this.groups = element.querySelector(".groups");
    this.key = "";
    this.schemes = "";
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
    if (String(schemes) !== this.schemes) this.groups.replaceChildren();
    this.schemes = String(schemes);
    arrange(this.groups, [...new Set(offers.map(([, namespace]) => namespace))].sort(), (of) => this.#group(of));
    for (const group of this.groups.children) {
      const { of } = group.dataset;
      const offered = new Set(offers.filter(([, namespace]) => namespace === of).map(([what]) => what));
      const makers = new Map([["title", () => heading(of)]]);
      for (const button of BUTTONS) if (offered.has(button.do)) makers.set(button.do, () => this.#button(of, button));
      if (offered.has("set")) for (const field of FIELDS) makers.set(field.name, () => this.#field(of, field, schemes));
      arrange(group, [...makers.keys()], (part) => makers.get(part)());
    }
  }

  #group(of) {
    const group = document.createElement("div");
    group.className = "group";
    group.dataset.of = of;
    return group;
  }

  #button(of, { do: what, title, moves, stops }) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = title;
    button.dataset.do = what;
    if (moves) button.dataset.moves = "";
    if (stops) button.dataset.stops = "";
    button.onclick = () => this.#ask(`${title}, ${nameOf(of)}`, what, { skin: of });
    return button;
  }

  #field(of, { name, title, least, most, note }, schemes) {
    const label = document.createElement("label");
    label.textContent = title;
    const field = document.createElement(name === "scheme" ? "select" : "input");
    field.dataset.name = name;
    if (name === "scheme") {
      for (const scheme of ["", ...schemes]) field.add(new Option(scheme || "the board's own", scheme));
    } else {
      Object.assign(field, { type: "number", step: 1, min: least, max: most, title: note });
    }
    const refused = document.createElement("span");
    refused.className = "refused";
    refused.dataset.refused = name;
    refused.setAttribute("role", "status");
    // What is being typed stays as it is until it has been answered, also where one has gone on meanwhile.
    let wanted = null; // of the last change, as long as it is not asked for
    let isAsking = false;
    field.oninput = () => { field.dataset.typed = ""; };
    field.onblur = () => { if (!isAsking) delete field.dataset.typed; };
    // Who turns the wheel wants to go on down the page: a number that has the focus would change, and be set unseen.
    field.onwheel = () => { if (name !== "scheme") field.blur(); };
    field.onchange = async () => {
      const value = name === "scheme" ? field.value : field.valueAsNumber;
      refused.textContent = name === "scheme" ? "" : refusal(value, least, most);
      if (refused.textContent) return;
      wanted = { value, text: field.value };
      if (isAsking) return;
      isAsking = true;
      let text = "";
      // One at a time; the last one counts, as of an arrow key that is held.
      while (wanted) {
        const details = { skin: of, name, value: wanted.value };
        ({ text } = wanted);
        wanted = null;
        await this.#ask(`${title}, ${nameOf(of)}`, "set", details);
      }
      isAsking = false;
      if (field.value === text || field !== document.activeElement) delete field.dataset.typed;
    };
    label.append(field);
    const both = document.createElement("span");
    both.className = "field";
    both.append(label, refused);
    return both;
  }

  #showValues(of, values) {
    const group = [...this.groups.children].find((one) => one.dataset.of === of);
    for (const [name, value] of Object.entries(values)) {
      const field = group?.querySelector(`[data-name=${name}]`);
      if (!field || "typed" in field.dataset || field.value === String(value)) continue;
      field.value = value;
      // Who is about to type replaces it: the browser would put the first key after it.
      if (field === document.activeElement) field.select?.();
    }
  }

  async #ask(title, what, details) {
    const answers = this.element.querySelector(".answer");
    // Others that wait keep their lines, so that the answer to one does not take the place of that to another.
    for (const line of answers.querySelectorAll("span:not([data-done=waiting])")) line.remove();
    const line = document.createElement("span");
    line.dataset.done = answers.dataset.done = "waiting";
    line.textContent = `${title}: asked …`;
    answers.append(line);
    const { done, text } = await ask(what, details);
    line.dataset.done = String(done);
    line.textContent = `${title}: ${text}`;
    // Of the newest.
    answers.dataset.done = answers.lastChild.dataset.done;
  }
}

/** Why a number is not taken; empty where it is. */
function refusal(value, least, most) {
  // An empty field is NaN.
  if (!(Number.isInteger(value) && value >= least)) return `not set: needed is a whole number from ${least} on`;
  return value > most ? `not set: the largest is ${most}` : "";
}

function heading(of) {
  const element = document.createElement("h3");
  element.textContent = nameOf(of);
  return element;
}
