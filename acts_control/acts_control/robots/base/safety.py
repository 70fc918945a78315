# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What ends motion, whatever the robot: old touch, a robot that has stopped, and the last look at a tilt."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, isfinite, sqrt

from acts_control.robots.base.robot import RobotReading, TiltLimits
from acts_core.settings import Changeable, setting, validate

# A stamp this far in the future belongs to another clock; its age would never grow.
_FUTURE_S = 0.05

# How far beyond the limits of the tilt a command may be: more than rounding, less than would do harm.
_MARGIN = 1.1


@dataclass(frozen=True)
class SafetyConfig:
    """Limits whose crossing ends motion."""

    touch_stale_after_s: float = setting(
        0.2, "when no contact message is younger than this, the plate is levelled [s]", minimum=0.005, maximum=1.0
    )
    touch_stop_after_s: float = setting(
        3.0,
        "when touch stays missing for this long after that, motion ends: STOPPED; "
        "if touch returns before, balancing goes on [s]",
        minimum=0.005,
        maximum=60.0,
    )
    ball_lost_after_s: float = setting(
        0.25,
        "messages but no valid estimate for longer: back to waiting for a ball, level [s]",
        minimum=0.0,
        maximum=10.0,
        changeable=Changeable.RUNNING,
    )
    robot_stale_after_s: float = setting(
        0.2,
        "the robot's clock standing still, or a command not being taken, for longer is a lost connection [s]",
        minimum=0.02,
        # After 2.5 s ur_rtde begins to connect anew by itself.
        maximum=2.0,
    )

    def __post_init__(self) -> None:
        validate(self)


def touch_age_s(now_ns: int, stamp_ns: int) -> float:
    """Age of a measurement [s]; infinite when its stamp lies in the future, which is a wrong clock, not fresh touch."""
    age_s = (now_ns - stamp_ns) * 1e-9
    return age_s if age_s >= -_FUTURE_S else inf


class RobotWatch:
    """Finds out that the robot has stopped or is gone. (That a command is taken says nothing about it.)"""

    def __init__(self, config: SafetyConfig) -> None:
        self._config = config
        self._time_s = -inf
        self._still_s = 0.0
        self._joints: int | None = None

    def step(self, reading: RobotReading, dt: float) -> str:
        """Why no command may follow, in words; empty when all is well.

        Parameters
        ----------
        reading : RobotReading
        dt : float
            Time since the last step [s].
        """
        loss = self.loss(reading, dt)
        if loss:
            return loss
        if reading.waiting_s > self._config.robot_stale_after_s:
            return f"the robot has not taken a command for {reading.waiting_s:.2f} s"
        if reading.stopped:
            return reading.stopped
        if self._joints is None:
            self._joints = len(reading.joints)
        if len(reading.joints) != self._joints:
            return f"the robot reports {len(reading.joints)} joints, and {self._joints} before"
        if not all(map(isfinite, reading.joints)):
            return f"the robot reports joint angles {reading.joints}"
        if not all(map(isfinite, reading.tilt_rad)):
            return f"the robot reports a tilt of {reading.tilt_rad} rad"
        return ""

    def loss(self, reading: RobotReading, dt: float) -> str:
        """That the robot is gone or stands still, in words; empty when it is there. To be called instead of `step`."""
        if not reading.connected:
            # What connects to a robot may end a silent connection before enough steps of ours have passed.
            if reading.silent_s > self._config.robot_stale_after_s:
                return f"no data from the robot for {reading.silent_s:.2f} s"
            return "connection to the robot lost"
        # Not by "equal": nothing is equal to NaN, so that a clock of NaN would never stand still.
        self._still_s = 0.0 if abs(reading.time_s - self._time_s) > 0.0 else self._still_s + dt
        self._time_s = reading.time_s
        if self._still_s > self._config.robot_stale_after_s:
            return f"no data from the robot for {self._still_s:.2f} s"
        return ""


class TiltGate:
    """The last look at a tilt before it is commanded: finite, and within the limits but for a margin.

    The robot has a look of its own after this, at its joints. Nothing that the controller's limiter makes is refused
    while limits stay as they are. Where they are tightened while the plate is tilted, the old ones hold until it has
    come within the new ones; one that swings out of them again before it has braked is refused.

    Attributes
    ----------
    limits : TiltLimits
        May be changed between two commands.
    """

    def __init__(self, limits: TiltLimits) -> None:
        self.limits = limits
        self._sent = (0.0, 0.0)
        self._since_s = 0.0
        self._max_tilt_rad = limits.max_tilt_rad
        self._max_rate_rad_s = limits.max_tilt_rate_rad_s

    @property
    def fastest_rad_s(self) -> float:
        """The rate about each axis that the plate may have: that of the limits, or a larger one that it had before."""
        return max(self._max_rate_rad_s, self.limits.max_tilt_rate_rad_s)

    def fault(self, tilt_rad: tuple[float, float], dt: float) -> str:
        """Why a tilt must not be commanded, in words; empty when it may, and `sent` is to be called once it has been.

        Parameters
        ----------
        tilt_rad : (float, float)
            Rotation vector about the skin's x and y axes [rad].
        dt : float
            Time since the last call [s].
        """
        self._since_s += dt
        if not all(map(isfinite, tilt_rad)):
            return f"tilt = {tilt_rad} rad: only finite numbers can be commanded"
        allowed = _MARGIN * max(self._max_tilt_rad, self.limits.max_tilt_rad)
        if hypot(*tilt_rad) > allowed:
            return f"the command is {hypot(*tilt_rad):.4f} rad off the level pose, allowed is {allowed:.4f}"
        allowed = _MARGIN * self._longest_rad(self.fastest_rad_s)
        if self._step_rad(tilt_rad) > allowed:
            return f"the command jumps by {self._step_rad(tilt_rad):.4f} rad, allowed is {allowed:.4f}"
        return ""

    def sent(self, tilt_rad: tuple[float, float]) -> None:
        """Note the tilt that has been commanded."""
        limits = self.limits
        if hypot(*tilt_rad) <= _MARGIN * limits.max_tilt_rad:
            self._max_tilt_rad = limits.max_tilt_rad
        if self._step_rad(tilt_rad) <= self._longest_rad(limits.max_tilt_rate_rad_s):
            self._max_rate_rad_s = limits.max_tilt_rate_rad_s
        self._sent = tilt_rad
        self._since_s = 0.0

    def _step_rad(self, tilt_rad: tuple[float, float]) -> float:
        return hypot(tilt_rad[0] - self._sent[0], tilt_rad[1] - self._sent[1])

    def _longest_rad(self, rate_rad_s: float) -> float:
        # The limit is one of each axis, and both may turn.
        return sqrt(2.0) * rate_rad_s * self._since_s
