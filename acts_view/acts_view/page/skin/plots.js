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
  { name: "force", title: "Force", unit: "N", least: 1, read: (history, length, pixels) => history.extremes(FORCE, length, pixels) },
  { name: "latency", title: "Latency", unit: "ms", least: 1, read: (history, length, pixels) => history.extremes(LATENCY, length, pixels) },
  { name: "rate", title: "Rate", unit: "Hz", least: 100, read: (history, length) => scaled(history.sums(FRAMES, length), 1 / BIN_S) },
  { name: "lost", title: "Lost frames", unit: "", least: 4, isBars: true, read: (history, length) => history.sums(LOST, length) },
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
    this.isZoomed = false;
    this.onZoom = onZoom;
    this.plots = KINDS.map((kind) => {
      const figure = document.createElement("figure");
      figure.dataset.plot = kind.name;
      const caption = document.createElement("figcaption");
      caption.textContent = kind.unit ? `${kind.title} [${kind.unit}]` : kind.title;
      figure.append(caption);
      element.append(figure);
      const plot = new uPlot(options(kind, (from_s, to_s) => this.#show(from_s, to_s), () => this.reset()), kind.isBars || kind.name === "rate" ? [[], []] : [[], [], []], figure);
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
    const { min, max } = this.plots[0].plot.scales.x;
    return history.rows.filter(([time_s]) => time_s - history.newest_s >= min && time_s - history.newest_s <= max);
  }

  /** Show the whole window again. */
  reset() {
    this.isZoomed = false;
    this.draw(true);
  }

  /** Show a part `share` as long as the present one, with the same end. */
  zoom(share) {
    const { min, max } = this.plots[0].plot.scales.x;
    this.#showPart(max, Math.max(share * (max - min), LEAST_S));
  }

  /** Show what is before or, above 0, after a zoom: `share` of its length further. */
  move(share) {
    const { min, max } = this.plots[0].plot.scales.x;
    if (this.isZoomed) this.#showPart(max + share * (max - min), max - min);
  }

  /** Draw, not more often than one can see. */
  draw(now = false) {
    const time_ms = performance.now();
    if (!now && (time_ms - this.last_ms < EVERY_MS || this.held)) return;
    this.last_ms = time_ms;
    const history = this.held ?? this.history;
    const length_s = Number(settings.window);
    // Another window was asked for: all of it, since what was zoomed may not be in it.
    if (length_s !== this.length_s) this.isZoomed = false;
    this.length_s = length_s;
    for (const { kind, plot } of this.plots) {
      const data = kind.read(history, length_s, plot.bbox.width / (window.devicePixelRatio || 1));
      plot.setData(data, false);
      if (!this.isZoomed) plot.setScale("x", { min: -length_s, max: 0 });
      else plot.redraw();
    }
  }

  /** Nothing is drawn any more. */
  destroy() {
    for (const { plot } of this.plots) plot.destroy();
    this.plots = [];
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

  #show(from_s, to_s) {
    this.isZoomed = true;
    this.onZoom();
    for (const { plot } of this.plots) plot.setScale("x", { min: from_s, max: to_s });
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
