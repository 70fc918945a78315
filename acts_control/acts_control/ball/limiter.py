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
_ROUNDING = 1e-10


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
        farthest_rad = self._bound_rad()
        rates = (
            self._rate(target_x_rad - state.tilt_x_rad, state.rate_x_rad_s, dt),
            self._rate(target_y_rad - state.tilt_y_rad, state.rate_y_rad_s, dt),
        )
        # Each axis ends within the circle, but on the way from one target to another both can be far out at once.
        if not self._stops_within(farthest_rad, rates, dt):
            rates = self._straight(target_x_rad - state.tilt_x_rad, target_y_rad - state.tilt_y_rad, dt)
        if not self._stops_within(farthest_rad, rates, dt):
            rates = self._braked(dt)
        state.rate_x_rad_s, state.rate_y_rad_s = rates
        state.tilt_x_rad += rates[0] * dt
        state.tilt_y_rad += rates[1] * dt
        return state.tilt_x_rad, state.tilt_y_rad

    def _bound_rad(self) -> float:
        """How far the tilt may be: `max_tilt_rad`; where that has become smaller, the one before until it is kept."""
        limit, state = self.config.max_tilt_rad, self.state
        if self._farthest_rad < limit or self._stops_within(limit, (state.rate_x_rad_s, state.rate_y_rad_s), 0.0):
            self._farthest_rad = limit
        return self._farthest_rad

    def _stops_within(self, limit_rad: float, rates: tuple[float, float], dt: float) -> bool:
        """Whether a plate that turns at these rates for `dt`, and then brakes, stays this near to level.

        It can brake along a straight line, both axes at rest at the same time. A circle that holds both ends of a line
        holds all of it.
        """
        state, (rate_x, rate_y) = self.state, rates
        # The way to stop from the rate v is v^2 / (2 a) at most, and less in steps, however long they are.
        time_s = dt + 0.5 * max(abs(rate_x), abs(rate_y)) / self.config.max_tilt_acceleration_rad_s2
        stops_at = hypot(state.tilt_x_rad + rate_x * time_s, state.tilt_y_rad + rate_y * time_s)
        return stops_at <= limit_rad * (1.0 + _ROUNDING)

    def _rate(self, error: float, rate: float, dt: float) -> float:
        """The next rate of one axis that is to turn by `error`, as fast as may be."""
        change = self.config.max_tilt_acceleration_rad_s2 * dt
        # The rate from which braking by `change` a step takes n steps and ends at the target: the sum over k of
        # (rate - k change) dt is the error.
        n = max(ceil(0.5 * (sqrt(1.0 + 8.0 * abs(error) / (change * dt)) - 1.0)), 1)
        wanted = min(abs(error) / (n * dt) + 0.5 * (n - 1) * change, self.config.max_tilt_rate_rad_s)
        if error < 0.0:
            wanted = -wanted
        return min(max(wanted, rate - change), rate + change)

    def _straight(self, error_x: float, error_y: float, dt: float) -> tuple[float, float]:
        """The next rates of a plate that is to turn on a straight line: that leaves the circle nowhere."""
        state, config = self.state, self.config
        change = config.max_tilt_acceleration_rad_s2 * dt
        error = max(abs(error_x), abs(error_y))
        # The largest v with v dt + v^2 / (2 a) = error.
        speed = min(
            sqrt(change**2 + 2.0 * config.max_tilt_acceleration_rad_s2 * error) - change, config.max_tilt_rate_rad_s
        )
        share = speed / error if error > 0.0 else 0.0
        change_x, change_y = share * error_x - state.rate_x_rad_s, share * error_y - state.rate_y_rad_s
        share = min(change / max(abs(change_x), abs(change_y), change), 1.0)
        return state.rate_x_rad_s + share * change_x, state.rate_y_rad_s + share * change_y

    def _braked(self, dt: float) -> tuple[float, float]:
        """The next rates of a plate that brakes along a straight line."""
        state = self.state
        change = self.config.max_tilt_acceleration_rad_s2 * dt
        fastest = max(abs(state.rate_x_rad_s), abs(state.rate_y_rad_s), change)
        share = 1.0 - change / fastest
        return share * state.rate_x_rad_s, share * state.rate_y_rad_s
