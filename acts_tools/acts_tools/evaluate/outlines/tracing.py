# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines of a soft object as ours, and by the paper's method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_recon.fusion import known_noise
from acts_recon.outlines import Outline, area, contours, mean_distance_m
from acts_recon.settings import ReconstructionSettings
from acts_sim.deforming import SoftContact
from acts_sim.impacts import SCENE_RATE_HZ
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS, paper_method
from acts_tools.evaluate.scene_frames import FOLLOW_COUNTS, frames_of

Array = NDArray[np.float64]

SCHEME = "tracking"
PAPER_SCHEMES = {"tennis": "adaptive", "block": "adaptive", "balloon": "random"}
"""As in the paper's figure 6."""

_CORNERS = 72


@dataclass(frozen=True)
class Traced:
    """The outline of one frame beside the truth.

    Attributes
    ----------
    time_s : float
        Middle of the frame's measurements, on the scene's clock [s].
    outline_m : np.ndarray [shape=(n, 2), dtype=float64]
        Corners [m]; empty where none was found.
    truth_m : np.ndarray [shape=(n, 2), dtype=float64]
        Likewise, of the true outline at that time; empty where nothing touches.
    """

    time_s: float
    outline_m: Array
    truth_m: Array

    def error_taxels(self, pitch_m: float) -> float | None:
        """Mean distance of the two in taxels; None where one of them is missing."""
        if not (len(self.outline_m) and len(self.truth_m)):
            return None
        return mean_distance_m(self.outline_m, self.truth_m) / pitch_m


def our_outlines(shown: SoftContact, m: int, noise_counts: float, seed: int, scheme: str = SCHEME) -> list[Outline]:
    """All that `OutlineTracer` tells of a scene."""
    settings = ReconstructionSettings(touch_counts=PAPER_TOUCH_COUNTS, noise_counts=known_noise(noise_counts))
    recovery = settings.recovery()
    tracer = settings.outline_tracer(recovery)
    found: list[Outline] = []
    for frame in frames_of(shown.frames, SCENE_RATE_HZ, scheme, m, FOLLOW_COUNTS, noise_counts, seed):
        recovery.step(frame.indices, frame.counts, frame.end_s, frame.duration_s)
        found += tracer.step(frame.indices, frame.counts, frame.end_s, frame.duration_s, recovery.image)
    return found


def ours(shown: SoftContact, m: int, noise_counts: float, seed: int, scheme: str = SCHEME) -> list[Traced]:
    """Of each frame in which the body touches, the largest outline that is told."""
    largest: dict[float, Outline] = {}
    for outline in our_outlines(shown, m, noise_counts, seed, scheme):
        if outline.time_s not in largest or outline.area_m2 > largest[outline.time_s].area_m2:
            largest[outline.time_s] = outline
    traced = []
    for frame in frames_of(shown.frames, SCENE_RATE_HZ, scheme, m, FOLLOW_COUNTS, noise_counts, seed):
        time_s = frame.end_s - frame.duration_s / 2
        truth_m = shown.outline_m(time_s)
        if len(truth_m):
            one = largest.get(time_s)
            corners = np.zeros((0, 2)) if one is None else np.column_stack((one.x_m, one.y_m))
            traced.append(Traced(time_s, corners, truth_m))
    return traced


def paper(shown: SoftContact, m: int, noise_counts: float, seed: int) -> list[Traced]:
    """The paper's: each frame recovered by itself, and the boundary of its pressed taxels, through their middles.

    Of the balloon it is a circle as large as the pressed area.
    """
    geometry = ArrayGeometry()
    recovery = paper_method()
    scheme = PAPER_SCHEMES[shown.body.name]
    traced = []
    for frame in frames_of(shown.frames, SCENE_RATE_HZ, scheme, m, PAPER_TOUCH_COUNTS, noise_counts, seed):
        time_s = frame.end_s - frame.duration_s / 2
        truth_m = shown.outline_m(time_s)
        if not len(truth_m):
            continue
        image = recovery.step(frame.indices, frame.counts, frame.end_s, frame.duration_s)
        pressed = image > PAPER_TOUCH_COUNTS
        corners = _circle(pressed) if shown.body.name == "balloon" else _boundary(pressed)
        placed = np.column_stack((geometry.x_m(corners[:, 1]), geometry.y_m(corners[:, 0])))
        traced.append(Traced(time_s, placed, truth_m))
    return traced


def _boundary(pressed: NDArray[np.bool_]) -> Array:
    # Just below 1: through the middles of the outermost taxels.
    loops = contours(pressed.astype(float), 0.999)
    return max(loops, key=area, default=np.zeros((0, 2)))


def _circle(pressed: NDArray[np.bool_]) -> Array:
    rows, cols = np.nonzero(pressed)
    if not rows.size:
        return np.zeros((0, 2))
    radius, angle = np.sqrt(rows.size / np.pi), 2 * np.pi * np.arange(_CORNERS) / _CORNERS
    return np.column_stack((rows.mean() + radius * np.sin(angle), cols.mean() + radius * np.cos(angle)))


def frames_seen(traced: Sequence[Traced]) -> int:
    """Frames that have an outline."""
    return sum(len(one.outline_m) > 0 for one in traced)
