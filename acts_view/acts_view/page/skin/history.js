// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the 1 kHz stream was like: rows of the server's history, and what of them a plot shows.

// Columns as in acts_view/skin/history.py.
export const FRAMES = 1, LOST = 2, FORCE = 3, LATENCY = 5;
const WIDTH = 7;
const INTERVAL_S = 0.008;
const CAPACITY = 7500;
const GAP_S = 0.1;
const LEAST_ROWS = 10; // fewer in a second do not tell a rate
/** Rate and losses are counted over so long. */
export const BIN_S = 0.2;

export class History {
  constructor() {
    this.clear();
  }

  clear() {
    this.rows = []; // each [time_s, ...], oldest first
    this.life = null;
  }

  /** Take the rows of a message; another life than before: the stream began anew. */
  take(message) {
    if (message.life !== this.life) {
      this.clear();
      this.life = message.life;
    }
    const { data } = message.arrays.history;
    for (let at = 0; at < data.length; at += WIDTH) {
      const row = Array.from(data.subarray(at, at + WIDTH));
      row[0] += message.base_s;
      this.rows.push(row);
    }
    // Seldom, since it moves all of them.
    if (this.rows.length > 1.2 * CAPACITY) this.rows = this.rows.slice(-CAPACITY);
  }

  /** The same rows, to be held. */
  held() {
    const copy = new History();
    copy.rows = this.rows.slice();
    copy.life = this.life;
    return copy;
  }

  get newest_s() {
    return this.rows.length ? this.rows[this.rows.length - 1][0] + INTERVAL_S : 0;
  }

  /** Frames a second, over the last second, or of a slow skin longer; NaN where it is not known. */
  get rate_hz() {
    const second = this.#last(1);
    const rows = second.length > LEAST_ROWS ? second : this.rows.slice(-LEAST_ROWS);
    if (rows.length < 2) return NaN;
    const frames = rows.slice(1).reduce((sum, row) => sum + row[FRAMES], 0);
    return frames / (rows[rows.length - 1][0] - rows[0][0]);
  }

  /**
   * Smallest and largest value of a column (its minimum; the maximum is the next one) for each of at most `pixels`
   * steps of the last `length_s`; as [times, maxima, minima], times in seconds before the newest, null where there is a
   * gap. Or of `length_s` that end at `end_s`, with a step more on both sides, so that lines reach the edges.
   */
  extremes(column, length_s, pixels, end_s = null) {
    const step_s = INTERVAL_S * Math.max(1, Math.ceil(length_s / Math.max(pixels, 1) / INTERVAL_S));
    const [times, highs, lows] = [[], [], []];
    let last = null;
    const until_s = this.newest_s + (end_s ?? 0) + step_s;
    for (const row of this.#last(end_s === null ? length_s : length_s - end_s + step_s)) {
      if (row[0] > until_s) break;
      // By absolute time, so that a value stays in its step while the plot moves.
      const number = Math.floor((row[0] + 0.001) / step_s);
      const [low, high] = [row[column], row[column + 1]];
      if (Number.isNaN(low)) continue;
      const at = times.length - 1;
      if (number === last) {
        lows[at] = Math.min(lows[at], low);
        highs[at] = Math.max(highs[at], high);
        continue;
      }
      if (last !== null && (number - last) * step_s > GAP_S + step_s) {
        times.push((last + 1) * step_s - this.newest_s);
        highs.push(null);
        lows.push(null);
      }
      times.push(number * step_s - this.newest_s);
      highs.push(high);
      lows.push(low);
      last = number;
    }
    return [times, highs, lows];
  }

  /** Sums of a column over bins of `BIN_S`, those that are complete; as [times, sums], 0 where nothing came. */
  sums(column, length_s) {
    const [times, sums] = [[], []];
    let number = null;
    for (const row of this.#last(length_s + BIN_S)) {
      const own = Math.floor((row[0] + 0.001) / BIN_S);
      for (number ??= own - 1; number < own; ) {
        number += 1;
        times.push(number * BIN_S - this.newest_s);
        sums.push(0);
      }
      sums[sums.length - 1] += row[column];
    }
    // The first may have begun before what is kept, the last is not over.
    return [times.slice(1, -1), sums.slice(1, -1)];
  }

  #last(length_s) {
    const from_s = this.newest_s - length_s;
    let [low, high] = [0, this.rows.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.rows[middle][0] < from_s) low = middle + 1;
      else high = middle;
    }
    return this.rows.slice(low);
  }
}
