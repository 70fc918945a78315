// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the skins measure is recorded by the server, raw; here it is begun, ended, and its files are fetched.

import { arrange } from "./arrange.js";
import { fetchFile, save } from "./files.js";
import { ask } from "./requests.js";
import { setText } from "./words.js";

const megabytes = (bytes) => `${(bytes / 1e6).toFixed(1)} MB`;

export class Recording {
  constructor(element) {
    this.element = element;
    this.button = element.querySelector("button");
    this.line = element.querySelector(".answer");
    this.list = element.querySelector("ul");
    this.isOn = false;
    this.note = "";
    onceAtATime(this.button, () => this.#toggle());
  }

  /** The newest of the server; hidden where it does not record for pages. */
  show(recording) {
    this.element.hidden = !recording;
    if (!recording) return;
    this.#showOn(recording.on);
    // What counts on by itself is not read out.
    this.line.setAttribute("aria-live", recording.on ? "off" : "polite");
    if (recording.on) {
      this.note = "";
      this.#tell(`${recording.name}: ${recording.elapsed_s.toFixed(0)} s, ${megabytes(recording.bytes)}, ${recording.messages} messages, ${recording.lost} lost`);
    } else if (recording.note !== this.note) {
      // Once: what a button was answered since then is newer.
      this.note = recording.note;
      this.#tell(recording.note);
    }
    // What is there stays: a person may be about to press it, or it is being fetched. Another size is another file.
    arrange(this.list, recording.files.map((file) => JSON.stringify(file)), (key) => this.#file(...JSON.parse(key)));
  }

  async #toggle() {
    const { isOn } = this;
    const { done, text } = await ask(isOn ? "stop_recording" : "record");
    // The server tells it a while later; until then the next press would ask for the same again.
    if (done) this.#showOn(!isOn);
    this.#tell(text, done);
  }

  #showOn(isOn) {
    this.isOn = isOn;
    this.button.textContent = isOn ? "Stop recording" : "Record";
    // Of what is read out the words alone say it: "Stop recording, pressed" would say that it was stopped.
    this.button.dataset.on = String(isOn);
  }

  #file(name, bytes) {
    const item = document.createElement("li");
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `Download ${name}`;
    const size = document.createElement("span");
    size.textContent = megabytes(bytes);
    onceAtATime(button, async () => {
      try {
        const file = await fetchFile(`recordings/${name}`, (sent) => { size.textContent = `${megabytes(sent)} of ${megabytes(bytes)}`; });
        save(name, [file], "application/octet-stream");
        size.textContent = megabytes(bytes);
      } catch (error) {
        size.textContent = error.message;
      }
    });
    item.append(button, size);
    return item;
  }

  #tell(text, done = true) {
    this.line.dataset.done = String(done);
    setText(this.line, text);
  }
}

/** Let a button do something that takes a while, and nothing meanwhile. A disabled one would lose the focus of the keys. */
function onceAtATime(button, act) {
  button.onclick = async () => {
    if (button.getAttribute("aria-disabled") === "true") return;
    button.setAttribute("aria-disabled", "true");
    await act();
    button.setAttribute("aria-disabled", "false");
  };
}
