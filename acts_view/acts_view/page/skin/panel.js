// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// One skin: its picture, its numbers, its contacts, its plots and, where there are such, a known object, a ball, a hand.

import { Ball } from "./ball.js";
import { gradient } from "./colours.js";
import { History, LATENCY, LOST } from "./history.js";
import { Objects } from "./objects.js";
import { Plots } from "./plots.js";
import { Regions } from "./regions.js";
import { saveContacts, savePicture, savePlots, saveTaxels } from "./saving.js";
import { settings } from "../settings.js";
import { SkinView } from "./view.js";
import { nameOf, rounded, setText } from "../words.js";

const CONTACT_ROWS = 4;
const SILENT_MS = 1500;
const SHAPE_MS = 500; // so long the node that knows what a skin is like may take to tell it
const NEAR = "50%"; // of the window, beyond its edges: so far a skin is drawn, too, since one may scroll there
const NUMBERS_EVERY_MS = 200; // faster, nobody can read them

const NUMBERS = [
  ["force", "Force", "N"],
  ["x", "Centre x", "mm"],
  ["y", "Centre y", "mm"],
  ["peak", "Peak", "counts"],
  ["area", "Area", "mm²"],
  ["rate", "Rate", "Hz"],
  ["latency", "Latency, worst", "ms"],
  ["lost", "Lost", "in 60 s"],
];

const SAVERS = [
  ["picture", "Picture", "of the skin, as it is shown (PNG)"],
  ["taxels", "Taxels, CSV", "a row for each taxel"],
  ["contacts", "Contacts, CSV", "a row for each contact"],
  ["plots", "Plots, CSV", "what the plots show, 8 ms a row"],
];

const COLUMNS = [["force", "N"], ["peak", "counts"], ["area", "mm²"], ["speed", "mm/s"]];

const MARKUP = `
  <header><h2></h2><p class="shape"></p><p class="pill" data-state="waiting">waiting</p><p class="lacks"></p></header>
  <div class="body">
    <div class="picture">
      <div class="canvases"><canvas class="taxels"></canvas><canvas class="marks" tabindex="0" role="img"></canvas></div>
      <div class="legend"><div class="ramp"></div><p class="ends"><span>0</span><span class="unit">counts</span><span class="top">1023</span></p></div>
      <p class="pointed"></p><p class="unseen" role="status"></p>
      <p class="savers" role="group" aria-label="Save what is shown">${SAVERS.map(([what, title, tip]) => `<button type="button" data-save="${what}" title="${tip}">${title}</button>`).join("")}</p>
    </div>
    <div class="facts">
      <dl class="numbers">${NUMBERS.map(([key, title, unit]) => `<div data-of="${key}"><dt>${title} [${unit}]</dt><dd><output aria-live="off" data-number="${key}">–</output></dd></div>`).join("")}</dl>
      <table class="contacts">
        <caption>Contacts</caption>
        <thead><tr><th scope="col">no.</th>${COLUMNS.map(([title, unit]) => `<th scope="col">${title} <small>${unit}</small></th>`).join("")}</tr></thead>
        <tbody>${`<tr>${"<td></td>".repeat(1 + COLUMNS.length)}</tr>`.repeat(CONTACT_ROWS)}</tbody>
      </table>
      <p class="more"></p>
      <section class="object" hidden></section>
    </div>
    <div class="plots"></div>
    <section class="ball robot" hidden></section>
    <section class="regions robot" hidden></section>
  </div>`;

