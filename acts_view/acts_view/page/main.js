// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Puts the page together: messages to panels, choices to what is drawn.

import { connect } from "./connection.js";
import { Controls } from "./controls.js";
import { Diagnostics } from "./diagnostics.js";
import { Panels } from "./panels.js";
import { Recording } from "./recording.js";
import { Replay } from "./replay.js";
import { answered, forgetAll, heardClock, useConnection } from "./requests.js";
import { next, onChange, set, settings } from "./settings.js";
import { nameOf, setText } from "./words.js";

const TICK_MS = 50;
const BEHIND_S = 2; // nobody should take what is so old for the present
const STATES = { connecting: "connecting", live: "connected", behind: "connected, but what is shown is seconds old: the line is slow", gone: "server gone, trying again", refused: "the server refuses this page: does the address have its token, or are 32 pages open?" };
const LISTS = ["scale", "unit", "colours", "window"];
const SWITCHES = ["smooth", "contacts", "outlines", "unsure", "measured", "keys"];
const KEYS = { s: "scale", n: "unit", m: "colours", i: "smooth", c: "contacts", o: "outlines", u: "unsure", t: "measured", d: "theme" };
const ZOOMS = {
  "+": (plots) => plots.zoom(0.5),
  "=": (plots) => plots.zoom(0.5), // the same key without Shift
  "-": (plots) => plots.zoom(2),
  0: (plots) => plots.reset(),
  "<": (plots) => plots.move(-0.5),
  ">": (plots) => plots.move(0.5),
};

const panels = new Panels(document.getElementById("skins"), () => hold(true));
const diagnostics = new Diagnostics(document.getElementById("diagnostics"));
const replay = new Replay(document.getElementById("replay"), () => panels.isHeld);
const recording = new Recording(document.getElementById("recording"));
const controls = new Controls(document.getElementById("controls"));

let version = null; // of the page that this is

const darkSystem = matchMedia("(prefers-color-scheme: dark)");
const byId = (id) => document.getElementById(id);

function onMessage(message) {
  if (message.type === "skin") panels.of(message.skin).describe(message);
  else if (message.type === "frame") panels.of(message.skin).take(message);
  else if (message.type === "answer") answered(message);
  else if (message.type === "status") {
    showState(heardClock(message.clock_s) > BEHIND_S ? "behind" : "live");
    version ??= message.version;
    // The server was started again with another page, as after an update; what is paused is looked at first.
    if (message.version !== version && !panels.isHeld) location.reload();
    diagnostics.show(message.diagnostics);
    replay.show(message.replay);
    recording.show(message.recording);
    controls.show(message);
    byId("note").textContent = message.note ?? "";
    panels.offer(message.skins ?? []);
    showWhyEmpty(message.skins ?? []);
  }
  // Before the first status nobody knows whether there is a skin.
  if (panels.size || message.type === "status") byId("empty").hidden = panels.size > 0;
}

/** What to do where there is no panel: of skins that the server waits for, something else than without any. */
function showWhyEmpty(names) {
  const [none, named] = [".none", ".named"].map((part) => byId("empty").querySelector(part));
  none.hidden = names.length > 0;
  named.hidden = !none.hidden;
  named.querySelector("strong").textContent = names.map(nameOf).join(", ");
}

function showState(state) {
  byId("connection").dataset.state = state;
  setText(byId("connection"), STATES[state]);
}

function onState(state) {
  showState(state);
  document.body.dataset.connection = state;
  if (state === "live") panels.begin();
  else panels.end();
  if (state === "gone" || state === "refused") forgetAll();
}

function hold(isHeld) {
  byId("pause").setAttribute("aria-pressed", String(isHeld));
  byId("pause").textContent = isHeld ? "Go on" : "Pause";
  panels.hold(isHeld);
  if (!isHeld) replay.goOn();
}

function show() {
  for (const name of LISTS) byId(name).value = settings[name];
  for (const name of SWITCHES) byId(name).setAttribute("aria-pressed", String(settings[name]));
  byId("theme").textContent = `Theme: ${settings.theme}`;
  document.documentElement.dataset.theme = settings.theme === "auto" ? (darkSystem.matches ? "dark" : "light") : settings.theme;
  for (const one of panels) one.redraw();
}

for (const name of LISTS) {
  let isByKeys = false;
  byId(name).onkeydown = () => { isByKeys = true; };
  byId(name).onpointerdown = () => { isByKeys = false; };
  byId(name).onchange = (event) => {
    set(name, event.target.value);
    // The next key is one of the page again, but where keys chose, the next one may choose on.
    if (!isByKeys) event.target.blur();
  };
}
for (const name of [...SWITCHES, "theme"]) byId(name).onclick = () => next(name);
byId("pause").onclick = () => hold(!panels.isHeld);
document.addEventListener("keydown", (event) => {
  // A button that is kept down by this key is pressed once: a robot would be told thirty times a second.
  if (event.repeat && event.key === "Enter" && event.target.closest("button")) event.preventDefault();
  if (!settings.keys || event.ctrlKey || event.metaKey || event.altKey) return;
  // What is typed there is theirs; a slider has arrows, Home, End and the page keys, and none of these is ours.
  if (event.target.closest("select, input:not([type=range])")) return;
  const isBlank = event.key === " ";
  // On a button the blank presses that.
  if (isBlank ? event.target.closest("button, summary") : !(event.key in KEYS || event.key in ZOOMS)) return;
  event.preventDefault();
  if (event.key in ZOOMS) for (const one of panels) ZOOMS[event.key](one.plots);
  // Of the others one that is kept down acts once, or the page would flicker.
  else if (event.repeat) return;
  else if (event.key in KEYS) next(KEYS[event.key]);
  else if (replay.isShown) replay.toggle();
  else hold(!panels.isHeld);
});
// What gets the focus of the keys is not scrolled under the bars that stay at the edges of the window.
const bars = [document.querySelector("header.bar"), byId("replay")];
const keepClear = new ResizeObserver(() => {
  const [top, bottom] = bars.map((bar) => (getComputedStyle(bar).position === "sticky" ? bar.offsetHeight : 0));
  document.documentElement.style.scrollPadding = `${top}px 0 ${bottom}px`;
});
for (const bar of bars) keepClear.observe(bar);
// Of a row that a finger moves a browser shows only the edge of what the keys go to; a press would miss what moves.
document.querySelector(".controls").addEventListener("focusin", ({ target }) => {
  if (target.matches(":focus-visible")) target.scrollIntoView({ block: "nearest", inline: "nearest" });
});
darkSystem.addEventListener("change", show);
onChange(show);
show();
setInterval(() => {
  if (!document.hidden) panels.tick(replay.isHeld);
}, TICK_MS);
useConnection(connect(onMessage, onState));
