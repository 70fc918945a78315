# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a walk is like: cadence, phases, double support, left against right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median

import numpy as np

from acts_recon.gait.step import Step

# Strides that are longer than this many of the median are pauses.
_PAUSE = 2.0


@dataclass(frozen=True)
class FootGait:
    """Medians over the steps of one foot, but for the cadence; None where no step says it.

    Attributes
    ----------
    steps : int
    cadence_per_min : float or None
        Steps of both feet a minute, from the mean of this foot's strides that are no pause.
    stride_s, stance_s, swing_s : float or None
        From strike to strike; the foot carries; it is lifted [s].
    peak_force : float or None
        In the unit that was given.
    progress_m, path_m : float or None
        See `Step`.
    """

    steps: int
    cadence_per_min: float | None
    stride_s: float | None
    stance_s: float | None
    swing_s: float | None
    peak_force: float | None
    progress_m: float | None
    path_m: float | None


@dataclass(frozen=True)
class Gait:
    """What a walk is like.

    Attributes
    ----------
    feet : tuple of FootGait
        Left and right.
    cadence_per_min : float or None
        Steps of both feet a minute: twice the strides of either, so one foot is enough.
    double_support : float or None
        Share of the strides in which both feet carry; None without steps of both feet.
    """

    feet: tuple[FootGait, FootGait]
    cadence_per_min: float | None
    double_support: float | None

    def asymmetry(self, of: str) -> float | None:
        """Left minus right over their mean, of `stance_s` or another of `FootGait`.

        None where one of them is not known, or not above 0.
        """
        left, right = (getattr(foot, of) for foot in self.feet)
        if left is None or right is None or min(left, right) <= 0:
            return None
        return float(2 * (left - right) / (left + right))


def summarise(left: Sequence[Step], right: Sequence[Step], longest_stride_s: float) -> Gait:
    """Summarise steps, each foot's in the order of time; longer from strike to strike is a pause [s]."""
    strides = [_strides(steps, longest_stride_s) for steps in (left, right)]
    return Gait(
        (_foot(left, strides[0], longest_stride_s), _foot(right, strides[1], longest_stride_s)),
        _cadence_per_min([*strides[0], *strides[1]]),
        _double_support(left, right, strides),
    )


def _strides(steps: Sequence[Step], longest_s: float) -> list[tuple[float, float]]:
    # Without a known swing it is not known what was between the two.
    return [
        (a.strike_s, b.strike_s)
        for a, b in pairwise(steps)
        if b.swing_s is not None and b.strike_s - a.strike_s <= longest_s
    ]


def _cadence_per_min(strides: Sequence[tuple[float, float]]) -> float | None:
    if not strides:
        return None
    strides_s = [end - begin for begin, end in strides]
    longest_s = _PAUSE * median(strides_s)
    walked = [stride_s for stride_s in strides_s if stride_s <= longest_s]
    return 120.0 * len(walked) / sum(walked)


def _foot(steps: Sequence[Step], strides: Sequence[tuple[float, float]], longest_s: float) -> FootGait:
    swings_s = [step.swing_s for step in steps if step.swing_s is not None and step.swing_s <= longest_s]
    return FootGait(
        len(steps),
        _cadence_per_min(strides),
        median(end - begin for begin, end in strides) if strides else None,
        median(step.stance_s for step in steps) if steps else None,
        median(swings_s) if swings_s else None,
        median(step.peak_force for step in steps) if steps else None,
        median(step.progress_m for step in steps) if steps else None,
        median(step.path_m for step in steps) if steps else None,
    )


def _double_support(
    left: Sequence[Step], right: Sequence[Step], strides: Sequence[Sequence[tuple[float, float]]]
) -> float | None:
    """Of the strides in which the other foot was set down, too."""
    together_s = whole_s = 0.0
    shared = np.array(_shared(left, right)).reshape(-1, 2)
    for other, of_foot in ((right, strides[0]), (left, strides[1])):
        strikes_s = np.array([step.strike_s for step in other])
        for begin, end in of_foot:
            if ((begin <= strikes_s) & (strikes_s < end)).any():
                whole_s += end - begin
                inside = np.minimum(shared[:, 1], end) - np.maximum(shared[:, 0], begin)
                together_s += float(np.maximum(inside, 0.0).sum())
    return together_s / whole_s if whole_s else None


def _shared(left: Sequence[Step], right: Sequence[Step]) -> list[tuple[float, float]]:
    """When both feet carried, from and to [s]."""
    found, first = [], 0
    for a in left:
        while first < len(right) and right[first].toe_off_s <= a.strike_s:
            first += 1
        for b in right[first:]:
            if b.strike_s >= a.toe_off_s:
                break
            found.append((max(a.strike_s, b.strike_s), min(a.toe_off_s, b.toe_off_s)))
    return found