export class Panel {
  constructor(name, onHold) {
    this.name = name;
    this.history = new History();
    this.heard_ms = performance.now();
    this.numbers_ms = 0;
    this.isHeld = false;
    this.message = null;
    this.latest = null; // that came while another one is held
    this.coming = null;
    this.drawing = null; // asked for, but not done yet
    this.element = document.createElement("article");
    this.element.className = "card skin";
    this.element.dataset.skin = name;
    // The first skin that a server shows is a square until it is told: drawn so, a hand would jump.
    this.element.dataset.told = "false";
    setTimeout(() => this.#appear(), SHAPE_MS);
    this.element.innerHTML = MARKUP;
    this.find = (selector) => this.element.querySelector(selector);
    this.find("h2").textContent = nameOf(name);
    this.find("canvas.marks").setAttribute("aria-label", `tactile image of ${nameOf(name)}; arrow keys move from taxel to taxel`);
    this.view = new SkinView(this.find(".canvases"), (text, isMoved) => {
      setText(this.find(".pointed"), text);
      // Read out is where a person goes, not how the value changes there thirty times a second.
      if (isMoved) setText(this.find(".unseen"), text);
    });
    this.plots = new Plots(this.find(".plots"), this.history, onHold);
    this.objects = new Objects(this.find(".object"));
    this.ball = new Ball(this.find(".ball"));
    this.regions = new Regions(this.find(".regions"));
    for (const button of this.element.querySelectorAll("[data-save]")) button.onclick = () => this.#save(button.dataset.save);
    this.outputs = Object.fromEntries(NUMBERS.map(([key]) => [key, this.find(`[data-number=${key}]`)]));
    this.rows = [...this.element.querySelectorAll("tbody tr")].map((row) => [...row.cells]);
    // Of many skins most are beyond the window's edges, and to draw those, too, makes the others jerk.
    this.isSeen = true;
    new IntersectionObserver((changes) => this.#see(changes.at(-1).isIntersecting), { rootMargin: NEAR }).observe(this.element);
  }

  /** What the skin is like; one whose picture is held is as it was until then. */
  describe(shape) {
    if (shape.told) this.#appear();
    this.coming = this.isHeld && this.message ? shape : null;
    if (this.coming) return;
    this.shape = shape;
    const [width_mm, height_mm] = [shape.cols * shape.pitch_m, shape.rows * shape.row_pitch_m].map((side) => Math.round(1000 * side));
    const size = shape.patches.length > 1 ? `${shape.patches.length} patches` : `${width_mm} × ${height_mm} mm`;
    const layout = shape.layout === "square" ? "" : `${shape.layout.split("/").pop().replace(/\.ya?ml$/, "").replaceAll("_", " ")} · `;
    this.find(".shape").textContent = `${layout}${shape.rows} × ${shape.cols} taxels · ${size}`;
    setText(this.find(".lacks"), this.#lacks);
    // The middle of a hand's fingers is nowhere.
    for (const key of ["x", "y"]) this.find(`[data-of=${key}]`).hidden = shape.patches.length > 1;
    this.view.setShape(shape);
    this.find(".legend").style.maxWidth = this.find(".canvases").style.maxWidth;
  }

  /** The newest state. */
  take(message) {
    // What controls the skin is in messages too, and may go on without it.
    if (message.silent_s !== null) this.heard_ms = performance.now() - 1000 * message.silent_s;
    this.history.take(message);
    this.objects.take(message.object);
    if (this.isHeld) {
      this.latest = message;
      return;
    }
    this.#show(message);
    // With the next picture of the screen: where drawing takes longer than from one message to the next, messages would
    // pile up and ever older ones be shown. Of a page that nobody sees a browser makes no picture.
    if (this.isSeen) this.drawing ??= requestAnimationFrame(() => this.#drawSkin());
  }

  /** Hold what is shown, or go on. */
  hold(isHeld) {
    // A zoom of what is held already changes nothing else of it.
    if (isHeld === this.isHeld) return;
    this.isHeld = isHeld;
    if (!isHeld) {
      if (this.coming) this.describe(this.coming);
      // Of a recording that is held, or a skin that has ended, no other follows.
      if (this.latest) this.#show(this.latest);
      this.latest = null;
    }
    this.#drawSkin();
    this.plots.hold(isHeld);
    // The figures beside the picture that is held are its own.
    this.#showFigures(performance.now());
    this.tick();
  }

  /** After a change of what is to be shown. */
  redraw() {
    this.find(".ramp").style.background = gradient(settings.colours);
    this.#drawSkin();
    this.plots.draw(true);
  }

  /** The connection was lost and is there again: the server sends all of its history. */
  forget() {
    this.history.clear();
    this.objects.forget();
  }

  /** The server has it no longer. */
  remove() {
    this.element.remove();
    this.plots.destroy();
  }

  /**
   * Now and then: numbers, plots, and whether the skin is silent; of a recording that is held (`isStill`) it is meant
   * to be. `isGone`: this server has not told of it.
   */
  tick(isStill = false, isGone = false) {
    const now_ms = performance.now();
    const silent_ms = now_ms - this.heard_ms;
    const pill = this.find(".pill");
    const isSilent = silent_ms > SILENT_MS;
    const state = this.isHeld ? "held" : isGone || !this.#isHeard ? "waiting" : isStill ? "held" : isSilent ? "silent" : "live";
    const words = { held: "paused", waiting: "waiting", silent: `silent for ${Math.round(silent_ms / 1000)} s`, live: "live" }[state];
    setText(pill, words);
    pill.dataset.state = state;
    this.element.dataset.gone = String(isGone && !this.isHeld);
    this.element.dataset.silent = String(state === "silent");
    if (this.isSeen) this.plots.draw();
    if (!this.isHeld && now_ms - this.numbers_ms > NUMBERS_EVERY_MS) this.#showFigures(now_ms);
  }

  /** Have a message drawn next. */
  #show(message) {
    this.message = message;
    this.regions.take(message.hand);
    this.view.setState(message);
  }

  #see(isSeen) {
    if (isSeen && !this.isSeen) this.redraw();
    this.isSeen = isSeen;
  }

  #appear() {
    this.element.dataset.told = "true";
  }

  /** Whether the skin itself has said something to this server. */
  get #isHeard() {
    return this.message !== null && this.message.silent_s !== null;
  }

