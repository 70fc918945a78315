// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Where the taxels of a skin are drawn: patch by patch, in pixels of its canvas.

export class Geometry {
  /** Of a skin, as the server describes it. */
  constructor(shape) {
    this.shape = shape;
    this.patches = shape.patches.map((patch) => {
      const [first_row, end_row] = patch.rows;
      const [first_col, end_col] = patch.cols;
      return { ...patch, first_row, end_row, first_col, end_col };
    });
    this.width_m = Math.max(...shape.patches.map(({ box_m: [x, , width] }) => x + width));
    this.height_m = Math.max(...shape.patches.map(({ box_m: [, y, , height] }) => y + height));
    this.px_per_m = 0;
  }

  /** The canvas is so wide. */
  fit(width_px) {
    this.px_per_m = width_px / this.width_m;
  }

  /** Left, upper, width and height of a patch. */
  box({ box_m: [x, y, width, height] }) {
    const inset = this.patches.length > 1 ? 1 : 0;
    const [left, upper] = [Math.round(x * this.px_per_m) + inset, Math.round(y * this.px_per_m) + inset];
    return [left, upper, Math.round((x + width) * this.px_per_m) - left - inset, Math.round((y + height) * this.px_per_m) - upper - inset];
  }

  /** Where a place of the picture (fractional) is drawn; null where there is no skin. */
  toPixels(row, col) {
    for (const patch of this.patches) {
      const [down, across] = [row + 0.5 - patch.first_row, col + 0.5 - patch.first_col];
      const [rows, cols] = [patch.end_row - patch.first_row, patch.end_col - patch.first_col];
      if (down < 0 || across < 0 || down > rows || across > cols) continue;
      const [x, y, width, height] = this.box(patch);
      return [x + (across / cols) * width, y + (down / rows) * height];
    }
    return null;
  }

  /** Likewise of a place in the skin's frame. */
  metres(x_m, y_m) {
    const { rows, cols, pitch_m, row_pitch_m } = this.shape;
    return this.toPixels((rows - 1) / 2 - y_m / row_pitch_m, x_m / pitch_m + (cols - 1) / 2);
  }

  /** The taxel that is drawn at a place of the canvas, as {row, col}; null where there is none. */
  taxelAt(x_px, y_px) {
    for (const patch of this.patches) {
      const [left, upper, width, height] = this.box(patch);
      const [across, down] = [(x_px - left) / width, (y_px - upper) / height];
      if (across < 0 || down < 0 || across >= 1 || down >= 1) continue;
      return {
        row: patch.first_row + Math.floor(down * (patch.end_row - patch.first_row)),
        col: patch.first_col + Math.floor(across * (patch.end_col - patch.first_col)),
      };
    }
    return null;
  }

  /** The patch that a taxel belongs to, or undefined. */
  patchOf({ row, col }) {
    return this.patches.find((one) => row >= one.first_row && row < one.end_row && col >= one.first_col && col < one.end_col);
  }
}
