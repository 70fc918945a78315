# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 5B, 5C and 5D: tennis balls that bounce on the skin, over the taxels measured."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from acts_core.array import COUNT_MAX
from acts_tools.evaluate.impacts import plays
from acts_tools.evaluate.impacts.impacts_command import TOUCH_MS, drops_of, seen_by_paper, seen_by_us
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, TRUTH, Curve, Panel

_M = (42, 64, 88, 128, 256, 512, 1024)
_M_FAST = (64, 512)
_M_OVER_TIME = (64, 128, 256, 512)
_DROPS, _DROPS_FAST = 100, 2
_NOISE_COUNTS = 3.0
_BEFORE_MS, _AFTER_MS = -15.0, 25.0
"""What is shown of a drop, from its first touch on."""

_OURS = ("adaptive", "tracking")
_PAPER = "adaptive, the paper's method"
_M_LABEL = "taxels measured per frame, M"


def _measure_all(run: Run) -> dict[str, Any]:
    ms = run.pick(_M, _M_FAST)
    scenes = drops_of(run.pick(_DROPS, _DROPS_FAST), run.seed, TOUCH_MS)
    kept = ("m", "frames", "frames_sd", "seen", "told", "drops", "force_change")
    entries: list[dict[str, Any]] = []
    with run.progress("bounces", len(ms) * (1 + len(_OURS))) as progress:
        for m in ms:
            found = {_PAPER: seen_by_paper(scenes, m, _NOISE_COUNTS)}
            progress.show(len(entries) + 1)
            for scheme in _OURS:
                found[f"{scheme}, ours"] = seen_by_us(scenes, scheme, m, _NOISE_COUNTS)
            entries += [{"curve": label, **{name: one[name] for name in kept}} for label, one in found.items()]
            progress.show(len(entries))
    return {"touch_ms": TOUCH_MS, "entries": entries}


def _over_m(run: Run, number: str, y_label: str) -> list[Panel]:
    found = run.shared("bounces", lambda: _measure_all(run))
    curves = []
    for label in (_PAPER, *(f"{scheme}, ours" for scheme in _OURS)):
        own = [one for one in found["entries"] if one["curve"] == label and one[number] is not None]
        by = SAME if label == _PAPER else OURS
        x, y = [float(one["m"]) for one in own], [float(one[number]) for one in own]
        curves.append(Curve(label, x, y, by, label.partition(",")[0]))
    return [Panel(y_label, _M_LABEL, y_label, curves, log_x=True, y_min=0.0)]


def _measure_frames(run: Run) -> list[Panel]:
    return _over_m(run, "frames", "frames that see the ball")


def _measure_changes(run: Run) -> list[Panel]:
    return _over_m(run, "force_change", "mean change of force / largest")


def _published(file: str, scale: float) -> Callable[[PublishedData, Sequence[Panel]], dict[str, list[Curve]]]:
    def published(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
        curve = data.curve(file, "", named="published", beside=_PAPER, scheme="truth", scale=scale)
        return {panels[0].title: [curve]}

    return published


def _measure_over_time(run: Run) -> list[Panel]:
    """The first of the drops: the largest reading of each frame of the paper's method, ours as a force."""
    shown = drops_of(1, run.seed, TOUCH_MS)[0]
    truth = shown.collisions[0]
    begin_s, largest_n = float(truth.time_s[0]), float(truth.force_n.max())
    every = max(len(truth.time_s) // 100, 1)
    true_ms = (1e3 * (truth.time_s - begin_s))[::every].tolist()
    true = Curve("truth, force", true_ms, (truth.force_n / largest_n)[::every].tolist(), TRUTH, "truth")
    panels = []
    for m in run.pick(_M_OVER_TIME, _M_FAST):
        readings = [
            (1e3 * (frame.end_s - begin_s), float(frame.counts.max()) / COUNT_MAX)
            for frame in plays.frames_of_paper(shown, m, _NOISE_COUNTS, 1)
        ]
        near = [(ms, reading) for ms, reading in readings if _BEFORE_MS < ms < _AFTER_MS]
        curves = [
            true,
            Curve(
                "largest reading, paper's method",
                [ms for ms, _ in near],
                [reading for _, reading in near],
                SAME,
                "adaptive",
            ),
        ]
        over = plays.strongest_over(plays.Ours("adaptive", m, _NOISE_COUNTS).play(shown, 1))
        if over is not None:
            x = (1e3 * (over.time_s - begin_s)).tolist()
            curves.append(Curve("ours, force", x, (over.force_n / largest_n).tolist(), OURS, "tracking"))
        panels.append(Panel(f"M = {m}", "time since first touch [ms]", "share of the largest", curves))
    return panels


def _published_over_time(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    """The first bounce of each published recording, moved to time 0."""
    found = {}
    for panel in panels:
        m = panel.title.rpartition(" ")[2]
        points = data.points(f"fig6/time-force_{m}.fig", f"Measurement Level: {m}|Win: 2")
        first = int(np.flatnonzero(points[:, 1] > 0)[0])
        # The touch began somewhere in the frame before the first that saw it: half a frame earlier.
        period_s = float(np.median(np.diff(points[:, 0])))
        x = 1e3 * (points[:, 0] - points[first, 0] + period_s / 2)
        near = (x > _BEFORE_MS) & (x < _AFTER_MS)
        y = points[near, 1] / COUNT_MAX
        curve = Curve("largest reading, published", x[near].tolist(), y.tolist(), PUBLISHED, "truth")
        found[panel.title] = [curve]
    return found


_HOW = "Drops from 0.75 m, 8.7 ms of touch, as in docs/impacts.md; the paper's counts are means of five, it seems."

FIGURES = (
    Figure(
        "5B", "frames that see a bounce", _measure_frames, _published("fig6/M_nFrame_nonzero.fig", 1.0), notes=(_HOW,)
    ),
    Figure(
        "5C",
        "change of force from frame to frame during a bounce",
        _measure_changes,
        _published("fig6/M_force_diff.fig", 1 / COUNT_MAX),
        notes=(_HOW, "The published change in counts, as a share of 1023: its tennis balls read 1000 to 1022 at most."),
    ),
    Figure("5D", "force over time during a bounce", _measure_over_time, _published_over_time, columns=2),
)
