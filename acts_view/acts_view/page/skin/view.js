// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The picture of a skin: its taxels, over them its contacts, and in words what the cursor points at.

import { settings } from "../settings.js";
import { Geometry } from "./geometry.js";
import { Marks } from "./marks.js";
import { Taxels } from "./taxels.js";

const NOISE_COUNTS = 30; // as acts_recon's confidence has it
/** An age that is not known, in tenths of a millisecond; as acts_view/skin/snapshot.py has it. */
export const AGE_UNKNOWN = 65535;
const STEPS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

export class SkinView {
  /** Draws into the two canvases of `element`; calls onPoint(text, isMoved) with what is under the cursor. */
  constructor(element, onPoint) {
    this.element = element;
    this.onPoint = onPoint;
    this.below = element.querySelector("canvas.taxels");
    this.above = element.querySelector("canvas.marks");
    this.taxels = new Taxels(this.below);
    this.marks = new Marks(this.above);
    this.pointed = null; // {row, col}
    this.geometry = null;
    this.state = null;
    const follow = (event) => this.#point(this.#taxelAt(event));
    this.above.addEventListener("pointermove", follow);
    this.above.addEventListener("pointerdown", follow);
    this.above.addEventListener("pointerleave", (event) => {
      // A finger leaves when it is lifted: what was tapped stays, or nobody could read it.
      if (event.pointerType !== "touch") this.#point(null);
    });
    this.above.addEventListener("blur", () => this.#point(null));
    this.above.addEventListener("keydown", (event) => this.#key(event));
    new ResizeObserver(() => this.draw()).observe(element);
  }

  /** What the skin is like, as the server describes it. */
  setShape(shape) {
    const geometry = new Geometry(shape);
    this.geometry = geometry;
    this.taxels.setGeometry(geometry);
    this.marks.setGeometry(geometry);
    this.element.style.aspectRatio = `${geometry.width_m} / ${geometry.height_m}`;
    // As wide as fits, but no higher than wide screens are.
    this.element.style.maxWidth = `calc(${Math.min(1, geometry.width_m / geometry.height_m)} * var(--picture-height))`;
    // A smaller skin may not have the taxel that was pointed at.
    if (this.pointed && (this.pointed.row >= shape.rows || this.pointed.col >= shape.cols)) this.#point(null);
    this.draw();
  }

  /** The newest state, to be drawn by `draw`. */
  setState(message) {
    this.state = message;
    this.marks.remember(message);
    const image = this.geometry && this.#array("image");
    if (image) this.taxels.follow(image);
  }

  /** The canvases, one over another. */
  get layers() {
    return [this.below, this.above];
  }

  draw() {
    if (!this.geometry) return;
    const ratio = window.devicePixelRatio || 1;
    const [wide, high] = [this.element.clientWidth, this.element.clientHeight].map((side) => Math.round(side * ratio));
    for (const canvas of [this.below, this.above]) {
      if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    }
    this.geometry.fit(wide);
    this.taxels.draw(this.#array("image"), settings.unsure ? this.#array("confidence") : null);
    this.#drawMarks();
    if (this.pointed) this.#tell(false);
  }

  #drawMarks() {
    this.marks.draw(settings.contacts ? this.state : null, this.pointed, settings.measured ? this.#array("age") : null);
  }

  /** An array of the newest state that has a value for each taxel; null without. */
  #array(name) {
    const { rows, cols } = this.geometry.shape;
    const array = this.state?.arrays[name];
    return array && array.shape[0] === rows && array.shape[1] === cols ? array.data : null;
  }

  #taxelAt(event) {
    const ratio = window.devicePixelRatio || 1;
    return this.geometry ? this.geometry.taxelAt(event.offsetX * ratio, event.offsetY * ratio) : null;
  }

  #key(event) {
    if (event.key === "Escape") this.#point(null);
    if (!(event.key in STEPS) || !this.geometry) return;
    event.preventDefault();
    const { rows, cols } = this.geometry.shape;
    const { row, col } = this.pointed ?? { row: rows >> 1, col: cols >> 1 };
    const [down, right] = this.pointed ? STEPS[event.key] : [0, 0];
    this.#point({ row: Math.min(Math.max(row + down, 0), rows - 1), col: Math.min(Math.max(col + right, 0), cols - 1) });
  }

  #point(taxel) {
    this.pointed = taxel;
    this.#tell(true);
    if (this.geometry) this.#drawMarks();
  }

  #tell(isMoved) {
    const image = this.geometry && this.#array("image");
    if (!this.pointed || !image) {
      this.onPoint("", isMoved);
      return;
    }
    const { row, col } = this.pointed;
    const place = row * this.geometry.shape.cols + col;
    const words = [`row ${row}, column ${col}`];
    const patch = this.geometry.patchOf(this.pointed);
    if (patch && this.geometry.patches.length > 1) words.push(patch.name.replaceAll("_", " "));
    const { force_n } = this.geometry.shape;
    words.push(settings.unit === "newtons" && force_n ? `${force_n[image[place]].toFixed(3)} N (${image[place]} counts)` : `${image[place]} counts`);
    const confidence = this.#array("confidence");
    if (confidence) words.push(uncertainty(confidence[place]));
    const age = this.#array("age");
    if (age) words.push(measured(age[place]));
    this.onPoint(words.join(" · "), isMoved);
  }
}

/** An age in tenths of a millisecond, in words. */
function measured(age) {
  if (age === AGE_UNKNOWN) return "not measured for long";
  return age === 0 ? "measured now" : `measured ${(age / 10).toFixed(1)} ms before`;
}

/** A confidence of 0 to 255 in words: 255 / (1 + (sigma / 30 counts)^2). */
function uncertainty(confidence) {
  if (confidence === 0) return "not known";
  return `± ${Math.round(NOISE_COUNTS * Math.sqrt(255 / confidence - 1))} counts (${Math.round(confidence / 2.55)} % sure)`;
}
