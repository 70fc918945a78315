# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 5F and 5G: the way of a ball over the skin, and the direction that it came from."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from acts_core.array import COUNT_MAX
from acts_core.words import counted
from acts_sim.impacts import Scene
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS, paper_method
from acts_tools.evaluate.impacts import plays
from acts_tools.evaluate.impacts.ricochet_command import (
    ANGLES_DEG,
    SCHEME,
    SPEEDS_M_S,
    PaperDirections,
    error_deg,
    numbered_throw,
    scores_of,
    throw_of,
    told_by_us,
)
from acts_tools.figures.figure import Figure
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, SAME, TRUTH, Curve, Panel
from acts_tools.figures.skin_images import skin_panel

_M = 64
_NOISE_COUNTS = 3.0
_THROWS, _THROWS_FAST = 25, 1
_SPEEDS_FAST_M_S = (2.0,)
_SHOWN_DEG, _SHOWN_M_S = 45, 2.0
_FRAMES = 4


def _mm(values: Any) -> list[float]:
    return (1e3 * np.asarray(values, dtype=float)).tolist()


def _throw(run: Run, angle_deg: int) -> Scene:
    return throw_of(_SHOWN_M_S, angle_deg, np.random.default_rng([run.seed, angle_deg % 360]))


def _measure_paths(run: Run) -> list[Panel]:
    """Frames of one throw by the paper's method, and the way of the centre from eight angles."""
    shown = _throw(run, _SHOWN_DEG)
    begin_s = float(shown.collisions[0].time_s[0])
    recovery = paper_method()
    panels: list[Panel] = []
    for frame in plays.frames_of_paper(shown, _M, _NOISE_COUNTS, 1):
        image = recovery.step(frame.indices, frame.counts, frame.end_s, frame.duration_s)
        if image.max() > PAPER_TOUCH_COUNTS and len(panels) < _FRAMES:
            title = f"{_SHOWN_DEG} degrees, paper's method, {1e3 * (frame.end_s - begin_s):.1f} ms"
            panels.append(skin_panel(title, image, highest=float(COUNT_MAX)))
    return [*panels, *(_path(_throw(run, angle_deg), angle_deg) for angle_deg in sorted(ANGLES_DEG))]


def _path(shown: Scene, angle_deg: int) -> Panel:
    truth = shown.collisions[0]
    path = PaperDirections(_M, _NOISE_COUNTS).path_m(shown, 1)
    over = plays.strongest_over(plays.Ours(SCHEME, _M, _NOISE_COUNTS).play(shown, 1))
    every = max(len(truth.x_m) // 50, 1)
    curves = [
        Curve("truth", _mm(truth.x_m[::every]), _mm(truth.y_m[::every]), TRUTH, "truth"),
        Curve("paper's method", _mm([x for x, _ in path]), _mm([y for _, y in path]), SAME, "adaptive"),
    ]
    if over is not None:
        curves.append(Curve("ours", _mm(over.path_x_m), _mm(over.path_y_m), OURS, "tracking"))
    return Panel(f"centre of pressure, {angle_deg} degrees", "x [mm]", "y [mm]", curves, equal=True)


def _measure_directions(run: Run) -> dict[str, Any]:
    throws, speeds = run.pick(_THROWS, _THROWS_FAST), run.pick(SPEEDS_M_S, _SPEEDS_FAST_M_S)
    paper, ours = PaperDirections(_M, _NOISE_COUNTS), plays.Ours(SCHEME, _M, _NOISE_COUNTS)
    of_angles = []
    everything: tuple[list[float | None], list[tuple[float, float] | None]] = ([], [])
    with run.progress("throws", len(ANGLES_DEG) * len(speeds) * throws) as progress:
        for angle_deg in ANGLES_DEG:
            of_paper: list[float | None] = []
            of_ours: list[tuple[float, float] | None] = []
            for speed_m_s in speeds:
                for number in range(throws):
                    shown = numbered_throw(speed_m_s, angle_deg, run.seed, number)
                    of_paper.append(error_deg(paper.direction_rad(shown, number + 1), angle_deg))
                    of_ours.append(told_by_us(ours, shown, number + 1, angle_deg))
                    everything[0].append(of_paper[-1])
                    everything[1].append(of_ours[-1])
                    progress.show(len(everything[0]))
            of_angles.append({"angle_deg": angle_deg, "paper": of_paper, "ours": of_ours})
    return {"angles": of_angles, "whole": scores_of(*everything)}


def _measure_errors(run: Run) -> list[Panel]:
    found = run.shared("ricochets", lambda: _measure_directions(run))
    whole = found["whole"]
    points, means, shares = [], [], []
    for name, label, by, scheme in (
        ("paper", "paper's method", SAME, "adaptive"),
        ("ours", "ours", OURS, "tracking"),
    ):
        x, y, mean_x, mean_y = [], [], [], []
        for one in sorted(found["angles"], key=lambda entry: entry["angle_deg"]):
            errors = [error if isinstance(error, float) else error[0] for error in one[name] if error is not None]
            x += [float(one["angle_deg"])] * len(errors)
            y += errors
            if errors:
                mean_x.append(float(one["angle_deg"]))
                mean_y.append(math.fsum(errors) / len(errors))
        points.append(Curve(label, x, y, by, scheme, points=True))
        means.append(Curve(label, mean_x, mean_y, by, scheme))
        # A throw of which no direction is told never comes within any error.
        up_to = [0.5 * step for step in range(61)]
        below = [sum(error <= limit for error in y) / whole["throws"] for limit in up_to]
        shares.append(Curve(label, up_to, below, by, scheme))
    return [
        Panel("every throw", "true direction [deg]", "error [deg]", points, y_min=0.0),
        Panel("mean by direction", "true direction [deg]", "mean error [deg]", means, y_min=0.0),
        Panel("throws within an error", "error [deg]", "share of all throws", shares, y_min=0.0, y_max=1.02),
    ]


def _how_many(run: Run) -> str:
    throws, speeds = run.pick(_THROWS, _THROWS_FAST), run.pick(SPEEDS_M_S, _SPEEDS_FAST_M_S)
    at = ", ".join(f"{speed:g}" for speed in speeds)
    return f"{counted(throws, 'throw')} of each angle and speed ({at} m/s), M = {_M}."


FIGURES = (
    Figure(
        "5F",
        "frames of a ricochet, and the way of the centre from eight angles",
        _measure_paths,
        columns=4,
        panel_inch=(2.8, 2.7),
        notes=(
            f"Rubber balls at {_SHOWN_M_S:g} m/s, M = {_M}; directions of flight; no published numbers.",
            "Without a line of the paper's method, none of its frames saw the ball (5G counts such throws, too).",
        ),
    ),
    Figure(
        "5G",
        "direction of ricochets from eight angles",
        _measure_errors,
        how=_how_many,
        notes=(
            "Throws of which no direction is told are within no error.",
            "The paper shows its directions as lines in photographs, without numbers.",
        ),
    ),
)
