// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The plots of a skin: force and latency as the smallest and largest of each pixel, rate and losses a fifth of a second each.

import { BIN_S, FORCE, FRAMES, LATENCY, LOST } from "./history.js";
import { settings } from "../settings.js";
import { textScale } from "../words.js";

const HEIGHT = 112 * textScale();
const EVERY_MS = 100;
const LEAST_S = 0.05; // of a zoom: some six intervals of the history

const KINDS = [
  { name: "force", title: "Force", unit: "N", least: 1, read: (history, length, pixels, end) => history.extremes(FORCE, length, pixels, end) },
  { name: "latency", title: "Latency", unit: "ms", least: 1, read: (history, length, pixels, end) => history.extremes(LATENCY, length, pixels, end) },
  { name: "rate", title: "Rate", unit: "Hz", least: 100, read: (history, length, pixels, end) => scaled(history.sums(FRAMES, length - (end ?? 0)), 1 / BIN_S) },
  { name: "lost", title: "Lost frames", unit: "", least: 4, isBars: true, read: (history, length, pixels, end) => history.sums(LOST, length - (end ?? 0)) },
];

function scaled([times, values], factor) {
  return [times, values.map((value) => value * factor)];
}

const colour = (name) => () => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export class Plots {
  /** Draws into `element` what of the history is asked for; onZoom() when a person has chosen a part of it. */
  constructor(element, history, onZoom) {
    this.element = element;
    this.history = history;
    this.held = null;
    this.last_ms = 0;
    this.length_s = 0;
    this.drawn_s = 0; // the newest of what is drawn
    this.part = null; // of the window, from and to [s], where one is zoomed
    this.onZoom = onZoom;
    this.plots = KINDS.map((kind) => {
      const figure = document.createElement("figure");
      figure.dataset.plot = kind.name;
      const caption = document.createElement("figcaption");
      caption.textContent = kind.unit ? `${kind.title} [${kind.unit}]` : kind.title;
      figure.append(caption);
      element.append(figure);
      const plot = new uPlot(options(kind, (from_s, to_s) => this.#choose(from_s, to_s), () => this.reset()), kind.isBars || kind.name === "rate" ? [[], []] : [[], [], []], figure);
      alsoByFinger(plot.over);
      return { kind, plot, figure };
    });
    new ResizeObserver(() => this.#resize()).observe(element);
  }

  /** Hold what is shown, or go on. */
  hold(isHeld) {
    // A zoom of what is held already is one of the same moment.
    this.held = isHeld ? this.held ?? this.history.held() : null;
    if (!isHeld) this.reset();
  }

  /** The rows of the history that are shown, without what is out of the window or of a zoom. */
  shown() {
    const history = this.held ?? this.history;
    const [from_s, to_s] = this.#shown;
    return history.rows.filter(([time_s]) => time_s - history.newest_s >= from_s && time_s - history.newest_s <= to_s);
  }

  /** Show the whole window again. */
  reset() {
    this.part = null;
    this.draw(true);
  }

  /** Show a part `share` as long as the present one, with the same end. */
  zoom(share) {
    const [from_s, to_s] = this.#shown;
    this.#showPart(to_s, Math.max(share * (to_s - from_s), LEAST_S));
  }

  /** Show what is before or, above 0, after a zoom: `share` of its length further. */
  move(share) {
    const [from_s, to_s] = this.#shown;
    if (this.part) this.#showPart(to_s + share * (to_s - from_s), to_s - from_s);
  }

  /** Draw, not more often than one can see. */
  draw(now = false) {
    const time_ms = performance.now();
    if (!now && (time_ms - this.last_ms < EVERY_MS || this.held)) return;
    this.last_ms = time_ms;
    const history = this.held ?? this.history;
    const length_s = Number(settings.window);
    // Another window was asked for: all of it, since what was zoomed may not be in it.
    if (length_s !== this.length_s) this.part = null;
    this.length_s = length_s;
    this.drawn_s = history.newest_s;
    const [from_s, to_s] = this.#shown;
    for (const { kind, plot } of this.plots) {
      // Of a part more than of the whole: each of its pixels is a shorter time.
      const pixels = plot.bbox.width / (window.devicePixelRatio || 1);
      plot.setData(kind.read(history, to_s - from_s, pixels, this.part && to_s), false);
      plot.setScale("x", { min: from_s, max: to_s });
    }
  }

  /** Nothing is drawn any more. */
  destroy() {
    for (const { plot } of this.plots) plot.destroy();
    this.plots = [];
  }

  /** From when to when, in seconds before the newest. */
  get #shown() {
    return this.part ?? [-Number(settings.window), 0];
  }

  /** As much of a part as is in the window; all of the window is no zoom. */
  #showPart(end_s, length_s) {
    const window_s = Number(settings.window);
    if (length_s >= window_s) {
      this.reset();
      return;
    }
    const to_s = Math.min(Math.max(end_s, length_s - window_s), 0);
    this.#show(to_s - length_s, to_s);
  }

  /** Show a part of what is drawn: since then more may have come. */
  #choose(from_s, to_s) {
    const { drawn_s } = this;
    this.onZoom();
    // Less where the history began anew.
    const since_s = Math.max((this.held ?? this.history).newest_s - drawn_s, 0);
    this.#show(from_s - since_s, to_s - since_s);
  }

  #show(from_s, to_s) {
    this.onZoom();
    this.part = [from_s, to_s];
    this.draw(true);
  }

  #resize() {
    for (const { plot, figure } of this.plots) plot.setSize({ width: figure.clientWidth, height: HEIGHT });
  }
}

