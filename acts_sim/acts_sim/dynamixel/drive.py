# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Position control of a motor with a limit on the current, and the resulting torque.

Gains are as in the e-manual: KP = P / 128, KI = I / 65536, KD = D / 16, on the error in pulses. The manual does not
give the unit of the sum; here it is mA, with time in ms, so that P = 600 reaches a limit of 350 mA at 75 pulses or
6.6 degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from acts_sim.dynamixel.control_table import TICKS_PER_TURN, Model

RAD_PER_TICK = 2.0 * math.pi / TICKS_PER_TURN
RAD_S_PER_VELOCITY_UNIT = 0.229 * 2.0 * math.pi / 60.0
# 214.577 turns/min^2 a unit.
_TICKS_S2_PER_ACCELERATION_UNIT = 214.577 / 3600.0 * TICKS_PER_TURN
_TICKS_S_PER_VELOCITY_UNIT = RAD_S_PER_VELOCITY_UNIT / RAD_PER_TICK


@dataclass
class Shaft:
    """Angle and velocity of the motor, set by the mechanics [rad, rad/s]; 0 rad is pulse 0."""

    position_rad: float = math.pi
    velocity_rad_s: float = 0.0


class Trajectory:
    """Profile from one goal to the next, limited in velocity and acceleration (0: no limit)."""

    def __init__(self, ticks: float) -> None:
        self.ticks = ticks
        self.ticks_s = 0.0

    def reset(self, ticks: float) -> None:
        """Start at rest at a position [pulses]."""
        self.ticks, self.ticks_s = ticks, 0.0

    def advance(self, goal_ticks: float, profile_velocity: int, profile_acceleration: int, dt_s: float) -> float:
        """Advance by `dt_s` and return the position of the profile [pulses]."""
        distance = goal_ticks - self.ticks
        if profile_velocity == 0 or distance == 0.0:
            self.reset(goal_ticks)
            return self.ticks
        speed = profile_velocity * _TICKS_S_PER_VELOCITY_UNIT
        if profile_acceleration:
            rate = profile_acceleration * _TICKS_S2_PER_ACCELERATION_UNIT
            # At most the speed from which it can still stop at the goal.
            speed = min(speed, abs(self.ticks_s) + rate * dt_s, math.sqrt(2.0 * rate * abs(distance)) + rate * dt_s)
        step = min(speed * dt_s, abs(distance))
        self.ticks_s = math.copysign(speed, distance)
        self.ticks += math.copysign(step, distance)
        return self.ticks


class PositionControl:
    """PID control of the position, in mA, with a limit on the current."""

    def __init__(self) -> None:
        self._integral = 0.0
        self._last_error: float | None = None

    def reset(self) -> None:
        """Clear the integral and the last error."""
        self._integral, self._last_error = 0.0, None

    def current_ma(self, error_ticks: float, gains: tuple[int, int, int], cap_ma: float, dt_s: float) -> float:
        """Desired current [mA], with `gains` P, I and D as in the control table."""
        p, i, d = gains
        change = 0.0 if self._last_error is None else (error_ticks - self._last_error) / (1e3 * dt_s)
        self._last_error = error_ticks
        integral = self._integral + error_ticks * dt_s * 1e3
        wanted = p / 128.0 * error_ticks + i / 65536.0 * integral + d / 16.0 * change
        if abs(wanted) < cap_ma or wanted * error_ticks < 0.0:
            self._integral = integral  # anti-windup: only while the current is below its limit
        return min(max(wanted, -cap_ma), cap_ma)


def torque_nm(model: Model, current_ma: float, velocity_rad_s: float, duty: float = 1.0) -> tuple[float, float]:
    """Actual current [mA] and its torque [N m]; the duty of the voltage and the back-EMF at speed limit the current."""
    room = duty - math.copysign(1.0, current_ma) * velocity_rad_s / model.no_load_speed_rad_s
    largest = model.stall_current_ma * min(max(room, 0.0), 1.0)
    flowing = math.copysign(min(abs(current_ma), largest), current_ma)
    return flowing, flowing * model.stall_torque_nm / model.stall_current_ma
