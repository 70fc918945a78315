// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The taxels of a skin as coloured squares, patch by patch.

import { settings } from "../settings.js";
import { STEPS, table } from "./colours.js";

const COUNT_MAX = 1023;
const FIXED_TOP_COUNTS = 768; // of a scale in newtons: above it a count stands for ever more force
const LEAST_TOP_COUNTS = 100; // an adaptive scale does not show noise as touch

const FADED = 40; // opacity of what is not known, of 255

const COUNTS = Uint16Array.from({ length: COUNT_MAX + 1 }, (_, counts) => counts);

export class Taxels {
  constructor(canvas) {
    this.canvas = canvas;
    this.most = LEAST_TOP_COUNTS; // that an adaptive scale reaches up to
    this.top = COUNT_MAX;
    this.unit = "counts";
    this.tiles = [];
  }

  /** A skin of another shape. */
  setGeometry(geometry) {
    this.geometry = geometry;
    this.tiles = geometry.patches.map((patch) => {
      const canvas = document.createElement("canvas");
      canvas.width = patch.end_col - patch.first_col;
      canvas.height = patch.end_row - patch.first_row;
      const context = canvas.getContext("2d");
      const pixels = context.createImageData(canvas.width, canvas.height);
      return { patch, canvas, context, pixels, words: new Uint32Array(pixels.data.buffer) };
    });
  }

  /** Let an adaptive scale follow an image that is new: what is only drawn again does not change it. */
  follow(image) {
    let largest = LEAST_TOP_COUNTS;
    for (const counts of image) if (counts > largest) largest = counts;
    // Up at once, down slowly: the picture does not flicker.
    this.most = Math.max(largest, 0.97 * this.most);
  }

  /** Draw counts; with a confidence of 0 to 255 of each, what is not sure fades. Both may be null: no counts fade whole. */
  draw(image, confidence) {
    const context = this.canvas.getContext("2d");
    const colours = table(settings.colours);
    const values = this.valuesOf();
    const opacity = image ? 255 : FADED;
    this.#scale(image);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.imageSmoothingEnabled = settings.smooth;
    context.imageSmoothingQuality = "high";
    for (const { patch, canvas, context: tile, pixels, words } of this.tiles) {
      let at = 0;
      for (let row = patch.first_row; row < patch.end_row; row += 1) {
        let place = row * this.geometry.shape.cols + patch.first_col;
        for (let col = patch.first_col; col < patch.end_col; col += 1, place += 1, at += 1) {
          const value = image ? values[image[place]] : 0;
          const colour = colours[Math.min(STEPS - 1, Math.round((value / this.top) * (STEPS - 1)))];
          // The upper byte is opacity.
          const own = confidence ? FADED + 0.843 * confidence[place] : opacity;
          words[at] = ((colour & 0xffffff) | (own << 24)) >>> 0;
        }
      }
      tile.putImageData(pixels, 0, 0);
      context.drawImage(canvas, ...this.geometry.box(patch));
    }
  }

  /** What is shown of each count from 0 on: itself, or its force [N] where the skin tells it. */
  valuesOf() {
    const { force_n } = this.geometry.shape;
    return settings.unit === "newtons" && force_n ? force_n : COUNTS;
  }

  #scale(image) {
    const values = this.valuesOf();
    this.unit = values === COUNTS ? "counts" : "N";
    const fixed = values[values === COUNTS ? COUNT_MAX : FIXED_TOP_COUNTS];
    // A measured response may say 0 N up to any number of counts: then there is nothing to adapt to.
    this.top = (settings.scale === "adaptive" && image && values[Math.round(this.most)]) || fixed;
  }
}
