# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Two-axis PID from where the ball is to how the plate has to be tilted.

The law, per axis, with L the lever arm (see `acts_control.ball.estimator`) and lean the tilt that the plate has::

    r    = 5/7 c g v_ref / (|v_ref| + v0)              rolling resistance along the reference
    z    = x + 5/7 L lean                              the coordinate that only gravity accelerates, v = dz/dt
    e_z  = x_ref + L/g (a_ref + r) - z                 its error and that of its velocity
    e_v  = v_ref + L/g j_ref - v
    a    = a_ref + r + kp e_z + ki integral(x_ref - x) + kd e_v
    tilt = asin(a / (5/7 g))                           limited to the largest tilt
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import NamedTuple

from acts_control.ball.plate import (
    GRAVITY_M_S2,
    LEVER_ARM_SETTING,
    RESISTANCE_SETTING,
    RESISTANCE_SPEED_M_S,
    acceleration_of,
    resistance_per_speed,
    tilt_for,
)
from acts_control.ball.reference import Reference
from acts_core.settings import Changeable, setting, validate

# The adapted coefficient of rolling resistance stays below this.
_MOST_RESISTANCE = 0.05


@dataclass(frozen=True)
class PidConfig:
    """Gains; tuned in closed-loop simulation, see docs/ball_balancing.md for how far they may be off."""

    kp: float = setting(
        18.0, "acceleration per error of position [1/s^2]", minimum=0.0, maximum=200.0, changeable=Changeable.RUNNING
    )
    ki: float = setting(
        15.0,
        "acceleration per integrated error of position [1/s^3]",
        minimum=0.0,
        maximum=200.0,
        changeable=Changeable.RUNNING,
    )
    kd: float = setting(
        7.6, "acceleration per error of velocity [1/s]", minimum=0.0, maximum=50.0, changeable=Changeable.RUNNING
    )
    integral_zone_m: float = setting(
        0.010,
        "the error is integrated only where it is smaller than this [m]",
        minimum=0.0,
        maximum=0.2,
        changeable=Changeable.RUNNING,
    )
    max_integral_m_s2: float = setting(
        0.25,
        "largest acceleration the integral may ask for [m/s^2]",
        minimum=0.0,
        maximum=5.0,
        changeable=Changeable.RUNNING,
    )
    rolling_resistance: float = RESISTANCE_SETTING
    resistance_adaptation: float = setting(
        2.0,
        "how quickly the compensated resistance grows while the ball lags behind a moving reference [1/(m s)]",
        minimum=0.0,
        maximum=20.0,
        changeable=Changeable.RUNNING,
    )
    lever_arm_m: float = LEVER_ARM_SETTING

    def __post_init__(self) -> None:
        validate(self)


class Ball(NamedTuple):
    """Where the ball is: position [m] and velocity [m/s] in the skin's frame, as the estimator gives them."""

    x_m: float
    y_m: float
    vx_m_s: float
    vy_m_s: float


@dataclass
class PidState:
    """What the law remembers.

    Attributes
    ----------
    integral_x_m_s2, integral_y_m_s2 : float
        The integral's part of the wanted acceleration [m/s^2].
    saturated : bool
        Whether the tilt was limited.
    resistance : float
        Coefficient of rolling resistance that is compensated, as adapted.
    """

    integral_x_m_s2: float = 0.0
    integral_y_m_s2: float = 0.0
    saturated: bool = False
    resistance: float = 0.0


class BallPid:
    """The control law.

    Parameters
    ----------
    config : PidConfig
    max_tilt_rad : float
        Where the tilt is limited [rad].

    Attributes
    ----------
    config, max_tilt_rad
        May be changed between two steps.
    state : PidState
        Changed in place by `step`.
    """

    def __init__(self, config: PidConfig, max_tilt_rad: float) -> None:
        self.config = config
        self.max_tilt_rad = max_tilt_rad
        self.state = PidState(resistance=config.rolling_resistance)

    def reset(self) -> None:
        """Forget the past, except for how hard the ball rolls."""
        self.state = PidState(resistance=self.state.resistance)

    def step(self, ball: Ball, reference: Reference, tilt: tuple[float, float], dt: float) -> tuple[float, float]:
        """One control step.

        Parameters
        ----------
        ball : Ball
            The estimate, for now.
        reference : Reference
            For now.
        tilt : (float, float)
            Tilt the plate has about the skin's x and y axes [rad].
        dt : float
            Time since the last step [s].

        Returns
        -------
        tilt_x_rad, tilt_y_rad : float
            Tilt to aim for [rad].
        """
        config, state = self.config, self.state
        # What was integrated before ki was set to 0, or the limit was lowered, ends with it.
        most = config.max_integral_m_s2 if config.ki > 0.0 else 0.0
        state.integral_x_m_s2 = _within(state.integral_x_m_s2, most)
        state.integral_y_m_s2 = _within(state.integral_y_m_s2, most)
        speed = hypot(reference.vx_m_s, reference.vy_m_s)
        push = resistance_per_speed(state.resistance, speed)
        resist_x, resist_y = push * reference.vx_m_s, push * reference.vy_m_s
        error_x, error_y = reference.x_m - ball.x_m, reference.y_m - ball.y_m
        # L/g: 5/7 L lean is this times the acceleration that the lean causes.
        lever = config.lever_arm_m / GRAVITY_M_S2
        now_x, now_y = acceleration_of(*tilt)
        ez_x = error_x + lever * (reference.ax_m_s2 + resist_x - now_x)
        ez_y = error_y + lever * (reference.ay_m_s2 + resist_y - now_y)
        ev_x = reference.vx_m_s + lever * reference.jx_m_s3 - ball.vx_m_s
        ev_y = reference.vy_m_s + lever * reference.jy_m_s3 - ball.vy_m_s
        ax = reference.ax_m_s2 + resist_x + config.kp * ez_x + config.kd * ev_x
        ay = reference.ay_m_s2 + resist_y + config.kp * ez_y + config.kd * ev_y
        ax += state.integral_x_m_s2
        ay += state.integral_y_m_s2
        wanted = tilt_for(ax, ay, self.max_tilt_rad)
        state.saturated = hypot(*wanted) >= self.max_tilt_rad * (1.0 - 1e-9)
        # Anti-windup: no integration where the plate cannot follow or the ball is still far away.
        if not state.saturated and hypot(error_x, error_y) < config.integral_zone_m:
            state.integral_x_m_s2 = _within(state.integral_x_m_s2 + config.ki * error_x * dt, most)
            state.integral_y_m_s2 = _within(state.integral_y_m_s2 + config.ki * error_y * dt, most)
            if speed > RESISTANCE_SPEED_M_S:
                lag = (error_x * reference.vx_m_s + error_y * reference.vy_m_s) / speed
                state.resistance = min(
                    max(state.resistance + config.resistance_adaptation * lag * dt, 0.0), _MOST_RESISTANCE
                )
        return wanted


def _within(value: float, most: float) -> float:
    return min(max(value, -most), most)
