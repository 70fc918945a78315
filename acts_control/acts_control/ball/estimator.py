# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kalman filter on the centre of pressure: where the ball is and how fast it rolls.

The model is that of the paper's S16: position and velocity along x and y, accelerated by the tilt of the plate. Three
things are added. A rolling ball feels 5/7 of gravity. Rolling resistance slows it. And the plate does not turn about
its own centre but about wrist axes a lever arm L below the ball, so that turning it also carries it sideways under the
ball::

    d2x/dt2 = 5/7 (g lean - L d2lean/dt2) - resistance          lean = tilt_y for x, -tilt_x for y

The filter therefore follows ``z = x + 5/7 L lean``, for which only gravity is left: ``d2z/dt2 = 5/7 g lean``. A
controller of x meets a right half-plane zero at sqrt(g / L), 8 rad/s for the default; z has none. Both axes have the
same noise, so they share one covariance.

How far a centre of pressure is trusted depends on the force found with it: a subsampled frame may hit only the edge of
the contact, and then both are wrong.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import hypot, isfinite, sqrt
from typing import NamedTuple

from acts_control.ball.plate import (
    LEVER_ARM_SETTING,
    RESISTANCE_SETTING,
    ROLLING,
    acceleration_of,
    resistance_per_speed,
)
from acts_core.runtime import Order, StampOrder
from acts_core.settings import Changeable, setting, validate

_NS = 1e-9

# Speeds a ball may have when it is first touched.
_START_SPEED_M_S = 0.3

# How quickly a larger force is believed to be the ball's weight, and a smaller one. Where no message has told of more
# for a while, a hand has pressed and let go: that is believed quickly as well.
_FORCE_RISE_S = 0.1
_FORCE_FALL_S = 5.0
_LARGEST_FALL_S = 0.1
_LARGEST_KEPT_S = 0.5

_MAX_TILTS = 1000

# What is farther away, presses harder or is tilted more than this is no ball on a plate [m, N, rad].
_FARTHEST_M = 1.0
_HARDEST_N = 1000.0
_STEEPEST_RAD = 0.5


@dataclass(frozen=True)
class EstimatorConfig:
    """How far touch is trusted, and for how long the ball may be unseen."""

    measurement_sigma_m: float = setting(
        0.002,
        "standard deviation of the centre of pressure of one frame [m]",
        minimum=1e-5,
        maximum=0.02,
        changeable=Changeable.RUNNING,
    )
    acceleration_noise: float = setting(
        0.02,
        "how much the ball accelerates beside the model, square root of the spectral density [m/s^2/sqrt(Hz)]",
        minimum=1e-5,
        maximum=10.0,
        changeable=Changeable.RUNNING,
    )
    partial_sigma_m: float = setting(
        0.2,
        "standard deviation added where samples met next to nothing of the contact; less where they met more [m]",
        minimum=0.0,
        maximum=1.0,
        changeable=Changeable.RUNNING,
    )
    gate_sigmas: float = setting(
        6.0,
        "a centre of pressure farther from the prediction than this many deviations is left out",
        minimum=1.0,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )
    gate_reset_s: float = setting(
        0.05,
        "when every centre of pressure was left out for this long, the estimate begins anew [s]",
        minimum=0.001,
        maximum=1.0,
        changeable=Changeable.RUNNING,
    )
    lost_after_s: float = setting(
        0.25,
        "without contact for longer than this the prediction is not trusted any more [s]",
        minimum=0.001,
        maximum=2.0,
        changeable=Changeable.RUNNING,
    )
    rolling_resistance: float = RESISTANCE_SETTING
    lever_arm_m: float = LEVER_ARM_SETTING

    def __post_init__(self) -> None:
        validate(self)


class ContactMeasurement(NamedTuple):
    """What one contact message says.

    Attributes
    ----------
    stamp_ns : int
        Time of measurement [ns].
    in_contact : bool
        Whether anything was touched; without it the position is not looked at.
    x_m, y_m : float
        Centre of pressure in the skin's frame [m].
    force_n : float
        Total force of the contact [N]; 0 where it is not known.
    """

    stamp_ns: int
    in_contact: bool
    x_m: float
    y_m: float
    force_n: float = 0.0


