// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What is drawn over the taxels: contacts with number and force, outlines, trails, the centre of pressure, the cursor.

import { settings } from "../settings.js";
import { textScale } from "../words.js";

const TRAIL_MS = 1200;

export class Marks {
  constructor(canvas) {
    this.canvas = canvas;
    this.trails = new Map();
    this.now_ms = 0; // of what is shown, which may be held
  }

  /** A skin of another shape. */
  setGeometry(geometry) {
    this.geometry = geometry;
  }

  /** Take where the contacts of a message are. */
  remember({ life, silent_s, arrays: { contacts, contact_numbers } }) {
    // Where the stream began anew, or its picture was taken away, contacts did not come from where others were.
    if (life !== this.life || silent_s === null) this.trails.clear();
    this.life = life;
    const now_ms = (this.now_ms = performance.now());
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

  /**
   * Draw the contacts of a message, the taxel {row, col} that is pointed at, and dots where the age of a taxel is 0; of
   * each null for none.
   */
  draw(message, pointed, age) {
    this.ratio = window.devicePixelRatio || 1;
    const context = this.canvas.getContext("2d");
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    if (age) this.#drawMeasured(context, age);
    if (message) {
      this.#drawTrails(context);
      // Below the labels of contacts, since the ball is mostly there.
      this.#drawReference(context, message.ball.reference);
      const { outlines } = message.arrays;
      if (outlines && settings.outlines) this.#drawOutlines(context, message.arrays);
      this.#drawContacts(context, message.arrays, !(outlines && settings.outlines));
      this.#drawCentre(context, message.touch);
    }
    if (pointed) this.#drawPointed(context, pointed);
  }

  #drawMeasured(context, age) {
    const { cols, pitch_m } = this.geometry.shape;
    const half = Math.max(0.12 * pitch_m * this.geometry.px_per_m, this.ratio);
    for (let place = 0; place < age.length; place += 1) {
      const centre = age[place] === 0 && this.geometry.toPixels(Math.floor(place / cols), place % cols);
      if (!centre) continue;
      // White on black can be seen on any colour.
      context.fillStyle = "rgb(0 0 0 / 0.7)";
      context.fillRect(centre[0] - 1.5 * half, centre[1] - 1.5 * half, 3 * half, 3 * half);
      context.fillStyle = "white";
      context.fillRect(centre[0] - half, centre[1] - half, 2 * half, 2 * half);
    }
  }

  #drawTrails(context) {
    const { now_ms } = this;
    context.lineWidth = 2 * this.ratio;
    context.lineCap = "round";
    for (const points of this.trails.values()) {
      for (let index = 1; index < points.length; index += 1) {
        const from = this.geometry.metres(points[index - 1][1], points[index - 1][2]);
        const to = this.geometry.metres(points[index][1], points[index][2]);
        // From one finger to another there is no skin to move over.
        if (!from || !to || Math.hypot(to[0] - from[0], to[1] - from[1]) > 0.2 * this.canvas.width) continue;
        context.strokeStyle = `rgb(255 255 255 / ${(0.85 * (1 - (now_ms - points[index][0]) / TRAIL_MS)).toFixed(2)})`;
        context.beginPath();
        context.moveTo(...from);
        context.lineTo(...to);
        context.stroke();
      }
    }
  }

  #drawOutlines(context, { outlines, outline_sizes }) {
    let first = 0;
    for (const size of outline_sizes.data) {
      const corners = [];
      for (let at = first; at < first + size; at += 1) {
        const corner = this.geometry.metres(outlines.data[2 * at], outlines.data[2 * at + 1]);
        // Between the patches of a hand there is no skin.
        if (corner) corners.push(corner);
      }
      first += size;
      if (corners.length < 3) continue;
      context.beginPath();
      corners.forEach((corner, index) => (index ? context.lineTo(...corner) : context.moveTo(...corner)));
      context.closePath();
      outlined(context, this.ratio, 1.75);
    }
  }

  #drawContacts(context, { contacts, contact_numbers }, hasRings) {
    const { ratio, geometry } = this;
    const width = contacts.shape[1];
    const letter = ratio * textScale();
    context.font = `600 ${13 * letter}px system-ui, "DejaVu Sans", sans-serif`;
    context.textBaseline = "middle";
    context.textAlign = "center";
    contact_numbers.data.forEach((number, index) => {
      const [x_m, y_m, force_n, , area_m2] = contacts.data.subarray(index * width, (index + 1) * width);
      const centre = geometry.metres(x_m, y_m);
      if (!centre) return;
      const radius = Math.max(6 * ratio, Math.sqrt(area_m2 / Math.PI) * geometry.px_per_m + 3 * ratio);
      if (hasRings) {
        context.beginPath();
        context.arc(...centre, radius, 0, 2 * Math.PI);
        outlined(context, ratio, 1.75);
      }
      const text = `${number}  ${force_n.toFixed(2)} N`;
      const half = context.measureText(text).width / 2 + 3 * ratio;
      const away = radius + 10 * letter;
      const [x, y] = centre;
      label(context, ratio, text, Math.min(Math.max(x, half), this.canvas.width - half), y > away + 8 * letter ? y - away : y + away);
    });
  }

  #drawCentre(context, touch) {
    // That of all contacts together: in the middle of several, and of a hand nowhere.
    const centre = touch && this.geometry.patches.length === 1 && this.geometry.metres(touch[0], touch[1]);
    if (!centre) return;
    const [x, y] = centre;
    const arm = 7 * this.ratio;
    context.beginPath();
    context.moveTo(x - arm, y);
    context.lineTo(x + arm, y);
    context.moveTo(x, y - arm);
    context.lineTo(x, y + arm);
    outlined(context, this.ratio, 1.75);
  }

  /** Where a ball should be: a square that stands on its corner. */
  #drawReference(context, place) {
    const centre = place && this.geometry.metres(...place);
    if (!centre) return;
    const [x, y] = centre;
    const half = 9 * this.ratio;
    context.beginPath();
    context.moveTo(x, y - half);
    context.lineTo(x + half, y);
    context.lineTo(x, y + half);
    context.lineTo(x - half, y);
    context.closePath();
    outlined(context, this.ratio, 1.5);
  }

  #drawPointed(context, { row, col }) {
    const low = this.geometry.toPixels(row - 0.49, col - 0.49);
    const high = this.geometry.toPixels(row + 0.49, col + 0.49);
    if (!low || !high) return;
    context.beginPath();
    context.rect(low[0], low[1], high[0] - low[0], high[1] - low[1]);
    outlined(context, this.ratio, 1.5);
  }
}

/** Stroke the path in white with a dark edge, which can be seen on any colour. */
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