  /** Save what is shown; before the first message there is nothing. */
  #save(what) {
    const { message, name } = this;
    if (!message || !this.shape) return;
    const { top, unit } = this.view.taxels;
    const scale = `0 to ${inUnit(top, unit)} ${unit}`;
    if (what === "picture") savePicture(this.view.layers, name, message.stamp_s, scale);
    if (what === "taxels") saveTaxels(name, this.shape, message);
    if (what === "contacts") saveContacts(name, message);
    if (what === "plots") savePlots(name, message.stamp_s, this.plots.shown());
  }

  #showFigures(now_ms) {
    if (!this.message) return;
    this.numbers_ms = now_ms;
    if (this.shape) setText(this.find(".lacks"), this.#lacks);
    this.#showNumbers();
    this.#showContacts();
    this.objects.show(this.message.object);
    this.ball.show(this.message.ball);
    this.regions.show(this.message.regions, this.message.hand);
  }

  /** What cannot be shown of the skin, in words. */
  get #lacks() {
    const { rows, cols, note } = this.shape;
    const [high, wide] = this.message?.arrays.image?.shape ?? [rows, cols];
    const fits = high === rows && wide === cols;
    return fits ? note : `not shown: an image of ${high} × ${wide} taxels, of a skin that has ${rows} × ${cols}`;
  }

  #drawSkin() {
    this.drawing = null;
    this.view.draw();
    const { top, unit } = this.view.taxels;
    setText(this.find(".top"), inUnit(top, unit));
    setText(this.find(".unit"), unit);
  }

  #showNumbers() {
    const { touch, touch_known } = this.message;
    const [x_m, y_m, force_n, peak, area_m2] = touch ?? [];
    const history = this.plots.held ?? this.history;
    const { rate_hz } = history;
    const [, lost] = history.sums(LOST, 60);
    const [, latencies] = history.extremes(LATENCY, 1, 1);
    const nothing = (words) => (this.#isHeard && touch_known ? words : "–");
    const values = {
      force: touch ? force_n.toFixed(2) : nothing("0.00"),
      x: touch ? rounded(1000 * x_m, 1) : "–",
      y: touch ? rounded(1000 * y_m, 1) : "–",
      peak: touch ? peak.toFixed(0) : nothing("0"),
      area: touch ? (1e6 * area_m2).toFixed(0) : nothing("0"),
      rate: Number.isNaN(rate_hz) ? "–" : rate_hz.toFixed(rate_hz < 10 ? 1 : 0),
      latency: latencies.length ? Math.max(...latencies).toFixed(1) : "–",
      lost: nothing(lost.reduce((sum, count) => sum + count, 0).toFixed(0)),
    };
    for (const [key, text] of Object.entries(values)) setText(this.outputs[key], text);
  }

  #showContacts() {
    const { contacts, contact_numbers } = this.message.arrays;
    const width = contacts.shape[1];
    const numbers = contact_numbers.data;
    this.rows.forEach((cells, index) => {
      let words = ["", "", "", "", ""];
      if (index < numbers.length) {
        const [, , force_n, peak, area_m2, , speed_m_s] = contacts.data.subarray(index * width, (index + 1) * width);
        words = [numbers[index], force_n.toFixed(2), peak.toFixed(0), (1e6 * area_m2).toFixed(0), (1000 * speed_m_s).toFixed(0)];
      }
      cells.forEach((cell, column) => { cell.textContent = words[column]; });
    });
    const more = numbers.length - this.rows.length;
    this.find(".more").textContent = more > 0 ? `and ${more} more` : "";
  }
}

/** The end of a scale, in words. */
function inUnit(top, unit) {
  return unit === "counts" ? String(Math.round(top)) : top.toFixed(2);
}