@dataclass
class EstimatorState:
    """The estimate, and what was counted on the way.

    Attributes
    ----------
    stamp_ns : int
        Time the estimate holds for: the newest accepted message [ns].
    valid : bool
        Whether position and velocity may be used; they are 0 otherwise.
    x_m, y_m : float
        Position in the skin's frame [m].
    vx_m_s, vy_m_s : float
        Velocity in the skin's frame, without the part that the plate has by turning under the ball: dz/dt [m/s]. It is
        the velocity of the ball against the plate while that keeps its tilt.
    sigma_m : float
        One standard deviation of the position along each axis [m].
    received, without_contact, outliers, not_finite, implausible, out_of_order, restarts : int
        Messages of all kinds; those without contact; outside the gate; with a NaN or infinity; with a place or force
        that no ball on a plate has; repeated, late or of another clock (see `StampOrder`); and how often the
        estimate began anew.
    """

    stamp_ns: int = 0
    valid: bool = False
    x_m: float = 0.0
    y_m: float = 0.0
    vx_m_s: float = 0.0
    vy_m_s: float = 0.0
    sigma_m: float = 0.0
    received: int = 0
    without_contact: int = 0
    outliers: int = 0
    not_finite: int = 0
    implausible: int = 0
    out_of_order: int = 0
    restarts: int = 0


