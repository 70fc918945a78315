// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// A recording that is shown: play, pause, and where in it one is.

import { ask } from "./requests.js";

const SETTLE_MS = 600; // until the server tells where it is after a seek

const PAUSED = "this page is paused: Go on shows it";

export class Replay {
  /** In `element`; isPaused() tells whether the page stays as it is meanwhile. */
  constructor(element, isPaused) {
    this.element = element;
    this.isPaused = isPaused;
    this.button = element.querySelector("button");
    this.slider = element.querySelector("input");
    this.time = element.querySelector("output");
    this.answer = element.querySelector(".answer");
    this.moved_ms = -SETTLE_MS;
    this.isGrasped = false; // by a finger or the mouse, which may rest
    this.isPlaying = false; // or is to be: what was asked for counts until the server tells
    this.isToldPlaying = false;
    this.asked = 0;
    this.button.onclick = () => this.toggle();
    this.slider.onpointerdown = ({ pointerId }) => {
      this.isGrasped = true;
      this.slider.setPointerCapture(pointerId); // its end counts wherever that is
    };
    this.slider.onlostpointercapture = () => {
      this.isGrasped = false;
    };
    this.slider.oninput = () => {
      this.moved_ms = performance.now();
      this.#tell(Number(this.slider.value));
      this.#seek();
    };
  }

  /** Whether there is one. */
  get isShown() {
    return !this.element.hidden;
  }

  /** Whether there is one that is held. */
  get isHeld() {
    return this.isShown && !this.isPlaying;
  }

  /** The newest of the server; without a replay it is hidden. */
  show(replay) {
    this.element.hidden = !replay;
    if (!replay) return;
    this.isToldPlaying = replay.playing;
    if (!this.asked) this.#showPlaying(replay.playing);
    this.element.querySelector(".name").textContent = replay.name;
    // Of whole steps: a slider stops at the last one that is not above its end.
    const step_s = Number(this.slider.step);
    this.slider.max = Math.ceil(replay.length_s / step_s) * step_s;
    this.length_s = replay.length_s;
    if (this.isGrasped || performance.now() - this.moved_ms < SETTLE_MS) return;
    this.slider.value = replay.position_s;
    this.#tell(replay.position_s);
  }

  /** Play or hold; twice in a row, however soon, is as before. */
  async toggle() {
    this.#showPlaying(!this.isPlaying);
    this.asked += 1;
    const answer = await ask(this.isPlaying ? "play" : "pause");
    this.asked -= 1;
    if (!answer.done && !this.asked) this.#showPlaying(this.isToldPlaying);
    this.#tellAnswer(answer);
  }

  #showPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.button.textContent = isPlaying ? "Hold" : "Play";
  }

  /** One seek at a time; the last one counts. */
  async #seek() {
    if (this.isSeeking) {
      this.isDue = true;
      return;
    }
    this.isSeeking = true;
    do {
      this.isDue = false;
      this.#tellAnswer(await ask("seek", { value: Number(this.slider.value) }));
    } while (this.isDue);
    this.isSeeking = false;
  }

  /** The page is no longer paused. */
  goOn() {
    if (this.answer.textContent === PAUSED) this.answer.textContent = "";
  }

  /** What was done can be seen, unless the page is paused; only what was not is said. */
  #tellAnswer({ done, text }) {
    this.answer.textContent = !done ? text : this.isPaused() ? PAUSED : "";
  }

  #tell(position_s) {
    const words = `${position_s.toFixed(1)} of ${this.length_s.toFixed(1)} s`;
    this.time.textContent = words;
    this.slider.setAttribute("aria-valuetext", words);
  }
}
