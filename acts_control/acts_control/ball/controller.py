# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The controller between estimate and robot: waits for a ball, balances it, and brings motion to a defined end."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from math import hypot, isinf
from typing import NamedTuple

from acts_control.ball.limiter import LimiterConfig, TiltLimiter
from acts_control.ball.pid import Ball, BallPid, PidConfig
from acts_control.ball.prediction import TiltHistory
from acts_control.ball.reference import Reference, ReferenceFollower, ReferenceLimits, ReferenceReport
from acts_control.robots.base import SafetyConfig, touch_age_s
from acts_core.settings import Changeable, setting, validate

# An estimate beyond these is of no ball on a plate [m, m/s].
_FARTHEST_M = 1.0
_FASTEST_M_S = 5.0

# So many estimates in a row that are too old when they come are no delay.
_CONFIRMED = 5

_IN_THE_FUTURE = "its stamps lie in the future, the clocks differ"


class Phase(IntEnum):
    """What the controller does; the numbers are those of BalanceStatus."""

    CONNECTING = 0
    HOMING = 1
    WAITING = 2
    BALANCING = 3
    STOPPED = 4


@dataclass(frozen=True)
class ControllerConfig(PidConfig, LimiterConfig, SafetyConfig):
    """Gains, limits, and when to begin."""

    engage_after_s: float = setting(
        0.1,
        "how long a ball must have been felt before the loop is closed [s]",
        minimum=0.0,
        maximum=10.0,
        changeable=Changeable.RUNNING,
    )
    reference_stale_after_s: float = setting(
        0.2,
        "without a reference for longer the ball is held at the last one [s]",
        minimum=0.01,
        maximum=10.0,
        changeable=Changeable.RUNNING,
    )
    reference_reach_m: float = setting(
        0.07,
        "a reference farther from the centre than this in x or y is refused [m]",
        minimum=0.005,
        maximum=1.0,
        changeable=Changeable.RUNNING,
    )
    settle_s: float = setting(
        0.2,
        "how long the plate is commanded level before a stop counts as done [s]",
        minimum=0.0,
        maximum=5.0,
        changeable=Changeable.RUNNING,
    )

    def __post_init__(self) -> None:
        validate(self)


class BallReport(NamedTuple):
    """An estimate as it arrived.

    Attributes
    ----------
    stamp_ns : int
        Time of measurement of the newest contact message in it [ns].
    valid : bool
        Whether there is a ball.
    ball : Ball
        Where it was at that time.
    """

    stamp_ns: int
    valid: bool
    ball: Ball


class ControlInput(NamedTuple):
    """All a control step looks at.

    Attributes
    ----------
    now_ns : int
        The time, by the clock of the stamps [ns].
    ball : BallReport or None
        Newest estimate; None before the first.
    reference : ReferenceReport or None
        Newest reference; None before the first.
    tilt_rad : (float, float)
        Measured tilt of the plate [rad].
    """

    now_ns: int
    ball: BallReport | None
    reference: ReferenceReport | None
    tilt_rad: tuple[float, float]


@dataclass
class ControllerState:
    """Everything worth publishing.

    Attributes
    ----------
    phase : Phase
        WAITING or BALANCING; STOPPED once motion has ended.
    reason : str
        Why, in words.
    ending : bool
        Whether motion is being ended: the plate is on its way to level.
    error_m : (float, float)
        Ball minus reference [m]; 0 while not balancing.
    tilt_rad : (float, float)
        Commanded tilt [rad].
    touch_age_s : float
        Age of the newest contact [s]; infinite before the first.
    reference_problem : str
        Why the ball is not led by the newest reference, in words; empty where it is.
    """

    phase: Phase = Phase.WAITING
    reason: str = "waiting for touch"
    ending: bool = False
    error_m: tuple[float, float] = (0.0, 0.0)
    tilt_rad: tuple[float, float] = (0.0, 0.0)
    touch_age_s: float = field(default=float("inf"))
    reference_problem: str = ""