class BallEstimator:
    """Follows one ball.

    Attributes
    ----------
    config : EstimatorConfig
        May be changed between two steps, but for the lever arm.
    state : EstimatorState
        Changed in place by `step`.
    """

    def __init__(self, config: EstimatorConfig) -> None:
        self.config = config
        self.state = EstimatorState()
        self._lever = ROLLING * config.lever_arm_m
        self._order = StampOrder()
        self._contact_ns = 0
        # The filter's own position and velocity along x and y, and its covariance.
        self._zx = self._zy = self._wx = self._wy = 0.0
        self._pzz = self._pzw = self._pww = 0.0
        self._lean_x = self._lean_y = 0.0
        # Newest last; bounded, in case tilts come without contacts.
        self._tilts: deque[tuple[int, float, float]] = deque(maxlen=_MAX_TILTS)
        self._usual_force = 0.0
        # The largest force since `_kept_ns`, and of the `_LARGEST_KEPT_S` before that.
        self._kept_ns = 0
        self._largest_force = self._largest_force_before = 0.0

    def set_tilt(self, stamp_ns: int, tilt_x_rad: float, tilt_y_rad: float) -> None:
        """Tell the tilt of the plate; before the first it is taken to be level.

        Parameters
        ----------
        stamp_ns : int
            When it was measured [ns]. Contacts come later than tilts: each is given the tilt of its own time.
        tilt_x_rad, tilt_y_rad : float
            Rotation vector about the skin's x and y axes [rad]. Ignored when not finite, or steeper than any plate.
        """
        # Not by "greater": nothing is greater than NaN.
        if not hypot(tilt_x_rad, tilt_y_rad) <= _STEEPEST_RAD:
            return
        tilts = self._tilts
        # Tilts come in order. What was stamped later than this one was stamped by a clock that has been set back since.
        while tilts and tilts[-1][0] >= stamp_ns:
            tilts.pop()
        tilts.append((stamp_ns, tilt_y_rad, -tilt_x_rad))

    def step(self, measurement: ContactMeasurement) -> None:
        """Update by one contact message."""
        state = self.state
        state.received += 1
        stamp_ns, in_contact, x, y, force = measurement
        if in_contact and not (isfinite(x) and isfinite(y) and isfinite(force)):
            state.not_finite += 1
            return
        if in_contact and not (max(abs(x), abs(y)) <= _FARTHEST_M and 0.0 <= force <= _HARDEST_N):
            state.implausible += 1
            return
        order = self._order.step(stamp_ns)
        if order is Order.STRAY:
            state.out_of_order += 1
            return
        if order is Order.ANEW and stamp_ns <= state.stamp_ns:
            # Forwards it is like a gap, see below.
            state.valid = False
        dt = (stamp_ns - state.stamp_ns) * _NS
        state.stamp_ns = stamp_ns
        if state.valid and (stamp_ns - self._contact_ns) * _NS > self.config.lost_after_s:
            state.valid = False
        tilts = self._tilts
        while tilts and tilts[0][0] <= stamp_ns:
            _, self._lean_x, self._lean_y = tilts.popleft()
        if state.valid:
            self._predict(dt)
        if not in_contact:
            state.without_contact += 1
        else:
            zx, zy = x + self._lever * self._lean_x, y + self._lever * self._lean_y
            if not state.valid:
                # What was felt before need not have been this ball: a hand may have pressed harder than it weighs.
                self._usual_force = self._largest_force = self._largest_force_before = 0.0
                self._kept_ns = stamp_ns
            variance = self._variance(force, stamp_ns, dt if state.valid else 0.0)
            if not state.valid or not self._correct(zx, zy, variance, stamp_ns):
                self._restart(zx, zy, variance, stamp_ns)
        self._publish()

    def _variance(self, force: float, stamp_ns: int, dt: float) -> float:
        """Variance of a centre of pressure along each axis [m^2], from how much of the contact was seen.

        Where a frame's samples hit only the edge of the contact, its centre is drawn there and its force is too small:
        smaller than others of the last moments. The usual force is followed quickly upwards and slowly downwards, but
        never stays above all of those. No single message raises it by much.
        """
        if stamp_ns - self._kept_ns > _LARGEST_KEPT_S / _NS:
            self._kept_ns, self._largest_force_before, self._largest_force = stamp_ns, self._largest_force, 0.0
        self._largest_force = max(self._largest_force, force)
        largest = max(self._largest_force, self._largest_force_before)
        usual = self._usual_force
        if force > usual:
            usual = usual + min(force - usual, usual) * min(dt / _FORCE_RISE_S, 1.0) if usual > 0.0 else force
        elif usual > largest:
            usual += (largest - usual) * min(dt / _LARGEST_FALL_S, 1.0)
        else:
            usual += (force - usual) * min(dt / _FORCE_FALL_S, 1.0)
        self._usual_force = usual
        missing = max(1.0 - force / usual, 0.0) if usual > 0.0 else 0.0
        return self.config.measurement_sigma_m**2 + (missing * self.config.partial_sigma_m) ** 2

    def _restart(self, zx: float, zy: float, variance: float, stamp_ns: int) -> None:
        self._zx, self._zy, self._wx, self._wy = zx, zy, 0.0, 0.0
        self._pzz, self._pzw, self._pww = variance, 0.0, _START_SPEED_M_S**2
        self._contact_ns = stamp_ns
        self.state.valid = True
        self.state.restarts += 1

    def _predict(self, dt: float) -> None:
        ax, ay = acceleration_of(-self._lean_y, self._lean_x)
        slowing = resistance_per_speed(self.config.rolling_resistance, hypot(self._wx, self._wy))
        # Not farther than to rest, however long the step.
        slowing = min(slowing, 1.0 / dt)
        ax, ay = ax - slowing * self._wx, ay - slowing * self._wy
        self._zx += dt * (self._wx + 0.5 * dt * ax)
        self._zy += dt * (self._wy + 0.5 * dt * ay)
        self._wx += dt * ax
        self._wy += dt * ay
        # P <- F P F' + Q with Q that of white acceleration of density q.
        q = self.config.acceleration_noise**2
        self._pzz += dt * (2.0 * self._pzw + dt * (self._pww + q * dt / 3.0))
        self._pzw += dt * (self._pww + 0.5 * q * dt)
        self._pww += q * dt

    def _correct(self, zx: float, zy: float, variance: float, stamp_ns: int) -> bool:
        """Update by a position; False when the estimate no longer has to do with what is touched."""
        ex, ey = zx - self._zx, zy - self._zy
        s = self._pzz + variance
        if ex * ex + ey * ey > self.config.gate_sigmas**2 * s:
            self.state.outliers += 1
            return (stamp_ns - self._contact_ns) * _NS <= self.config.gate_reset_s
        kz, kw = self._pzz / s, self._pzw / s
        self._zx += kz * ex
        self._zy += kz * ey
        self._wx += kw * ex
        self._wy += kw * ey
        self._pww -= kw * self._pzw
        self._pzw -= kz * self._pzw
        self._pzz -= kz * self._pzz
        self._contact_ns = stamp_ns
        return True

    def _publish(self) -> None:
        state = self.state
        if not state.valid:
            state.x_m = state.y_m = state.vx_m_s = state.vy_m_s = state.sigma_m = 0.0
            return
        state.x_m = self._zx - self._lever * self._lean_x
        state.y_m = self._zy - self._lever * self._lean_y
        state.vx_m_s, state.vy_m_s = self._wx, self._wy
        state.sigma_m = sqrt(self._pzz)
