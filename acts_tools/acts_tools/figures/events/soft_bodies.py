# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 6A to 6C: outlines of three soft bodies over time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
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

_ROOM = 1.05

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
        begin_ms = found["drawn"]["truth"][0][0]
        x_min, x_max, y_min, y_max = _square_around(found["drawn"].values())
        for solid in (False, True):
            for who, title, by in (
                ("paper", "paper's method", SAME),
                ("ours", "ours", OURS),
                ("truth", "truth", TRUTH),
            ):
                panel = _outlines(found["drawn"][who], begin_ms, title, by, solid=solid)
                panels.append(replace(panel, x_min=x_min, x_max=x_max, y_min=y_min, y_max=y_max))
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


def _square_around(traced: Iterable[Sequence[tuple[float, list[float], list[float]]]]) -> tuple[float, ...]:
    """Limits of x, and of y, with room for all of these outlines, so that they can be compared [mm]."""
    xs, ys = zip(*((x, y) for outlines in traced for _, x, y in outlines), strict=True)
    low, high = np.array([(min(map(min, numbers)), max(map(max, numbers))) for numbers in (xs, ys)]).T
    middle, half = (low + high) / 2, _ROOM * max(high - low) / 2
    return tuple(np.stack((middle - half, middle + half), axis=1).ravel().tolist())


def _outlines(
    outlines: Sequence[tuple[float, list[float], list[float]]], begin_ms: float, title: str, by: str, *, solid: bool
) -> Panel:
    """Some of the outlines of a touch in the plane, or all of them above one another, time upwards."""
    chosen = outlines if solid else outlines[:: -(-len(outlines) // _OUTLINES_MAX) or 1]
    curves = [Curve(f"{ms - begin_ms:.1f} ms", x, y, by, at=ms - begin_ms) for ms, x, y in chosen]
    return Panel(
        f"{'surface' if solid else 'outlines'}, M = {_M_DRAWN}, {title}",
        "x [mm]",
        "y [mm]",
        curves,
        by=by if by == PUBLISHED else "",
        equal=True,
        at_label="time [ms]",
        solid=solid,
    )


def _published_outlines(body: str) -> Callable[[PublishedData, Sequence[Panel]], list[Panel]]:
    def published(data: PublishedData, panels: Sequence[Panel]) -> list[Panel]:
        """Before ours, those of the published touch, about their common middle, as their place is not told."""
        rows = data.array("outlines_fig7.npz", _PUBLISHED_NAMES[body])
        rows = rows[rows[:, 0] == _M_DRAWN]
        # Each frame repeats its corners several times, in order.
        frames = [
            (time_s, list(dict.fromkeys(map(tuple, rows[rows[:, 3] == time_s, 1:3].tolist()))))
            for time_s in np.unique(rows[:, 3]).tolist()
        ]
        middle = np.mean([corner for _, corners in frames for corner in corners], axis=0)
        pitch_m = ArrayGeometry().pitch_m
        outlines = [_closed(time_s, pitch_m * (np.array(corners) - middle)) for time_s, corners in frames]
        flat, solid = (_outlines(outlines, outlines[0][0], "published", PUBLISHED, solid=way) for way in (False, True))
        first = next(number for number, panel in enumerate(panels) if panel.solid)
        return [flat, *panels[:first], solid, *panels[first:]]

    return published


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
        _published_outlines(body),
        columns=4,
        panel_inch=(2.8, 2.6),
        notes=(
            "The published outlines are polygons on whole taxels without a true edge, of one touch; its place is not "
            "told.",
            f"In the plane at most {_OUTLINES_MAX} outlines of a touch are drawn, in the surfaces all.",
        ),
    )
    for body, name in _BODIES.items()
)
