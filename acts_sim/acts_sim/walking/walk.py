# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Feet that roll from heel to toe on two insoles."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import SettingsError
from acts_core.settings import setting, validate

Array = NDArray[np.float64]

_AT_ONCE = 2000
# Share of the weight on the foot over the course of a stance, in the usual form with two humps.
_COURSE = np.array([0.0, 0.08, 0.20, 0.50, 0.78, 0.92, 1.0])
_STEP = np.array([0.0, 0.60, 1.05, 0.80, 1.10, 0.60, 0.0])
# Standing on both feet, before the first swing and after the last.
_FROM_STANDING = np.array([0.5, 0.5, 0.5, 0.5, 1.10, 0.60, 0.0])
_TO_STANDING = np.array([0.0, 0.60, 1.05, 0.5, 0.5, 0.5, 0.5])
# Centre of pressure over the same course, from the heel on, as a share of the length of the foot.
_ALONG = np.array([0.12, 0.18, 0.30, 0.55, 0.75, 0.84, 0.90])
# Standard deviations of the pressure along and across, as shares of length and width.
_SPREAD_ALONG, _SPREAD_ACROSS = 0.10, 0.22
_SWAY, _SWAY_HZ = 0.04, 0.4
# How much the right foot's strikes vary about half a stride, as a share of how much strides do.
_JITTER = 0.125


@dataclass(frozen=True)
class Walk:
    """How somebody walks."""

    cadence_per_min: float = setting(
        110.0, "steps of both feet a minute; 0: stands all the time", minimum=0.0, maximum=400.0
    )
    stance_share: float = setting(
        0.62, "of a stride in which a foot carries; below 0.5 both are in the air at times", minimum=0.2, maximum=0.9
    )
    limp: float = setting(
        0.0, "stances of the left foot are longer, those of the right shorter, by this share", minimum=-0.3, maximum=0.3
    )
    variation: float = setting(0.03, "standard deviation of the time of a stride, as a share", minimum=0.0, maximum=0.2)
    weight_n: float = setting(700.0, "of the body [N]", minimum=1.0, maximum=5000.0)
    standing_s: float = setting(2.0, "standing before the first step and after the last [s]", minimum=0.0, maximum=600)
    rows: int = setting(33, "of an insole, from the toes to the heel", minimum=2, maximum=256)
    cols: int = setting(15, "of an insole", minimum=2, maximum=256)
    length_m: float = setting(0.28, "of an insole [m]", minimum=0.05, maximum=0.5)
    width_m: float = setting(0.085, "of an insole [m]", minimum=0.02, maximum=0.2)
    counts_per_n: float = setting(20.0, "of a taxel", minimum=0.01, maximum=1e4)
    noise_counts: float = setting(3.0, "standard deviation of a reading", minimum=0.0, maximum=500.0)
    object_n: float = setting(
        0.0, "force of an object under the middle of each foot that is always there [N]", minimum=0.0, maximum=2000.0
    )

    def __post_init__(self) -> None:
        validate(self)
        longest_share = self.stance_share * (1.0 + abs(self.limp))
        if longest_share >= 1.0:
            raise SettingsError(
                f"stance_share = {self.stance_share:g} with limp = {self.limp:g}: a foot would carry for "
                f"{longest_share:.3g} of a stride, and be set down before it is lifted; allowed is below 1: lower one "
                f"of them"
            )

    @property
    def along_m(self) -> Array:
        """Middle of each row, from the middle of the insole towards the toes [m]."""
        return (0.5 - (np.arange(self.rows) + 0.5) / self.rows) * self.length_m


@dataclass(frozen=True)
class Footfall:
    """A foot that is set down, rolls, and is lifted; from the first touch to the last [s].

    A foot that stands from the beginning has a strike at minus infinity, one that stands at the end a toe off at
    infinity.
    """

    strike_s: float
    toe_off_s: float
    stance_s: float

    def course(self, time_s: Array) -> Array:
        """How much of the stance is over, 0 to 1; outside of it 0 or 1."""
        if math.isinf(self.strike_s):
            return np.clip(1.0 - (self.toe_off_s - time_s) / self.stance_s, 0.0, 1.0)
        return np.clip((time_s - self.strike_s) / self.stance_s, 0.0, 1.0)

    @property
    def is_whole(self) -> bool:
        """Whether the foot was lifted before and after."""
        return math.isfinite(self.strike_s) and math.isfinite(self.toe_off_s)

    def above_s(self, share: float) -> tuple[float, float]:
        """When the force rises above a share of its largest, and falls below it [s]; of a whole one."""
        level, top = share * _STEP.max(), int(_STEP.argmax())
        rise = np.interp(level, _STEP[:3], _COURSE[:3])
        fall = np.interp(-level, -_STEP[top:], _COURSE[top:])
        return float(self.strike_s + rise * self.stance_s), float(self.strike_s + fall * self.stance_s)


