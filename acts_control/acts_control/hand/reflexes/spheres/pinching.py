# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Getting hold of a sphere that a thumb lies on, and that is too small for more than one finger beside it.

The thumb lifts and makes room, around the sphere to its own side. Then the finger in the middle comes over the sphere,
and at last the thumb comes against it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes.base import Sensed
from acts_control.hand.reflexes.spheres import aiming
from acts_control.hand.reflexes.spheres.aiming import Approach
from acts_control.hand.reflexes.spheres.ball import Ball
from acts_core.skin import RegionContact

Array = NDArray[np.float64]

# How far from the sphere a tip waits, and how far within it one aims at last that has not touched it.
_LIFTED_M, _WAITS_M, _WITHIN_M = 0.011, 0.014, 0.008
_OVER_WAITS_M = 0.020
_CLOSES_M_S = 0.04
_SPEED_M_S, _PRESS_M_S = 0.15, 0.010
# A tip goes around the sphere by aiming at most this far ahead; it has arrived when it is so near its direction.
_AHEAD_RAD, _ARRIVED_RAD = 0.4, 0.25
_GRIPPED_S, _LONGEST_S = 0.1, 2.5


class Pinching:
    """One grip of two fingers.

    Parameters
    ----------
    ball : Ball
        The sphere; its place is followed as long as the palm feels it.
    grip_force_n : float
        A finger has gripped when it feels so much [N].

    Attributes
    ----------
    has_gripped : bool
        Whether both fingers grip.
    has_ended : bool
        Whether they do, or it has taken too long.
    """

    def __init__(self, ball: Ball, grip_force_n: float) -> None:
        self.has_gripped = self.has_ended = False
        self._radius_m, self._at_m, self._up = ball.radius_m, ball.foot_m, ball.up
        self._grip_force_n = grip_force_n
        self._gap_m = {"over": _OVER_WAITS_M, "against": _WAITS_M}
        self._is_lifted = self._has_room = False
        self._pinching_s = self._gripped_s = 0.0

    def step(self, sensed: Sensed) -> Array:
        """Joint speeds of both fingers, shape (joints,) [rad/s]; the others stay where they are."""
        felt = aiming.felt_by_palm(sensed, self._radius_m)
        if felt is not None:
            self._at_m, self._up = felt
        found = aiming.approaches(sensed, self._at_m, self._up)
        pair = {finger: approach for finger, approach in found.items() if approach.part != "beside"}
        is_over = any(_touched(sensed, finger) for finger, one in pair.items() if one.part == "over")
        rates, grip = sensed.steps(), True
        for finger, approach in pair.items():
            comes = self._has_room if approach.part == "over" else is_over
            touched = _touched(sensed, finger)
            force_n = sum(one.force_n for one in touched)
            grip &= force_n >= self._grip_force_n
            if not comes and approach.part == "against":
                rates += self._make_room(sensed, finger, approach, is_touching=bool(touched))
            elif comes and not touched:
                gap_m = max(self._gap_m[approach.part] - _CLOSES_M_S * sensed.dt_s, -_WITHIN_M)
                self._gap_m[approach.part] = gap_m
                rates += self._go(sensed, finger, approach)
            elif comes and force_n < self._grip_force_n:
                rates += aiming.press(sensed, touched[-1], _PRESS_M_S)
        self._pinching_s += sensed.dt_s
        self._gripped_s = self._gripped_s + sensed.dt_s if grip else 0.0
        self.has_gripped = self._gripped_s > _GRIPPED_S
        self.has_ended = self.has_gripped or self._pinching_s > _LONGEST_S
        return rates

    def _make_room(self, sensed: Sensed, finger: str, approach: Approach, *, is_touching: bool) -> Array:
        """Joint speeds that lift a tip off the sphere, then bring it to where it waits [rad/s]."""
        away_m = aiming.pad_m(sensed, finger) - self._middle_m()
        if not self._is_lifted:
            self._is_lifted = not is_touching and float(np.linalg.norm(away_m)) > self._radius_m + _LIFTED_M
            to_m = aiming.pad_m(sensed, finger) + _WAITS_M * self._up
            return aiming.reach(sensed, finger, to_m, -self._up, _SPEED_M_S)
        belongs = approach.on_sphere(self._up, self._radius_m)
        left_rad = np.arccos(np.clip(aiming.unit(away_m) @ belongs, -1.0, 1.0))
        self._has_room |= bool(left_rad < _ARRIVED_RAD)
        return self._go(sensed, finger, approach)

    def _go(self, sensed: Sensed, finger: str, approach: Approach) -> Array:
        """Joint speeds that bring a tip around the sphere to where it belongs [rad/s]."""
        middle = self._middle_m()
        now = aiming.unit(aiming.pad_m(sensed, finger) - middle)
        way = aiming.turned(now, approach.on_sphere(self._up, self._radius_m), _AHEAD_RAD)
        target = middle + (self._radius_m + self._gap_m[approach.part]) * way
        return aiming.reach(sensed, finger, target, -way, _SPEED_M_S)

    def _middle_m(self) -> Array:
        result: Array = self._at_m + self._radius_m * self._up
        return result


def _touched(sensed: Sensed, finger: str) -> list[RegionContact]:
    return [one for one in sensed.of_finger(finger) if one.in_contact]
