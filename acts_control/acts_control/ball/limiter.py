# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Follow a wanted tilt no faster and no harder than allowed."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, hypot, isfinite, sqrt

from acts_control.robots.base import TiltLimits
from acts_core.settings import setting, validate

_LEVEL_RAD = 1e-6
_STILL_RAD_S = 1e-3
_ROUNDING = 1e-9


@dataclass(frozen=True)
class LimiterConfig(TiltLimits):
    """How far, how fast and how hard the plate may be tilted."""

    max_tilt_acceleration_rad_s2: float = setting(
        20.0, "largest acceleration of the tilt about each axis [rad/s^2]", minimum=0.1, maximum=40.0
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass
class LimiterState:
    """Tilt that is commanded [rad] and its rate [rad/s], about the skin's x and y axes."""

    tilt_x_rad: float = 0.0
    tilt_y_rad: float = 0.0
    rate_x_rad_s: float = 0.0
    rate_y_rad_s: float = 0.0


class TiltLimiter:
    """Turns steps of the wanted tilt into a motion that a robot can make.

    Attributes
    ----------
    config : LimiterConfig
        May be changed between two steps, but for the acceleration: with less of it, a motion that has begun would not
        end in time.
    state : LimiterState
        Changed in place by `step`; always finite.
    """

    def __init__(self, config: LimiterConfig) -> None:
        self.config = config
        self.state = LimiterState()
        self._farthest_rad = config.max_tilt_rad

    @property
    def is_level(self) -> bool:
        """Whether the commanded tilt is level and at rest."""
        state = self.state
        return max(abs(state.tilt_x_rad), abs(state.tilt_y_rad)) < _LEVEL_RAD and (
            max(abs(state.rate_x_rad_s), abs(state.rate_y_rad_s)) < _STILL_RAD_S
        )

    def step(self, target_x_rad: float, target_y_rad: float, dt: float) -> tuple[float, float]:
        """Move on towards a tilt.

        Parameters
        ----------
        target_x_rad, target_y_rad : float
            Wanted tilt [rad]. A target that is not finite means level.
        dt : float
            Time since the last step [s].

        Returns
        -------
        tilt_x_rad, tilt_y_rad : float
            Tilt to command now [rad].
        """
        if not (isfinite(target_x_rad) and isfinite(target_y_rad)):
            target_x_rad = target_y_rad = 0.0
        share = self.config.max_tilt_rad / max(hypot(target_x_rad, target_y_rad), self.config.max_tilt_rad)
        target_x_rad, target_y_rad = share * target_x_rad, share * target_y_rad
        state = self.state
        x, rate_x = self._axis(state.tilt_x_rad, state.rate_x_rad_s, target_x_rad, dt)
        y, rate_y = self._axis(state.tilt_y_rad, state.rate_y_rad_s, target_y_rad, dt)
        # Each axis ends within the circle, but on the way from one target to another both can be far out at once.
        size, farthest = hypot(x, y), self._bound_rad()
        if size > farthest:
            share = farthest / size
            x, y = x * share, y * share
            rate_x, rate_y = (x - state.tilt_x_rad) / dt, (y - state.tilt_y_rad) / dt
        state.tilt_x_rad, state.tilt_y_rad, state.rate_x_rad_s, state.rate_y_rad_s = x, y, rate_x, rate_y
        return x, y

    def _bound_rad(self) -> float:
        """How far the tilt may be: `max_tilt_rad`; where that has become smaller, the one before until it is kept."""
        limit, state = self.config.max_tilt_rad, self.state
        rate = hypot(state.rate_x_rad_s, state.rate_y_rad_s)
        stops_at = hypot(state.tilt_x_rad, state.tilt_y_rad) + rate**2 / (
            2.0 * self.config.max_tilt_acceleration_rad_s2
        )
        if self._farthest_rad < limit or stops_at <= limit * (1.0 + _ROUNDING):
            self._farthest_rad = limit
        return self._farthest_rad

    def _axis(self, tilt: float, rate: float, target: float, dt: float) -> tuple[float, float]:
        error = target - tilt
        change = self.config.max_tilt_acceleration_rad_s2 * dt
        # The rate from which braking by `change` a step takes n steps and ends at the target: the sum over k of
        # (rate - k change) dt is the error.
        n = max(ceil(0.5 * (sqrt(1.0 + 8.0 * abs(error) / (change * dt)) - 1.0)), 1)
        wanted = min(abs(error) / (n * dt) + 0.5 * (n - 1) * change, self.config.max_tilt_rate_rad_s)
        if error < 0.0:
            wanted = -wanted
        new_rate = min(max(wanted, rate - change), rate + change)
        return tilt + new_rate * dt, new_rate
