# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Motion of the joints, always within their limits of speed and acceleration.

Floats instead of arrays: for six values per cycle NumPy is slower.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from acts_core.robots import ur5e

Joint6 = list[float]

# A joint is at rest below this speed [rad/s].
_STANDSTILL_RAD_S = 1e-9


class JointState:
    """Angles, speeds and accelerations of the six joints [rad, rad/s, rad/s2], and their limits."""

    def __init__(self, q_rad: Sequence[float], speed_limit_rad_s: float, acceleration_limit_rad_s2: float) -> None:
        self.q = [float(angle) for angle in q_rad]
        self.qd: Joint6 = [0.0] * ur5e.JOINTS
        self.qdd: Joint6 = [0.0] * ur5e.JOINTS
        self.speed_limit_rad_s = speed_limit_rad_s
        self.acceleration_limit_rad_s2 = acceleration_limit_rad_s2

    @property
    def at_rest(self) -> bool:
        """Whether no joint moves."""
        return all(abs(speed) < _STANDSTILL_RAD_S for speed in self.qd)

    def fastest_rad_s(self) -> float:
        """Speed of the fastest joint."""
        return max(abs(speed) for speed in self.qd)

    def advance(self, index: int, speed: float, dt_s: float, angle: float | None = None) -> None:
        """Bring one joint to a speed after `dt_s`, within the limits.

        `angle` is its angle after that, unless a limit interferes; by default that of a constant acceleration.
        """
        before = self.qd[index]
        step = self.acceleration_limit_rad_s2 * dt_s
        limited = min(max(speed, before - step), before + step)
        limited = min(max(limited, -self.speed_limit_rad_s), self.speed_limit_rad_s)
        # The speed may exceed its limit within a cycle as well.
        furthest = self.speed_limit_rad_s * dt_s
        if angle is None or limited != speed or abs(angle - self.q[index]) > furthest:
            angle = self.q[index] + 0.5 * (before + limited) * dt_s
        self.q[index] = angle
        self.qd[index] = limited
        self.qdd[index] = (limited - before) / dt_s


class Motion(Protocol):
    """A motion of the arm."""

    def step(self, joints: JointState, dt_s: float) -> bool:
        """Advance by `dt_s`; return whether the motion has ended."""


class Rest:
    """No motion."""

    def step(self, joints: JointState, dt_s: float) -> bool:
        """Stay."""
        joints.qdd = [0.0] * ur5e.JOINTS
        return True


class Brake:
    """Brake without a change of direction; the fastest joint has the given deceleration."""

    def __init__(self, deceleration_rad_s2: float) -> None:
        self.deceleration_rad_s2 = deceleration_rad_s2

    def step(self, joints: JointState, dt_s: float) -> bool:
        """Brake; ends at rest."""
        fastest = joints.fastest_rad_s()
        deceleration = min(self.deceleration_rad_s2, joints.acceleration_limit_rad_s2)
        remaining = max(fastest - deceleration * dt_s, 0.0)
        scale = remaining / fastest if fastest > _STANDSTILL_RAD_S else 0.0
        for index in range(ur5e.JOINTS):
            joints.advance(index, joints.qd[index] * scale, dt_s)
        return joints.at_rest


class Servo:
    """``servoj``: follow a target that changes every cycle, critically damped with ``w = 2 / lookahead``.

    At constant speed of the target, the arm lags by lookahead times that speed. The desired speed is ``w / 2 * error``,
    reached with a time constant of ``1 / (2 w)``. For errors from which the arm could not brake in time, the desired
    speed grows only with the square root of the error, so that a far target is reached without overshoot.
    """

    def __init__(self) -> None:
        self.target: Joint6 = [0.0] * ur5e.JOINTS
        self.lookahead_s = 0.1

    def set(self, target_rad: Sequence[float], lookahead_s: float) -> None:
        """Set the target."""
        self.target[:] = target_rad
        self.lookahead_s = lookahead_s

    def step(self, joints: JointState, dt_s: float) -> bool:
        """Move towards the target; never ends."""
        w = 2.0 / self.lookahead_s
        decay = math.exp(-w * dt_s)
        acceleration = joints.acceleration_limit_rad_s2
        linear_up_to = 4.0 * acceleration / w**2
        for index, target in enumerate(self.target):
            error = target - joints.q[index]
            distance = abs(error)
            if distance > linear_up_to:
                approach = math.sqrt(2.0 * acceleration * (distance - 0.5 * linear_up_to))
                error = math.copysign(2.0 * approach / w, error)
            # Exact solution of x'' + 2 w x' + w^2 x = 0 over the cycle, x being the angle relative to the target.
            speed = joints.qd[index]
            slope = speed - w * error
            x = (slope * dt_s - error) * decay
            joints.advance(index, (speed - w * slope * dt_s) * decay, dt_s, joints.q[index] + error + x)
        return False


