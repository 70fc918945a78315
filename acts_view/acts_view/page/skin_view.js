// The picture of a skin: taxels patch by patch, and over them contacts, trails and what the cursor points at.

import { table, STEPS } from "./colours.js";
import { settings } from "./settings.js";

const COUNT_MAX = 1023;
const LEAST_TOP = 100; // an adaptive scale does not show noise as touch
const TRAIL_MS = 1200;
const NOISE_COUNTS = 30; // as acts_recon's confidence has it

export class SkinView {
  /** Draws into the two canvases of `frame_element`; calls onPoint(text) with what is under the cursor. */
  constructor(element, onPoint) {
    this.element = element;
    this.onPoint = onPoint;
    this.below = element.querySelector("canvas.taxels");
    this.above = element.querySelector("canvas.marks");
    this.trails = new Map();
    this.top = COUNT_MAX;
    this.pointed = null; // {row, col}
    this.shape = null;
    this.state = null;
    this.above.addEventListener("pointermove", (event) => this.#point(this.#taxelAt(event.offsetX, event.offsetY)));
    this.above.addEventListener("pointerdown", (event) => this.#point(this.#taxelAt(event.offsetX, event.offsetY)));
    this.above.addEventListener("pointerleave", () => this.#point(null));
    this.above.addEventListener("blur", () => this.#point(null));
    this.above.addEventListener("keydown", (event) => this.#key(event));
    new ResizeObserver(() => this.draw()).observe(element);
  }

  /** What the skin is like, as the server describes it. */
  setShape(shape) {
    this.shape = shape;
    this.patches = shape.patches.map((patch) => {
      const [first_row, end_row] = patch.rows;
      const [first_col, end_col] = patch.cols;
      const canvas = document.createElement("canvas");
      canvas.width = end_col - first_col;
      canvas.height = end_row - first_row;
      const context = canvas.getContext("2d");
      const pixels = context.createImageData(canvas.width, canvas.height);
      return { ...patch, first_row, end_row, first_col, end_col, canvas, context, pixels, words: new Uint32Array(pixels.data.buffer) };
    });
    this.width_m = Math.max(...shape.patches.map(({ box_m: [x, , width] }) => x + width));
    this.height_m = Math.max(...shape.patches.map(({ box_m: [, y, , height] }) => y + height));
    this.element.style.aspectRatio = `${this.width_m} / ${this.height_m}`;
    // As wide as fits, but no higher than wide screens are.
    this.element.style.maxWidth = `calc(${Math.min(1, this.width_m / this.height_m)} * var(--picture-height))`;
    this.draw();
  }

  /** The newest state. */
  setState(message) {
    this.state = message;
    this.#remember(message);
    this.draw();
    if (this.pointed) this.#tell();
  }

  draw() {
    if (!this.shape) return;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    for (const canvas of [this.below, this.above]) {
      const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
      if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    }
    this.px_per_m = this.below.width / this.width_m;
    this.#drawTaxels();
    this.#drawMarks(ratio);
  }

  #image() {
    const image = this.state?.arrays.image;
    return image && image.shape[0] === this.shape.rows && image.shape[1] === this.shape.cols ? image.data : null;
  }

  #confidence() {
    const confidence = this.state?.arrays.confidence;
    return confidence && confidence.data.length === this.shape.rows * this.shape.cols ? confidence.data : null;
  }

  #drawTaxels() {
    const image = this.#image();
    const sure = settings.unsure ? this.#confidence() : null;
    const context = this.below.getContext("2d");
    const colours = table(settings.colours);
    this.#scale(image);
    context.clearRect(0, 0, this.below.width, this.below.height);
    context.imageSmoothingEnabled = settings.smooth;
    context.imageSmoothingQuality = "high";
    for (const patch of this.patches) {
      const { words, canvas } = patch;
      let at = 0;
      for (let row = patch.first_row; row < patch.end_row; row += 1) {
        let place = row * this.shape.cols + patch.first_col;
        for (let col = patch.first_col; col < patch.end_col; col += 1, place += 1, at += 1) {
          const counts = image ? image[place] : 0;
          const colour = colours[Math.min(STEPS - 1, Math.round((counts / this.top) * (STEPS - 1)))];
          // The upper byte is opacity.
          words[at] = sure ? ((colour & 0xffffff) | ((40 + 0.843 * sure[place]) << 24)) >>> 0 : colour;
        }
      }
      patch.context.putImageData(patch.pixels, 0, 0);
      const [x, y, w, h] = this.#box(patch);
      context.drawImage(canvas, x, y, w, h);
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

  #box({ box_m: [x, y, width, height] }) {
    const inset = this.patches.length > 1 ? 1 : 0;
    const [left, upper] = [Math.round(x * this.px_per_m) + inset, Math.round(y * this.px_per_m) + inset];
    return [left, upper, Math.round((x + width) * this.px_per_m) - left - inset, Math.round((y + height) * this.px_per_m) - upper - inset];
  }

  /** Where a place of the picture (fractional) is drawn; null where there is no skin. */
  #toPixels(row, col) {
    for (const patch of this.patches) {
      const [down, across] = [row + 0.5 - patch.first_row, col + 0.5 - patch.first_col];
      const [rows, cols] = [patch.end_row - patch.first_row, patch.end_col - patch.first_col];
      if (down < 0 || across < 0 || down > rows || across > cols) continue;
      const [x, y, width, height] = this.#box(patch);
      return [x + (across / cols) * width, y + (down / rows) * height];
    }
    return null;
  }

  #metres(x_m, y_m) {
    const { rows, cols, pitch_m, row_pitch_m } = this.shape;
    return this.#toPixels((rows - 1) / 2 - y_m / row_pitch_m, x_m / pitch_m + (cols - 1) / 2);
  }

  #remember(message) {
    const now_ms = performance.now();
    const { contacts, contact_numbers } = message.arrays;
    const width = contacts.shape[1];
    contact_numbers.data.forEach((number, index) => {
      const [x_m, y_m] = contacts.data.subarray(index * width, index * width + 2);
      if (!this.trails.has(number)) this.trails.set(number, []);
      this.trails.get(number).push([now_ms, x_m, y_m]);
    });
    for (const [number, points] of this.trails) {
      while (points.length && now_ms - points[0][0] > TRAIL_MS) points.shift();
      if (!points.length) this.trails.delete(number);
    }
  }

