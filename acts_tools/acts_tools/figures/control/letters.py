# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figure 10, B to D: a ball that traces letters, by touch alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from acts_control.ball import TrajectoryConfig
from acts_tools.demo.ball.offline_chain import Chain, run
from acts_tools.demo.ball.score import LETTERS, rms_error_mm
from acts_tools.figures.figure import Figure
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, SAME, TRUTH, Curve, Panel
from acts_tools.figures.skin_images import skin_panel

_METHODS = {
    "paper's sampling and recovery": (SAME, "adaptive", "per_frame"),
    "ours": (OURS, "tracking", "fusion"),
}
_LEAST = 1e-3
"""Of the largest cumulative pressure: the end of the colour scale."""

_LIMIT_S = 30.0
_EACH_S = 12
"""About the simulated time of a letter, for the progress [s]."""

_EVERY = 4
"""Control steps from one point of a drawn path to the next."""


def _measure_all(one: Run) -> Any:
    letters = one.pick(LETTERS, LETTERS[-1:])
    found: list[dict[str, Any]] = []
    with one.progress("letters", _EACH_S * len(letters) * len(_METHODS)) as progress:
        for letter in letters:
            for label, (_, scheme, method) in _METHODS.items():
                trajectory = TrajectoryConfig(trajectory=f"hold,{letter}", hold_s=one.pick(3.0, 1.0))
                chain = Chain(trajectory=trajectory, scheme=scheme, method=method, seed=one.seed)
                recording = run(chain, _LIMIT_S, lambda at_s: progress.show(_EACH_S * len(found) + at_s))
                kept = [number for number, name in enumerate(recording.segments) if name == letter][::_EVERY]
                pressure = recording.segment_pressure.get(letter)
                found.append(
                    {
                        "letter": letter,
                        "method": label,
                        "finished": recording.finished,
                        "why": recording.stop_reason,
                        "error_mm": rms_error_mm(recording, letter),
                        "path_mm": [_mm(track, kept) for track in (recording.truth, recording.reference)],
                        "pressure": None if pressure is None else (pressure / pressure.max()).tolist(),
                    }
                )
    return found


def _mm(track: Any, kept: list[int]) -> list[list[float]]:
    return [[1e3 * track.x_m[k] for k in kept], [1e3 * track.y_m[k] for k in kept]]


def _measure(one: Run) -> list[Panel]:
    found = one.shared("letters", lambda: _measure_all(one))
    panels = []
    for letter in dict.fromkeys(entry["letter"] for entry in found):
        curves: list[Curve] = []
        for entry in found:
            if entry["letter"] != letter:
                continue
            told = f"{entry['error_mm']:.2f} mm rms" if entry["finished"] else "ball lost"
            if entry["pressure"] is not None:
                # A logarithm shows where the ball was, not where it stood longest.
                shown = np.maximum(entry["pressure"], _LEAST)
                title = f"{letter}, {entry['method']}: {told}"
                panels.append(
                    skin_panel(title, shown, unit="share of the largest", lowest=_LEAST, highest=1.0, logarithmic=True)
                )
            (x, y), (reference_x, reference_y) = entry["path_mm"]
            by, scheme, _ = _METHODS[entry["method"]]
            curves.append(Curve(entry["method"], x, y, by, scheme))
            if entry["finished"] and by == OURS:
                curves.append(Curve("reference", reference_x, reference_y, TRUTH, "truth"))
        panels.append(Panel(f"{letter}, the ball's path", "x [mm]", "y [mm]", curves, equal=True))
    return panels


FIGURES = (
    Figure(
        "10B-D",
        "letters traced by a ball on a tilting plate",
        _measure,
        notes=(
            "Cumulative pressure and true path; simulated ball, plate and robot; our controller in both.",
            "The paper shows its maps as photographs without numbers.",
        ),
    ),
)
