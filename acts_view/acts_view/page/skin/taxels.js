// The taxels of a skin as coloured squares, patch by patch.

import { settings } from "../settings.js";
import { STEPS, table } from "./colours.js";

const COUNT_MAX = 1023;
const LEAST_TOP = 100; // an adaptive scale does not show noise as touch

export class Taxels {
  constructor(canvas) {
    this.canvas = canvas;
    this.top = COUNT_MAX;
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

  /** Draw counts; with a confidence of 0 to 255 of each, what is not sure fades. Both may be null. */
  draw(image, confidence) {
    const context = this.canvas.getContext("2d");
    const colours = table(settings.colours);
    this.#scale(image);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.imageSmoothingEnabled = settings.smooth;
    context.imageSmoothingQuality = "high";
    for (const { patch, canvas, context: tile, pixels, words } of this.tiles) {
      let at = 0;
      for (let row = patch.first_row; row < patch.end_row; row += 1) {
        let place = row * this.geometry.shape.cols + patch.first_col;
        for (let col = patch.first_col; col < patch.end_col; col += 1, place += 1, at += 1) {
          const counts = image ? image[place] : 0;
          const colour = colours[Math.min(STEPS - 1, Math.round((counts / this.top) * (STEPS - 1)))];
          // The upper byte is opacity.
          words[at] = confidence ? ((colour & 0xffffff) | ((40 + 0.843 * confidence[place]) << 24)) >>> 0 : colour;
        }
      }
      tile.putImageData(pixels, 0, 0);
      context.drawImage(canvas, ...this.geometry.box(patch));
    }
  }

  #scale(image) {
    if (settings.scale === "fixed" || !image) {
      this.top = COUNT_MAX;
      return;
    }
    let largest = LEAST_TOP;
    for (const counts of image) if (counts > largest) largest = counts;
    // Up at once, down slowly: the picture does not flicker.
    this.top = largest > this.top ? largest : Math.max(largest, 0.97 * this.top);
  }
}