@dataclass(frozen=True)
class Walking:
    """A walk, and the truth.

    Attributes
    ----------
    walk : Walk
    duration_s : float
    footfalls : tuple of tuples of Footfall
        Of the left foot and of the right, in the order of time.
    """

    walk: Walk
    duration_s: float
    footfalls: tuple[tuple[Footfall, ...], tuple[Footfall, ...]]

    def force_n(self, foot: int, time_s: Array) -> Array:
        """Force of a foot on its insole, without the object [N]; np.ndarray [shape=(n,), dtype=float64]."""
        force = np.zeros_like(time_s)
        for footfall in self.footfalls[foot]:
            shape = _STEP
            if not footfall.is_whole:
                shape = _FROM_STANDING if math.isinf(footfall.strike_s) else _TO_STANDING
            force += self.walk.weight_n * np.interp(footfall.course(time_s), _COURSE, shape) * _during(footfall, time_s)
        sway = _SWAY * np.sin(2 * np.pi * _SWAY_HZ * time_s)
        return force * (1.0 + (sway if foot == 0 else -sway))

    def y_m(self, foot: int, time_s: Array) -> Array:
        """Centre of pressure of the foot along the insole, from its middle towards the toes [m]; 0 while lifted."""
        centre_m: Array = self._under(self._pressed_m(foot, time_s)).sum(2) @ self.walk.along_m
        return centre_m

    def _pressed_m(self, foot: int, time_s: Array) -> Array:
        """Where the foot presses most; near an end of the insole that is not the centre."""
        place = np.full_like(time_s, 0.5)
        for footfall in self.footfalls[foot]:
            course = footfall.course(time_s)
            # Who stands does so on the whole foot.
            if math.isinf(footfall.strike_s):
                course = np.maximum(course, 0.5)
            elif math.isinf(footfall.toe_off_s):
                course = np.minimum(course, 0.5)
            place = np.where(_during(footfall, time_s), np.interp(course, _COURSE, _ALONG), place)
        return (place - 0.5) * self.walk.length_m

    def frames(self, time_s: Array, rng: np.random.Generator) -> NDArray[np.uint16]:
        """What the insoles read at these times [s].

        Returns
        -------
        np.ndarray [shape=(n, 2, rows, cols), dtype=uint16]
            0 to 1023 counts, those of the left foot first; the toes are at the first row.
        """
        walk = self.walk
        frames = np.zeros((time_s.size, 2, walk.rows, walk.cols), dtype=np.uint16)
        middle = self._under(np.zeros(1))[0]
        for first in range(0, time_s.size, _AT_ONCE):
            part = np.s_[first : first + _AT_ONCE]
            for foot in range(2):
                under = self._under(self._pressed_m(foot, time_s[part]))
                force_n = self.force_n(foot, time_s[part])[:, None, None] * under + walk.object_n * middle
                counts = walk.counts_per_n * force_n
                counts += walk.noise_counts * rng.standard_normal(counts.shape)
                frames[part, foot] = np.clip(np.rint(counts), 0, COUNT_MAX)
        return frames

    def _under(self, y_m: Array) -> Array:
        """Share of the force on each taxel of a foot that presses at these places; shape (n, rows, cols)."""
        walk = self.walk
        across_m = ((np.arange(walk.cols) + 0.5) / walk.cols - 0.5) * walk.width_m
        by_row = np.exp(-0.5 * ((walk.along_m - y_m[:, None]) / (_SPREAD_ALONG * walk.length_m)) ** 2)
        by_col = np.exp(-0.5 * (across_m / (_SPREAD_ACROSS * walk.width_m)) ** 2)
        by_row /= by_row.sum(1, keepdims=True)
        return by_row[:, :, None] * (by_col / by_col.sum())


def walk(config: Walk, duration_s: float, rng: np.random.Generator) -> Walking:
    """Let somebody walk, the left foot first, for as many steps as the time allows.

    Parameters
    ----------
    config : Walk
    duration_s : float
        With the standing before and after [s].
    rng : np.random.Generator
        Of the strides' times.
    """
    if not config.cadence_per_min:
        standing = Footfall(-math.inf, duration_s + 1000.0, 1.0)
        return Walking(config, duration_s, ((standing,), (standing,)))
    stride_s = 120.0 / config.cadence_per_min
    shares = (config.stance_share * (1.0 + config.limp), config.stance_share * (1.0 - config.limp))
    lifted_s = (config.standing_s, config.standing_s + stride_s / 2)
    strikes = _strikes_s(config, duration_s, lifted_s, shares[0], rng)
    footfalls = []
    for strikes_s, share, first_s in zip(strikes, shares, lifted_s, strict=True):
        found = [Footfall(-math.inf, first_s, share * stride_s)]
        for strike_s, next_s in itertools.pairwise(strikes_s):
            stance_s = share * (next_s - strike_s)
            found.append(Footfall(strike_s, strike_s + stance_s, stance_s))
        found.append(Footfall(strikes_s[-1], math.inf, share * stride_s))
        footfalls.append(tuple(found))
    return Walking(config, duration_s, (footfalls[0], footfalls[1]))


def _strikes_s(
    config: Walk, duration_s: float, lifted_s: tuple[float, float], left_share: float, rng: np.random.Generator
) -> tuple[list[float], list[float]]:
    """When the left foot is set down, and the right one, of which each is half a stride later than the left [s].

    Both share the strides' times: with times of its own each foot would drift to any phase of the other.
    """
    stride_s = 120.0 / config.cadence_per_min
    left_s, right_s = [lifted_s[0] + stride_s * (1.0 - left_share)], []
    while True:
        is_last = left_s[-1] + 2 * stride_s >= duration_s - config.standing_s
        factor = 1.0 if is_last else 1.0 + config.variation * _normal(rng)
        half_s = stride_s * (factor / 2 + _JITTER * config.variation * _normal(rng))
        # Not before it is lifted for the first time, after a short first stride.
        right_s.append(max(left_s[-1] + half_s, lifted_s[1]))
        if is_last:
            return left_s, right_s
        left_s.append(left_s[-1] + factor * stride_s)


def _normal(rng: np.random.Generator) -> float:
    return float(np.clip(rng.standard_normal(), -2.0, 2.0))


def _during(footfall: Footfall, time_s: Array) -> NDArray[np.bool_]:
    during: NDArray[np.bool_] = (time_s >= footfall.strike_s) & (time_s <= footfall.toe_off_s)
    return during
