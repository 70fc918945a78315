# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Closing the hand: into the shape from which it closes, then each finger until it feels enough.

Something small on the palm is aimed at: a sphere that touches the palm there and shrinks tells each fingertip where to
go, until one feels what is really there. Anything else is closed upon by all fingers alike, also what turns out to be
large.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes.base import Sensed, Wish
from acts_control.hand.reflexes.spheres import aiming
from acts_core.settings import setting, validate

Array = NDArray[np.float64]

_ARRIVED_RAD = 0.05
_SHAPED_AFTER_S = 1.5

# The sphere that fingers aim at: from where to where it shrinks, and how far within a real one it may be.
_LARGEST_M, _SMALLEST_M, _WITHIN_M = 0.060, 0.006, 0.006
_AIM_SPEED_M_S, _PRESS_M_S = 0.15, 0.010
_ARRIVES_S = 1.0
_NARROW_S = 0.15
_WIDEST_M = 0.008
# What is felt as large for so long is large.
_LARGE_S = 0.05


@dataclass(frozen=True)
class GraspConfig:
    """How the hand closes and opens."""

    grip_force_n: float = setting(
        0.5, "a finger that closes has gripped when its regions feel so much [N]", minimum=0.02, maximum=20.0
    )
    close_speed_rad_s: float = setting(
        1.0, "how fast the joint that takes most part closes [rad/s]", minimum=0.01, maximum=8.0
    )
    open_speed_rad_s: float = setting(3.0, "how fast the hand opens [rad/s]", minimum=0.01, maximum=8.0)
    grasp_posture: str = setting("pregrasp", "posture of the hand's description from which it closes")
    close_timeout_s: float = setting(3.0, "closing ends after this [s]", minimum=0.1, maximum=60.0)
    aim_spread_m: float = setting(
        0.0034,
        "what lies on the palm with no more spread than this is small: one finger aims at it [m]",
        minimum=0.0,
        maximum=0.1,
    )
    aim_shrink_m_s: float = setting(
        0.035, "how fast the sphere shrinks that fingers aim at [m/s]", minimum=0.001, maximum=1.0
    )
    grip_settle_s: float = setting(
        0.2, "how long all fingers must have gripped before it counts as held [s]", minimum=0.0, maximum=5.0
    )

    def __post_init__(self) -> None:
        validate(self)