class BallController:
    """From estimate and reference to a tilt, with everything that may interrupt it.

    Attributes
    ----------
    config : ControllerConfig
    state : ControllerState
        Changed in place by `step`.
    """

    def __init__(self, config: ControllerConfig) -> None:
        self.config = config
        self.state = ControllerState()
        self._pid = BallPid(config, config.max_tilt_rad)
        self._limiter = TiltLimiter(config)
        self._ball_s = 0.0
        self._no_ball_s = 0.0
        self._level_s = 0.0
        self._stale_s = 0.0
        self._reported_ns: int | None = None
        self._unchanged_s = 0.0
        self._came_old = 0
        self._references = ReferenceFollower(_reference_limits(config))
        self._tilts = TiltHistory(config.lever_arm_m, 2.0 * config.touch_stale_after_s)

    def change(self, config: ControllerConfig) -> None:
        """Go on with other gains and limits (those that are `Changeable.RUNNING`), between two steps.

        The commanded tilt goes on from where it is, at the limited rate, also where it is beyond the new limit.
        """
        self.config = config
        self._pid.config, self._pid.max_tilt_rad = config, config.max_tilt_rad
        self._limiter.config = config
        self._references.limits = _reference_limits(config)

    def end(self, reason: str) -> None:
        """Bring the plate to level and stop there; the first reason is kept."""
        if not self.state.ending:
            self.state.ending = True
            self.state.reason = reason

    def step(self, inputs: ControlInput, dt: float) -> tuple[float, float]:
        """One control step.

        Parameters
        ----------
        inputs : ControlInput
        dt : float
            Time since the last step [s].

        Returns
        -------
        tilt_x_rad, tilt_y_rad : float
            Tilt to command now [rad], finite and within the limits.
        """
        state, config = self.state, self.config
        report = inputs.ball
        state.touch_age_s = self._touch_age_s(inputs, dt)
        fresh = state.touch_age_s <= config.touch_stale_after_s
        ball = report.ball if report is not None and fresh and report.valid and _is_plausible(report.ball) else None
        reference = self._references.step(inputs.reference, inputs.now_ns)
        state.reference_problem = self._references.problem if inputs.reference is not None else "no reference has come"
        self._stale_s = 0.0 if fresh else self._stale_s + dt
        self._tilts.add(inputs.now_ns, *inputs.tilt_rad)
        if ball is not None and report is not None:
            ball = self._tilts.predict(ball, report.stamp_ns)
        state.error_m = (0.0, 0.0)
        target = (0.0, 0.0)
        if state.ending or state.phase is Phase.STOPPED:
            self._finish(dt)
        elif state.phase is Phase.WAITING:
            self._wait(fresh, ball is not None, reference is not None, dt)
        elif ball is not None and reference is not None:
            target = self._balance(ball, reference, inputs, dt)
        else:
            self._do_without(fresh, dt)
        state.tilt_rad = self._limiter.step(*target, dt)
        return state.tilt_rad

    def _touch_age_s(self, inputs: ControlInput, dt: float) -> float:
        """Age of the newest estimate [s]: by its stamp, and by how long it has been the newest, whatever clocks say."""
        if inputs.ball is None:
            return float("inf")
        stamp_ns, stale_after_s = inputs.ball.stamp_ns, self.config.touch_stale_after_s
        age_s = touch_age_s(inputs.now_ns, stamp_ns)
        if stamp_ns != self._reported_ns:
            self._unchanged_s = 0.0
            self._came_old = self._came_old + 1 if age_s > stale_after_s else 0
        else:
            self._unchanged_s += dt
            self._came_old = self._came_old if self._unchanged_s <= stale_after_s else 0
        self._reported_ns = stamp_ns
        return max(age_s, self._unchanged_s)

    def _wait(self, fresh: bool, ball: bool, reference: bool, dt: float) -> None:
        state = self.state
        self._ball_s = self._ball_s + dt if ball and reference else 0.0
        if not fresh:
            state.reason = "; ".join(filter(None, ("waiting for touch", self._why_it_counts_as_none())))
        elif not ball:
            state.reason = "waiting for a ball"
        elif not reference:
            state.reason = "; ".join(filter(None, ("waiting for a reference", self._references.problem)))
        if self._ball_s > self.config.engage_after_s:
            state.phase = Phase.BALANCING
            state.reason = "balancing"
            self._no_ball_s = 0.0
            self._pid.reset()

    def _why_it_counts_as_none(self) -> str:
        """Why touch that comes is not used, in words without numbers; empty where none comes."""
        if self._came_old < _CONFIRMED:
            return ""
        if isinf(self.state.touch_age_s):
            return _IN_THE_FUTURE
        where = "as from a recording, or a machine that is busy or whose clock is behind"
        return f"what comes is older than touch_stale_after_s, {where}"

    def _balance(self, ball: Ball, reference: Reference, inputs: ControlInput, dt: float) -> tuple[float, float]:
        state = self.state
        self._no_ball_s = 0.0
        state.reason = "; ".join(filter(None, ("balancing", self._references.problem)))
        state.error_m = (ball.x_m - reference.x_m, ball.y_m - reference.y_m)
        return self._pid.step(ball, reference, inputs.tilt_rad, dt)

    def _do_without(self, fresh: bool, dt: float) -> None:
        """The loop is open: the plate goes level, and on the way it is decided what this is."""
        state, config = self.state, self.config
        if not fresh:
            if self._stale_s > config.touch_stop_after_s:
                self.end(f"touch is stale: {self._stale_in_words()}")
            else:
                state.reason = "touch is stale: levelling the plate"
            return
        self._no_ball_s += dt
        state.reason = "no contact: levelling the plate"
        if self._no_ball_s > config.ball_lost_after_s:
            state.phase = Phase.WAITING
            state.reason = "ball lost: waiting for a ball"
            self._ball_s = 0.0

    def _stale_in_words(self) -> str:
        age_s = self.state.touch_age_s
        if isinf(age_s):
            return _IN_THE_FUTURE
        return f"the newest is {age_s:.2f} s old, and none was younger than {self.config.touch_stale_after_s:g} s"

    def _finish(self, dt: float) -> None:
        self._level_s = self._level_s + dt if self._limiter.is_level else 0.0
        if self._level_s > self.config.settle_s:
            self.state.phase = Phase.STOPPED


def _reference_limits(config: ControllerConfig) -> ReferenceLimits:
    return ReferenceLimits(
        config.reference_reach_m, config.reference_stale_after_s, config.max_tilt_rad, config.max_tilt_rate_rad_s
    )


def _is_plausible(ball: Ball) -> bool:
    # Not by "greater": nothing is greater than NaN.
    return hypot(ball.x_m, ball.y_m) <= _FARTHEST_M and hypot(ball.vx_m_s, ball.vy_m_s) <= _FASTEST_M_S
