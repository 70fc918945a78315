# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 6A to 6C: outlines of three soft bodies over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_tools.evaluate.outlines import tracing
from acts_tools.evaluate.outlines.outlines_command import scores_of, touch_of
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, TRUTH, Curve, Panel

_BODIES = {"tennis": "6A", "block": "6B", "balloon": "6C"}
_PUBLISHED_NAMES = {"tennis": "tennis", "block": "tape", "balloon": "balloon"}
_M = (64, 88, 128, 256, 352, 512)
_M_FAST = (88,)
_M_DRAWN = 88
_TOUCHES, _TOUCHES_FAST = 10, 1
_NOISE_COUNTS = 3.0
_OUTLINES_MAX = 8
"""Of a touch that has more, every so many are drawn."""

_FRAMES, _ERROR = "frames with an outline", "error from the third frame on"


def _measure_body(run: Run, body: str) -> Any:
    ms = run.pick(_M, _M_FAST)
    touches = [touch_of(body, run.seed, number) for number in range(run.pick(_TOUCHES, _TOUCHES_FAST))]
    found: list[dict[str, Any]] = []
    drawn: dict[str, list[tuple[float, list[float], list[float]]]] = {}
    with run.progress(f"outlines, {body}", len(ms)) as progress:
        for number, m in enumerate(ms, start=1):
            numbered = list(enumerate(touches, start=1))
            told = {
                "paper": [tracing.paper(shown, m, _NOISE_COUNTS, seed) for seed, shown in numbered],
                "ours": [tracing.ours(shown, m, _NOISE_COUNTS, seed) for seed, shown in numbered],
            }
            for who, traced in told.items():
                scores = scores_of(traced, m)
                frames, error = scores["frames_with_outline"], scores["error_taxels_from_third"]["mean"]
                found.append({"m": m, "who": who, "frames": frames, "error": error})
                if m == _M_DRAWN:
                    drawn[who] = [_closed(one.time_s, one.outline_m) for one in traced[0] if len(one.outline_m)]
                    drawn["truth"] = [_closed(one.time_s, one.truth_m) for one in traced[0]]
            progress.show(number)
    return {"scores": found, "drawn": drawn}


def _closed(time_s: float, corners_m: NDArray[np.float64]) -> tuple[float, list[float], list[float]]:
    """Time [ms], and the corners [mm], the first one again at the end."""
    x, y = 1e3 * np.vstack((corners_m, corners_m[:1])).T
    return 1e3 * time_s, x.tolist(), y.tolist()


def _measure(body: str) -> Callable[[Run], list[Panel]]:
    def measure(run: Run) -> list[Panel]:
        found = run.shared(f"outlines_{body}", lambda: _measure_body(run, body))
        panels = []
        for who, title in (("paper", "paper's method"), ("ours", "ours"), ("truth", "truth")):
            outlines = found["drawn"][who]
            chosen = outlines[:: -(-len(outlines) // _OUTLINES_MAX) or 1]
            begin_ms = found["drawn"]["truth"][0][0]
            by = {"paper": SAME, "ours": OURS, "truth": TRUTH}[who]
            curves = [Curve(f"{ms - begin_ms:.1f} ms", x, y, by, f"C{k}") for k, (ms, x, y) in enumerate(chosen)]
            panels.append(Panel(f"outlines, M = {_M_DRAWN}, {title}", "x [mm]", "y [mm]", curves, equal=True))
        for number, title, y_label in (("frames", _FRAMES, "frames"), ("error", _ERROR, "mean distance [taxels]")):
            curves = []
            for who, label, by, scheme in (
                ("paper", "paper's method", SAME, "adaptive"),
                ("ours", "ours, tracking", OURS, "tracking"),
            ):
                own = [one for one in found["scores"] if one["who"] == who and one[number] is not None]
                if own:
                    x, y = [float(one["m"]) for one in own], [float(one[number]) for one in own]
                    curves.append(Curve(label, x, y, by, scheme))
            if curves:
                m_label = "taxels measured per frame, M"
                panels.append(Panel(title, m_label, y_label, curves, log_x=True, y_min=0.0))
        return panels

    return measure


def _published(body: str) -> Callable[[PublishedData, Sequence[Panel]], dict[str, list[Curve]]]:
    def published(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
        """Frames of the one published touch: its rows are M, x, y and time [s]."""
        rows = data.array("outlines_fig7.npz", _PUBLISHED_NAMES[body])
        ms = sorted({float(m) for m in rows[:, 0]})
        frames = [float(len(np.unique(rows[rows[:, 0] == m, 3]))) for m in ms]
        curve = Curve("published, one touch", ms, frames, PUBLISHED, "truth", beside="paper's method")
        return {_FRAMES: [curve]}

    return published


FIGURES = tuple(
    Figure(
        name,
        f"outlines over time: {body}",
        _measure(body),
        _published(body),
        notes=("The published outlines are polygons on whole taxels without a true edge: only their frames compare.",),
    )
    for body, name in _BODIES.items()
)