class Grasp:
    """One closing of the hand.

    Parameters
    ----------
    config : GraspConfig

    Attributes
    ----------
    ended : str
        How closing has ended, in words; empty as long as it goes on.
    has_gripped : bool
        Whether something is held now.
    is_shaped : bool
        Whether the hand has come into the shape from which it closes.
    """

    def __init__(self, config: GraspConfig) -> None:
        self._config = config
        self.reset()

    def reset(self) -> None:
        """Begin anew."""
        self.ended = ""
        self.has_gripped = False
        self.is_shaped = False
        self._shaping_s = 0.0
        self._closing_s = 0.0
        self._gripped_s = 0.0
        self._since_s: dict[str, float] = {}
        self._narrow_s = 0.0
        self._aim: Aim | None = None
        self._may_aim = True

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps that close the hand."""
        config = self._config
        if not self.is_shaped and self._shapes(sensed):
            return towards(sensed, config.grasp_posture, config.open_speed_rad_s)
        self._closing_s += sensed.dt_s
        forces = {finger: sum(one.force_n for one in sensed.of_finger(finger)) for finger in sensed.hand.fingers}
        gripping = [finger for finger, force in forces.items() if force >= config.grip_force_n]
        if self._may_aim and self._aim is None and aiming.can_aim(sensed.hand):
            self._aim = self._look(sensed)
        if self._aim is not None:
            steps, is_closing = self._aim.step(sensed, gripping)
            if self._aim.is_large:
                # The palm barely touched it, or it touches the palm at an edge.
                self._aim, self._may_aim = None, False
        if self._aim is None:
            steps, is_closing = self._straight(sensed, gripping)
        all_grip = len(gripping) == len(forces)
        self._gripped_s = self._gripped_s + sensed.dt_s if all_grip else 0.0
        is_exhausted = self._closing_s > config.close_timeout_s or not (all_grip or is_closing)
        holders = self._holders(sensed, gripping)
        if self._gripped_s > config.grip_settle_s or is_exhausted:
            # Without a finger nothing is held, whatever lies on the palm.
            self.has_gripped = len(holders) >= 2 and not sensed.hand.fingers.keys().isdisjoint(holders)
            self.ended = f"gripped by {', '.join(holders)}" if self.has_gripped else "nothing was gripped"
        return Wish(steps, "closing")

    def _holders(self, sensed: Sensed, gripping: Sequence[str]) -> list[str]:
        """Fingers and regions of the palm that hold, or did a moment ago: a light grip comes and goes."""
        palm = [name for name, one in sensed.regions.items() if one.in_contact and not sensed.finger(name)]
        self._since_s = {name: since_s + sensed.dt_s for name, since_s in self._since_s.items()}
        self._since_s |= dict.fromkeys((*gripping, *palm), 0.0)
        lately = {name for name, since_s in self._since_s.items() if since_s <= self._config.grip_settle_s}
        # A region may have the name of its finger, which holds once.
        return [name for name in dict.fromkeys((*sensed.hand.fingers, *sensed.regions)) if name in lately]

    def _look(self, sensed: Sensed) -> Aim | None:
        """Whether something small lies on the palm: for a while, for what is put down sinks into the skin first."""
        felt = aiming.felt_by_palm(sensed, self._config.aim_spread_m)
        alone = felt is not None and not any(
            one.in_contact for name, one in sensed.regions.items() if sensed.finger(name)
        )
        self._narrow_s = self._narrow_s + sensed.dt_s if alone else 0.0
        return Aim(self._config, *felt) if felt is not None and self._narrow_s > _NARROW_S else None

    def _straight(self, sensed: Sensed, gripping: Sequence[str]) -> tuple[Array, bool]:
        """Steps by which all fingers that do not grip close, and whether one still can."""
        steps, is_closing = sensed.steps(), False
        closes = sensed.goal_rad < sensed.hand.upper_rad - 1e-6
        for finger in sensed.hand.fingers:
            closing = sensed.closing(finger)
            if finger not in gripping:
                steps += self._config.close_speed_rad_s / sensed.step_rad_s * closing
                is_closing |= bool(closes[closing > 0.0].any())
        return steps, is_closing

    def _shapes(self, sensed: Sensed) -> bool:
        """Whether the hand still has to come into the shape from which it closes."""
        touched = any(one.in_contact for name, one in sensed.regions.items() if sensed.finger(name))
        left = np.abs(np.array(sensed.hand.postures[self._config.grasp_posture]) - sensed.q_rad).max()
        self._shaping_s += sensed.dt_s
        # Something may be in the way that the skin does not feel.
        self.is_shaped = touched or bool(left < _ARRIVED_RAD) or self._shaping_s > _SHAPED_AFTER_S
        return not self.is_shaped


class Aim:
    """Closing on something small that the palm feels.

    Parameters
    ----------
    config : GraspConfig
    at_m, up : np.ndarray [shape=(3,)]
        Where the palm feels it, and the direction out of the palm.

    Attributes
    ----------
    is_large : bool
        Whether palm and fingers together say that it is not small.
    """

    def __init__(self, config: GraspConfig, at_m: Array, up: Array) -> None:
        self._config = config
        self._at_m, self._up = at_m, up
        self._radius_m = _LARGEST_M
        self._least_s = 0.0
        self._large_since_s = math.inf
        self.is_large = False

    def step(self, sensed: Sensed, gripping: Sequence[str]) -> tuple[Array, bool]:
        """Steps of all fingers, shape (joints,), and whether they are still on their way.

        Parameters
        ----------
        sensed : Sensed
        gripping : sequence of str
            Fingers that press hard enough already.
        """
        felt = aiming.felt_by_palm(sensed, _WIDEST_M)
        if felt is not None:
            self._at_m, self._up = felt
        up = self._up
        contacts = [one for name, one in sensed.regions.items() if one.in_contact and sensed.finger(name)]
        points = [sensed.pose.point(one.link, one.centre_m) for one in contacts]
        known_m = aiming.radius_on_palm(self._at_m, up, points)
        if sensed.is_new:
            # Only touch that has come since tells anything; the first stands for the cycle in which it came.
            is_large = known_m is not None and known_m >= aiming.SMALL_M
            began_s = min(self._large_since_s, sensed.time_s - sensed.dt_s)
            self._large_since_s = began_s if is_large else math.inf
            self.is_large = sensed.time_s - self._large_since_s > _LARGE_S
        least_m = max(_SMALLEST_M, (known_m or 0.0) - _WITHIN_M)
        self._radius_m = max(self._radius_m - self._config.aim_shrink_m_s * sensed.dt_s, least_m)
        rates = sensed.steps()
        for finger, approach in aiming.approaches(sensed, self._at_m, up).items():
            touched = [one for one in contacts if sensed.finger(one.name) == finger]
            radius_m = max(self._radius_m, approach.waits_m)
            middle = self._at_m + (known_m if known_m and radius_m <= known_m else radius_m) * up
            away = approach.on_sphere(up, radius_m)
            if touched:
                if finger not in gripping:
                    rates += aiming.press(sensed, touched[-1], _PRESS_M_S)
                continue
            rates += aiming.reach(sensed, finger, middle + radius_m * away, -away, _AIM_SPEED_M_S)
        self._least_s = self._least_s + sensed.dt_s if self._radius_m <= least_m else 0.0
        return rates / sensed.step_rad_s, self._least_s < _ARRIVES_S


def towards(sensed: Sensed, posture: str, speed_rad_s: float) -> Wish | None:
    """Steps towards a posture of the description, all joints arriving together; None once they have."""
    left = np.array(sensed.hand.postures[posture]) - sensed.goal_rad
    farthest = float(np.abs(left).max())
    if farthest < 1e-4:
        return None
    rates = left * min(speed_rad_s / farthest, 1.0 / max(sensed.dt_s, 1e-3))
    return Wish(rates / sensed.step_rad_s, f"to the posture {posture}")
