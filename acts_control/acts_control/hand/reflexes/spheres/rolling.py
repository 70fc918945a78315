# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Rolling a sphere along the palm: a thumb comes down on top of it, and moves along with its surface.

On the palm a sphere rolls more easily than it slides. A tip on top of it moves it to all sides; one at its flank only
pushes it away.
"""

from __future__ import annotations

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes.base import Sensed
from acts_control.hand.reflexes.spheres import aiming
from acts_control.hand.reflexes.spheres.ball import Ball
from acts_core.skin import RegionContact

Array = NDArray[np.float64]

# The radius is not known before the tip touches: it aims at a sphere that shrinks from the largest to the smallest,
# more slowly while it is farther from its target than `_BEHIND_M`.
_LARGEST_M, _SMALLEST_M = 0.045, 0.010
_SHRINK_M_S, _SLOW_M_S, _BEHIND_M = 0.06, 0.02, 0.015
_AIM_SPEED_M_S = 0.15
# Where on it the tip aims, as shares of the radius: from the top to its own side, and in all at most so far. On a
# sphere of `_REACHED_M` or less also ahead, for the tip will move farther than the sphere; larger ones a thumb reaches
# from its own side only.
_ASIDE, _FARTHEST = 0.45, 0.55
_REACHED_M, _FADES_M = 0.026, 0.010

_CENTRED_S, _LONGEST_S = 0.2, 4.0
_NOTHING_S = 0.5
# A contact that is less high on the sphere (`Ball.height`) pushes more than it rolls.
_LOW, _LOW_S = 0.6, 0.1


class Phase(Enum):
    """What has become of it."""

    ROLLING = "on its way"
    CENTRED = "at the palm's centre"
    GIVEN_UP = "not reached from above"


class Rolling:
    """One sphere that is rolled to the palm's centre.

    Parameters
    ----------
    finger : str
        That comes down on it.

    Attributes
    ----------
    phase : Phase
    """

    def __init__(self, finger: str) -> None:
        self.finger = finger
        self.phase = Phase.ROLLING
        self._aimed_m = _LARGEST_M
        self._rolling_s = self._centred_s = self._nothing_s = self._low_s = 0.0

    def step(self, sensed: Sensed, ball: Ball, touching: RegionContact | None, *, is_off: bool) -> Array | None:
        """Joint speeds that bring the tip down on it; None where it is there, or rolling has ended [rad/s].

        Parameters
        ----------
        sensed : Sensed
        ball : Ball
        touching : RegionContact or None
            What the finger feels of it.
        is_off : bool
            Whether it still has to be moved.

        Returns
        -------
        np.ndarray [shape=(joints,)] or None
            [rad/s]
        """
        at_m = None if touching is None else sensed.pose.point(touching.link, touching.centre_m)
        is_low = at_m is not None and ball.height(at_m) < _LOW
        finds_nothing = at_m is None and self._aimed_m <= _SMALLEST_M
        self._rolling_s += sensed.dt_s
        self._centred_s = self._centred_s + sensed.dt_s if at_m is not None and not is_off else 0.0
        self._low_s = self._low_s + sensed.dt_s if is_low else 0.0
        self._nothing_s = self._nothing_s + sensed.dt_s if finds_nothing else 0.0
        if self._centred_s > _CENTRED_S:
            self.phase = Phase.CENTRED
        elif self._low_s > _LOW_S or self._nothing_s > _NOTHING_S or self._rolling_s > _LONGEST_S:
            self.phase = Phase.GIVEN_UP
        if at_m is not None or self.phase is not Phase.ROLLING:
            self._aimed_m = min(ball.radius_m, _LARGEST_M)
            return None
        return self._come_down(sensed, ball)

    def _come_down(self, sensed: Sensed, ball: Ball) -> Array:
        radius_m = self._aimed_m
        side = aiming.approaches(sensed, ball.foot_m, ball.up)[self.finger].side
        ahead = np.clip((_REACHED_M + _FADES_M - radius_m) / _FADES_M, 0.0, 1.0)
        from_top = _ASIDE * side - ahead * ball.away_m / radius_m
        share = min(float(np.linalg.norm(from_top)), _FARTHEST)
        direction = share * aiming.unit(from_top) + np.sqrt(1.0 - share**2) * ball.up
        target = ball.foot_m + radius_m * (ball.up + direction)
        is_behind = np.linalg.norm(aiming.pad_m(sensed, self.finger) - target) > _BEHIND_M
        self._aimed_m = max(radius_m - (_SLOW_M_S if is_behind else _SHRINK_M_S) * sensed.dt_s, _SMALLEST_M)
        return aiming.reach(sensed, self.finger, target, -direction, _AIM_SPEED_M_S)