  #drawMarks(ratio) {
    const context = this.above.getContext("2d");
    context.clearRect(0, 0, this.above.width, this.above.height);
    if (this.state && settings.contacts) {
      this.#drawTrails(context, ratio);
      this.#drawContacts(context, ratio);
      this.#drawCentre(context, ratio);
    }
    if (this.pointed) this.#drawPointed(context, ratio);
  }

  #drawTrails(context, ratio) {
    const now_ms = performance.now();
    context.lineWidth = 2 * ratio;
    context.lineCap = "round";
    for (const points of this.trails.values()) {
      for (let index = 1; index < points.length; index += 1) {
        const from = this.#metres(points[index - 1][1], points[index - 1][2]);
        const to = this.#metres(points[index][1], points[index][2]);
        // From one finger to another there is no skin to move over.
        if (!from || !to || Math.hypot(to[0] - from[0], to[1] - from[1]) > 0.2 * this.above.width) continue;
        context.strokeStyle = `rgb(255 255 255 / ${(0.85 * (1 - (now_ms - points[index][0]) / TRAIL_MS)).toFixed(2)})`;
        context.beginPath();
        context.moveTo(...from);
        context.lineTo(...to);
        context.stroke();
      }
    }
  }

  #drawContacts(context, ratio) {
    const { contacts, contact_numbers } = this.state.arrays;
    const width = contacts.shape[1];
    context.font = `600 ${13 * ratio}px system-ui, "DejaVu Sans", sans-serif`;
    context.textBaseline = "middle";
    context.textAlign = "center";
    contact_numbers.data.forEach((number, index) => {
      const [x_m, y_m, force_n, , area_m2] = contacts.data.subarray(index * width, (index + 1) * width);
      const centre = this.#metres(x_m, y_m);
      if (!centre) return;
      const radius = Math.max(6 * ratio, Math.sqrt(area_m2 / Math.PI) * this.px_per_m + 3 * ratio);
      context.beginPath();
      context.arc(...centre, radius, 0, 2 * Math.PI);
      outlined(context, ratio, 1.75);
      const text = `${number}  ${force_n.toFixed(2)} N`;
      const half = context.measureText(text).width / 2 + 3 * ratio;
      const away = radius + 10 * ratio;
      const [x, y] = centre;
      label(context, ratio, text, Math.min(Math.max(x, half), this.above.width - half), y > away + 8 * ratio ? y - away : y + away);
    });
  }

  #drawCentre(context, ratio) {
    // That of all contacts together: in the middle of several, and of a hand nowhere.
    if (!this.state.touch || this.patches.length > 1) return;
    const centre = this.#metres(this.state.touch[0], this.state.touch[1]);
    if (!centre) return;
    const [x, y] = centre;
    const arm = 7 * ratio;
    context.beginPath();
    context.moveTo(x - arm, y);
    context.lineTo(x + arm, y);
    context.moveTo(x, y - arm);
    context.lineTo(x, y + arm);
    outlined(context, ratio, 1.75);
  }

  #drawPointed(context, ratio) {
    const { row, col } = this.pointed;
    const [low, high] = [this.#toPixels(row - 0.49, col - 0.49), this.#toPixels(row + 0.49, col + 0.49)];
    if (!low || !high) return;
    context.beginPath();
    context.rect(low[0], low[1], high[0] - low[0], high[1] - low[1]);
    outlined(context, ratio, 1.5);
  }

  #taxelAt(x, y) {
    const ratio = window.devicePixelRatio || 1;
    for (const patch of this.patches ?? []) {
      const [left, upper, width, height] = this.#box(patch);
      const [across, down] = [(x * ratio - left) / width, (y * ratio - upper) / height];
      if (across < 0 || down < 0 || across >= 1 || down >= 1) continue;
      return {
        row: patch.first_row + Math.floor(down * (patch.end_row - patch.first_row)),
        col: patch.first_col + Math.floor(across * (patch.end_col - patch.first_col)),
      };
    }
    return null;
  }

  #key(event) {
    const steps = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
    if (event.key === "Escape") this.#point(null);
    if (!(event.key in steps) || !this.shape) return;
    event.preventDefault();
    const { rows, cols } = this.shape;
    const { row, col } = this.pointed ?? { row: rows >> 1, col: cols >> 1 };
    const [down, right] = this.pointed ? steps[event.key] : [0, 0];
    this.#point({ row: Math.min(Math.max(row + down, 0), rows - 1), col: Math.min(Math.max(col + right, 0), cols - 1) });
  }

  #point(taxel) {
    this.pointed = taxel;
    this.#tell();
    if (this.shape) this.#drawMarks(window.devicePixelRatio || 1);
  }

  #tell() {
    const image = this.#image();
    if (!this.pointed || !image) {
      this.onPoint("");
      return;
    }
    const { row, col } = this.pointed;
    const place = row * this.shape.cols + col;
    const words = [`row ${row}, column ${col}`];
    const patch = this.patches.find((one) => row >= one.first_row && row < one.end_row && col >= one.first_col && col < one.end_col);
    if (patch && this.patches.length > 1) words.push(patch.name.replaceAll("_", " "));
    words.push(`${image[place]} counts`);
    const confidence = this.#confidence();
    if (confidence) words.push(uncertainty(confidence[place]));
    this.onPoint(words.join(" · "));
  }
}

/** A confidence of 0 to 255 in words: 255 / (1 + (sigma / 30 counts)^2). */
function uncertainty(confidence) {
  if (confidence === 0) return "not known";
  return `± ${Math.round(NOISE_COUNTS * Math.sqrt(255 / confidence - 1))} counts (${Math.round(confidence / 2.55)} % sure)`;
}

function outlined(context, ratio, width) {
  context.strokeStyle = "rgb(0 0 0 / 0.65)";
  context.lineWidth = (width + 2) * ratio;
  context.stroke();
  context.strokeStyle = "white";
  context.lineWidth = width * ratio;
  context.stroke();
}

function label(context, ratio, text, x, y) {
  context.lineJoin = "round";
  context.strokeStyle = "rgb(0 0 0 / 0.75)";
  context.lineWidth = 3.5 * ratio;
  context.strokeText(text, x, y);
  context.fillStyle = "white";
  context.fillText(text, x, y);
}
