// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Of a ball that is balanced: what the controller is about, where the ball is, and how the plate is tilted.

import { rounded, setText } from "../words.js";

const FULL_RAD = 0.15; // the rim of the level

export class Ball {
  constructor(element) {
    this.element = element;
    element.innerHTML = `
      <h3>Ball <span class="state"></span></h3><p class="reason"></p>
      <div class="balance">
        <svg class="level" viewBox="-1.22 -1.22 2.44 2.44" role="img" aria-label="tilt of the plate">
          <circle r="1"/><path d="M-1 0H1M0 -1V1"/><circle class="commanded" r="0.16"/><circle class="measured" r="0.1"/>
        </svg>
        <dl class="numbers">
          <div><dt>Ball [mm]</dt><dd data-ball="ball"></dd></div>
          <div><dt>Reference [mm]</dt><dd data-ball="reference"></dd></div>
          <div><dt>Off by [mm]</dt><dd data-ball="off"></dd></div>
          <div><dt>Tilt [°]</dt><dd data-ball="tilt"></dd></div>
        </dl>
      </div>
      <p class="note">In the circle: ring, the tilt that is asked for; dot, that of the plate; rim ${Math.round((FULL_RAD * 180) / Math.PI)}°.</p>`;
    this.find = (selector) => element.querySelector(selector);
  }

  /** The newest; hidden as long as nothing is published. */
  show(told) {
    this.element.hidden = !Object.keys(told).length;
    if (this.element.hidden) return;
    const { ball, reference, segment, state, reason, tilt_measured, tilt_commanded } = told;
    setText(this.find(".state"), [state, segment && segment !== "hold" ? `segment ${segment}` : ""].filter(Boolean).join(" · "));
    setText(this.find(".reason"), reason && reason !== state ? reason : "");
    setText(this.find("[data-ball=ball]"), ball === null ? "none" : ball ? millimetres(ball) : "–");
    setText(this.find("[data-ball=reference]"), reference ? millimetres(reference) : "–");
    const off_m = ball && reference ? Math.hypot(ball[0] - reference[0], ball[1] - reference[1]) : null;
    setText(this.find("[data-ball=off]"), off_m === null ? "–" : (1000 * off_m).toFixed(1));
    setText(this.find("[data-ball=tilt]"), tilt_measured ? degrees(tilt_measured) : "–");
    place(this.find(".measured"), tilt_measured);
    place(this.find(".commanded"), tilt_commanded);
  }
}

/** A tilt about x lowers one side along y: the dot goes where a ball would roll. */
function place(dot, tilt) {
  dot.style.display = tilt ? "" : "none";
  if (!tilt) return;
  const [about_x, about_y] = tilt.map((angle_rad) => Math.max(-1, Math.min(1, angle_rad / FULL_RAD)));
  dot.setAttribute("cx", about_y.toFixed(3));
  dot.setAttribute("cy", about_x.toFixed(3));
}

function millimetres([x_m, y_m]) {
  return `${rounded(1000 * x_m, 1)}, ${rounded(1000 * y_m, 1)}`;
}

function degrees([about_x, about_y]) {
  return [about_x, about_y].map((angle_rad) => rounded((angle_rad * 180) / Math.PI, 2)).join(", ");
}