/** Where a series has values with a gap on both sides, as all of a slow skin: no line shows them, so they are dots. */
function alone(plot, series) {
  const values = plot.data[series];
  return Array.from(values.keys()).filter((at) => values[at] !== null && (values[at - 1] ?? values[at + 1] ?? null) === null);
}

/** Lets a finger choose as the mouse does, to which alone uPlot listens. */
function alsoByFinger(over) {
  let start_px = 0;
  const asMouse = (type, event, clientX) => {
    if (event.pointerType === "mouse" || !event.isPrimary) return;
    // uPlot passes over a mouse that has not moved.
    over.dispatchEvent(new MouseEvent(type, { bubbles: true, clientX, clientY: event.clientY, movementX: 1 }));
  };
  over.addEventListener("pointerdown", (event) => {
    start_px = event.clientX;
    asMouse("mousedown", event, start_px);
  });
  over.addEventListener("pointermove", (event) => asMouse("mousemove", event, event.clientX));
  // A finger that is lifted is nowhere.
  over.addEventListener("pointerup", (event) => {
    for (const type of ["mouseup", "mouseleave"]) asMouse(type, event, event.clientX);
  });
  // The browser scrolls the page instead: back to where it began is no choice.
  over.addEventListener("pointercancel", (event) => {
    for (const type of ["mousemove", "mouseup", "mouseleave"]) asMouse(type, event, start_px);
  });
}

function options(kind, onZoom, onReset) {
  const ink = colour("--ink-soft");
  const line = colour(`--plot-${kind.name}`);
  const fill = colour(`--plot-${kind.name}-fill`);
  const axis = { stroke: ink, font: `${11 * textScale()}px system-ui, sans-serif`, ticks: { show: false }, grid: { stroke: colour("--line"), width: 1 } };
  const series = { stroke: line, width: 1.25, points: { show: false, filter: alone, size: 4, fill: line }, spanGaps: false };
  const values = kind.isBars
    ? [{ ...series, width: 0, fill: line, paths: uPlot.paths.bars({ size: [0.8, 12] }) }]
    : kind.name === "rate" ? [series] : [series, series];
  return {
    width: 300,
    height: HEIGHT,
    padding: [6, 12 * textScale(), 0, 0],
    legend: { show: false },
    cursor: { y: false, points: { show: false }, drag: { setScale: false, x: true, y: false }, bind: { dblclick: () => () => { onReset(); return null; } } },
    scales: {
      x: { time: false },
      y: { range: (plot, low, high) => [0, Math.max(kind.least, 1.1 * (high ?? 0))] },
    },
    axes: [
      { ...axis, size: 22 * textScale(), space: 60 * textScale(), values: (plot, times) => times.map((time) => (time === 0 ? "now" : `${Number(time.toFixed(3))} s`)) },
      { ...axis, size: 44 * textScale(), space: 26 * textScale() },
    ],
    series: [{}, ...values],
    bands: values.length === 2 ? [{ series: [1, 2], fill }] : [],
    hooks: {
      setSelect: [(plot) => {
        if (plot.select.width < 4) return;
        const { left, width } = plot.select;
        onZoom(plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
        plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
      }],
    },
  };
}