class Speed:
    """``speedj``: reach joint speeds, the largest change at the given acceleration, and keep them."""

    def __init__(self) -> None:
        self.target: Joint6 = [0.0] * ur5e.JOINTS
        self.acceleration_rad_s2 = 1.0

    def set(self, target_rad_s: Sequence[float], acceleration_rad_s2: float) -> None:
        """Set the speeds."""
        self.target[:] = target_rad_s
        self.acceleration_rad_s2 = acceleration_rad_s2

    def step(self, joints: JointState, dt_s: float) -> bool:
        """Keep the speeds; never ends."""
        limit = joints.speed_limit_rad_s
        wanted = [min(max(speed, -limit), limit) for speed in self.target]
        change = max(abs(target - speed) for target, speed in zip(wanted, joints.qd, strict=True))
        step = min(self.acceleration_rad_s2, joints.acceleration_limit_rad_s2) * dt_s
        scale = min(1.0, step / change) if change > 0.0 else 0.0
        for index, target in enumerate(wanted):
            joints.advance(index, joints.qd[index] + scale * (target - joints.qd[index]), dt_s)
        return False


class Move:
    """``movej``: all joints in step to a target with a trapezoidal speed; a moving arm is first brought to rest."""

    def __init__(self, target_rad: Sequence[float], speed_rad_s: float, acceleration_rad_s2: float) -> None:
        self._target = list(target_rad)
        self._speed = speed_rad_s
        self._acceleration = acceleration_rad_s2
        self._start: Joint6 = []
        self._elapsed_s = 0.0

    def restart(self) -> None:
        """Restart from the present angles."""
        self._start = []
        self._elapsed_s = 0.0

    def step(self, joints: JointState, dt_s: float) -> bool:
        """Move along the trapezoid; ends at the target."""
        if not self._start:
            if not joints.at_rest:
                Brake(self._acceleration).step(joints, dt_s)
                return False
            self._start = list(joints.q)
        self._elapsed_s += dt_s
        distances = [target - start for target, start in zip(self._target, self._start, strict=True)]
        longest = max(abs(distance) for distance in distances)
        speed = min(self._speed, joints.speed_limit_rad_s)
        acceleration = min(self._acceleration, joints.acceleration_limit_rad_s2)
        travelled, rate, done = _trapezoid(longest, speed, acceleration, self._elapsed_s)
        for index, distance in enumerate(distances):
            share = distance / longest if longest > 0.0 else 0.0
            before = joints.qd[index]
            joints.qd[index] = 0.0 if done else share * rate
            joints.qdd[index] = (joints.qd[index] - before) / dt_s
            joints.q[index] = self._target[index] if done else self._start[index] + share * travelled
        return done


def _trapezoid(distance: float, speed: float, acceleration: float, time_s: float) -> tuple[float, float, bool]:
    """Distance covered, speed, and whether the end is reached, `time_s` into a move of `distance` >= 0."""
    peak = min(speed, math.sqrt(distance * acceleration))
    if peak <= 0.0:
        return distance, 0.0, True
    ramp_s = peak / acceleration
    total_s = distance / peak + ramp_s
    if time_s >= total_s:
        return distance, 0.0, True
    if time_s < ramp_s:
        return 0.5 * acceleration * time_s**2, acceleration * time_s, False
    left_s = total_s - time_s
    if left_s < ramp_s:
        return distance - 0.5 * acceleration * left_s**2, acceleration * left_s, False
    return peak * (time_s - 0.5 * ramp_s), peak, False
