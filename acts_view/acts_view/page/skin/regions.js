// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What each patch of a skin feels, and of a hand also what it does, and the angles of its joints.

import { rounded, setText } from "../words.js";

const FULL_N = 5;

// A message has the joints of one of the nodes that publish some: those of the others stay for a while.
const JOINT_STAYS_MS = 2000;

export class Regions {
  constructor(element) {
    this.element = element;
    element.innerHTML = `<h3><span class="what"></span> <span class="state"></span></h3><p class="reason"></p><ul class="patches"></ul><h3 class="joints-title">Joints [°]</h3><dl class="joints"></dl><p class="note"></p>`;
    this.rows = new Map();
    this.joints = new Map();
    this.told = new Map();
  }

  /** Of every message, since few are shown, which might all have the joints of the same node. */
  take(hand) {
    const told_ms = performance.now();
    for (const [name, angle_rad] of hand.joints ?? []) this.told.set(name, { angle_rad, told_ms });
  }

  /** The newest of both; hidden as long as neither is published. */
  show(regions, hand) {
    this.element.hidden = !regions.length && !hand.state && !hand.joints?.length;
    setText(this.element.querySelector(".state"), [hand.state, ...(hand.active ?? [])].filter(Boolean).join(" · "));
    setText(this.element.querySelector(".reason"), hand.reason ?? "");
    this.#showJoints();
    setText(this.element.querySelector(".what"), hand.state || this.joints.size ? "Hand" : "Patches");
    this.element.querySelector(".joints-title").hidden = !this.joints.size;
    const events = (hand.events ?? []).filter(([, count]) => count).map(([name, count]) => `${name} ${count} ×`);
    setText(this.element.querySelector(".note"), events.length ? `Reflexes so far: ${events.join(", ")}` : "");
    this.#keepThose(regions);
    for (const [name, force_n, slip_m, isSlipping] of regions) {
      const row = this.#row(name);
      row.dataset.slipping = isSlipping;
      row.querySelector("i").style.transform = `scaleX(${Math.min(force_n / FULL_N, 1)})`;
      setText(row.querySelector(".force"), `${force_n.toFixed(2)} N`);
      setText(row.querySelector(".slip"), isSlipping ? `slips ${(1000 * slip_m).toFixed(1)} mm` : "");
    }
  }

  #showJoints() {
    const since_ms = performance.now() - JOINT_STAYS_MS;
    for (const [name, { angle_rad, told_ms }] of this.told) {
      if (told_ms >= since_ms) {
        setText(this.#joint(name).angle, rounded((angle_rad * 180) / Math.PI, 0));
        continue;
      }
      this.joints.get(name)?.pair.remove();
      this.joints.delete(name);
      this.told.delete(name);
    }
  }

  /** Empty the list if it shows any but these, in their order: another server may have other regions than the last. */
  #keepThose(regions) {
    const names = new Set(regions.map(([name]) => name));
    if ([...this.rows.keys()].join("\n") === [...names].join("\n")) return;
    this.rows.clear();
    this.element.querySelector(".patches").replaceChildren();
  }

  #row(name) {
    if (!this.rows.has(name)) {
      const row = document.createElement("li");
      row.innerHTML = `<span class="name"></span><span class="bar-of-force"><i></i></span><span class="force"></span><span class="slip"></span>`;
      const title = row.querySelector(".name");
      title.textContent = title.title = name.replaceAll("_", " ");
      this.element.querySelector(".patches").append(row);
      this.rows.set(name, row);
    }
    return this.rows.get(name);
  }

  #joint(name) {
    if (!this.joints.has(name)) {
      const [title, angle] = ["dt", "dd"].map((kind) => document.createElement(kind));
      title.textContent = name.replaceAll("_", " ");
      const pair = document.createElement("div");
      pair.append(title, angle);
      this.element.querySelector(".joints").append(pair);
      this.joints.set(name, { pair, angle });
    }
    return this.joints.get(name);
  }
}
