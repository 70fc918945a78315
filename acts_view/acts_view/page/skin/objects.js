// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Which of the known objects presses, how sure that is, and which others fit nearly as well.

import { setText } from "../words.js";

const FOREIGN = 0.9; // what leaves so much unexplained is none of the known objects
const UNDECIDED = 0.2; // below it answers are often wrong

export class Objects {
  constructor(element) {
    this.element = element;
    element.innerHTML = `<h3>Object</h3><p class="found"></p><table><thead><tr><th scope="col">fits best</th><th scope="col">not explained <small>%</small></th></tr></thead><tbody></tbody></table><p class="note">Confidence: 0 undecided, 1 sure; it is no probability.</p>`;
    this.names = new Map(); // of those that were found so far: a message has the name of the first only
  }

  /** Of every message, also of those that are not shown: whoever classifies next may have other objects. */
  take({ number }) {
    if (number === undefined) this.names.clear();
  }

  /** Another server may follow. */
  forget() {
    this.names.clear();
  }

  /** The newest; hidden as long as nobody classifies. */
  show({ number, name, confidence, nearest }) {
    this.element.hidden = number === undefined;
    if (this.element.hidden) return;
    if (number !== null && name) this.names.set(number, name);
    setText(this.element.querySelector(".found"), this.#found(number, confidence, nearest));
    for (const part of ["table", ".note"]) this.element.querySelector(part).hidden = number === null;
    const rows = nearest.map(([of, residual]) => [this.#named(of), (100 * Math.min(residual, 1)).toFixed(0)]);
    this.element.querySelector("tbody").replaceChildren(...rows.map(row));
  }

  #found(number, confidence, nearest) {
    if (number === null) return "nothing presses";
    if (nearest.length && nearest[0][1] > FOREIGN) return "nothing known";
    if (confidence === null) return `${this.#named(number)}; there is no other to compare with`;
    if (confidence < UNDECIDED) return `not sure: ${nearest.slice(0, 2).map(([of]) => this.#named(of)).join(", ")} or another (confidence ${confidence.toFixed(2)})`;
    return `${this.#named(number)} (confidence ${confidence.toFixed(2)})`;
  }

  #named(number) {
    return this.names.get(number)?.replaceAll("_", " ") ?? `no. ${number}`;
  }
}

function row(words) {
  const element = document.createElement("tr");
  for (const word of words) element.insertCell().textContent = word;
  return element;
}
