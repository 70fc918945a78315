# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 8B to 8G: what happens to worn skins, over time, and as images at the onset and at the peak."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse
from acts_sim.wearables import SCENES, WORN_RATE_HZ, WornScene
from acts_tools.evaluate.scene_frames import DETECTOR_TOUCH_COUNTS, frames_of
from acts_tools.evaluate.wearables.watching import SCHEME, THRESHOLD_COUNTS, Watcher
from acts_tools.evaluate.wearables.wearables_command import scene_of, tally
from acts_tools.figures.figure import Figure
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, TRUTH, Curve, Panel
from acts_tools.figures.skin_images import skin_panel

_M = 64
_NOISE_COUNTS = 3.0
_SCENES = 5
_TRUTH_STEP_S = 0.0005
_ONSET_COLOUR = "C0"
_ONSET_FRAMES = 3
"""Images at the onset are those of the third frame that shows the touch."""


def _measure(run: Run) -> list[Panel]:
    names = run.pick(tuple(SCENES), ("arm_tap", "helmet_hit"))
    panels: list[Panel] = []
    places: list[float] = []
    errors_ms: list[float] = []
    figures: list[str] = []
    for place, name in enumerate(names, start=1):
        panels += _panels(scene_of(name, run.seed, 0))
        scenes = run.pick(_SCENES, 1)
        with run.progress(name, scenes) as progress:
            found = tally(name, scenes, _M, _NOISE_COUNTS, run.seed, progress)
        places += [float(place)] * len(found.onset_ms)
        errors_ms += found.onset_ms
        figures.append(SCENES[name].figure)
    curves = [
        Curve("onset", places, errors_ms, OURS, _ONSET_COLOUR, points=True),
        *(Curve("", [0.5, len(names) + 0.5], [at_ms] * 2, TRUTH, "truth") for at_ms in (-2.0, 2.0)),
    ]
    return [*panels, Panel("errors of onsets", "scene", "told less true [ms]", curves, x_names=figures)]


def _title(shown: WornScene) -> str:
    return f"{shown.kind.figure} {shown.kind.name.replace('_', ' ')}"


def _panels(shown: WornScene) -> list[Panel]:
    """Force over time with the onsets, and two images."""
    watcher = Watcher(shown.layout, _NOISE_COUNTS)
    watcher.set_baseline(shown.baseline)
    geometry, response = shown.layout.geometry(), ForceResponse()
    times: list[float] = []
    forces: list[float] = []
    onsets: list[float] = []
    first: NDArray[np.float32] | None = None
    peak = np.zeros((geometry.rows, geometry.cols), dtype=np.float32)
    seen = 0
    for frame in frames_of(
        shown.frames, WORN_RATE_HZ, SCHEME, _M, THRESHOLD_COUNTS, _NOISE_COUNTS, 1, watcher.skin_map
    ):
        onsets += [1e3 * one.onset_s for one in watcher.step(frame) if one.is_over]
        image = watcher.recovery.image
        force_n = float(response.force_n(np.where(image > DETECTOR_TOUCH_COUNTS, image, 0.0)).sum())
        if force_n > max(forces, default=0.0):
            peak = image.copy()
        times.append(1e3 * frame.end_s)
        forces.append(force_n)
        seen += force_n > 0
        if first is None and seen == _ONSET_FRAMES:
            first = image.copy()
    true_s = np.arange(0.0, shown.duration_s, _TRUTH_STEP_S)
    marks = [
        Curve("onset" if not number else "", [at_ms] * 2, [0.0, max(forces)], OURS, _ONSET_COLOUR)
        for number, at_ms in enumerate(onsets)
    ]
    curves = [
        Curve("truth", (1e3 * true_s).tolist(), [shown.force_n(at_s) for at_s in true_s.tolist()], TRUTH, "truth"),
        Curve("ours", times, forces, OURS, "tracking"),
    ]
    title = _title(shown)
    # Without the rest before and after, so that short hits are seen.
    touched_ms = [at_ms for curve in curves for at_ms, force_n in zip(curve.x, curve.y, strict=True) if force_n > 0]
    first_ms, last_ms = min(touched_ms), max(touched_ms)
    around_ms = 0.1 * (last_ms - first_ms) + 1.0
    return [
        Panel(
            title,
            "time [ms]",
            "force [N]",
            [*curves, *marks],
            y_min=0.0,
            x_min=first_ms - around_ms,
            x_max=last_ms + around_ms,
        ),
        _image(f"{title}: onset", peak if first is None else first, geometry),
        _image(f"{title}: peak", peak, geometry),
    ]


def _image(title: str, image: NDArray[np.float32], geometry: ArrayGeometry) -> Panel:
    return skin_panel(title, image, geometry, highest=max(float(image.max()), 1.0))


FIGURES = (
    Figure(
        "8B-G",
        "events on worn skins, and their onsets",
        _measure,
        notes=(
            "M = 64. Simulated scenes: motions, shapes and stiffnesses are ours. Published are pictures only.",
            "Vertical lines: onsets as told when the touch is over; the fingers of a catch are touches of their own.",
        ),
    ),
)
