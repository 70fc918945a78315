// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What is shown of a skin as files: a picture, and tables of its taxels, its contacts and its plots.

import { save } from "../files.js";
import { nameOf } from "../words.js";
import { AGE_UNKNOWN } from "./view.js";

const CAPTION_PX = 28;
const CONTACTS = ["number", "x_m", "y_m", "force_n", "peak_counts", "area_m2", "spread_m", "speed_m_s", "age_s"];
const PLOTS = ["time_s", "frames", "lost", "force_min_n", "force_max_n", "latency_min_ms", "latency_max_ms"];

/** As many digits as 32 bits have. */
const short = (value) => Number(value.toPrecision(7));

/** A picture (PNG) of layers, one canvas over another, with its scale below. */
export function savePicture(layers, name, stamp_s, scale) {
  const ratio = window.devicePixelRatio || 1;
  const caption = CAPTION_PX * ratio;
  const canvas = document.createElement("canvas");
  canvas.width = layers[0].width;
  canvas.height = layers[0].height + caption;
  const context = canvas.getContext("2d");
  context.fillStyle = "white";
  context.fillRect(0, 0, canvas.width, canvas.height);
  for (const layer of layers) context.drawImage(layer, 0, 0);
  context.fillStyle = "#1b2326";
  context.font = `${13 * ratio}px system-ui, "DejaVu Sans", sans-serif`;
  context.textBaseline = "middle";
  const text = `${nameOf(name)}   ${new Date(1000 * stamp_s).toISOString()}   ${scale}`;
  context.fillText(text, 6 * ratio, canvas.height - caption / 2, canvas.width - 12 * ratio);
  canvas.toBlob((picture) => save(`${fileName(name, stamp_s)}.png`, [picture], "image/png"), "image/png");
}

/** A row for each taxel, of a message and the shape of its skin. */
export function saveTaxels(name, shape, message) {
  const { image, confidence, age } = message.arrays;
  // Of an image of another size the rows and columns would be wrong.
  if (image && (image.shape[0] !== shape.rows || image.shape[1] !== shape.cols)) return;
  const rows = [];
  for (let place = 0; image && place < image.data.length; place += 1) {
    const counts = image.data[place];
    const [row, col] = [Math.floor(place / shape.cols), place % shape.cols];
    const tenths_ms = age?.data[place] ?? AGE_UNKNOWN;
    rows.push([
      row, col, short((col - (shape.cols - 1) / 2) * shape.pitch_m), short(((shape.rows - 1) / 2 - row) * shape.row_pitch_m), counts,
      shape.force_n?.[counts] ?? "", confidence?.data[place] ?? "", tenths_ms === AGE_UNKNOWN ? "" : tenths_ms / 1e4,
    ]);
  }
  saveTable(`${fileName(name, message.stamp_s)}_taxels`, ["row", "col", "x_m", "y_m", "counts", "force_n", "confidence", "age_s"], rows);
}

/** A row for each contact of a message. */
export function saveContacts(name, message) {
  const { contacts, contact_numbers } = message.arrays;
  const width = contacts.shape[1];
  const rows = Array.from(contact_numbers.data, (number, index) => [number, ...Array.from(contacts.data.subarray(index * width, (index + 1) * width), short)]);
  saveTable(`${fileName(name, message.stamp_s)}_contacts`, CONTACTS, rows);
}

/** A row for each interval of a history. */
export function savePlots(name, stamp_s, rows) {
  saveTable(`${fileName(name, stamp_s)}_plots`, PLOTS, rows.map(([time_s, ...values]) => [time_s.toFixed(3), ...values.map((value) => (Number.isNaN(value) ? "" : short(value)))]));
}

function saveTable(name, columns, rows) {
  save(`${name}.csv`, [[columns, ...rows].map((row) => row.join(",")).join("\n"), "\n"], "text/csv");
}

/** Of a skin at a time, by letters that all systems allow. */
function fileName(name, stamp_s) {
  const time = new Date(1000 * stamp_s).toISOString().replace(/[:.]/g, "-").replace("Z", "");
  return `${name.replace(/^\//, "").replaceAll("/", "_") || "skin"}_${time}`;
}
