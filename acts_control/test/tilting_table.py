# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated tilting table with a ball on it, for the robot of docs/extending.md. Time passes when somebody sleeps."""

from __future__ import annotations

import random
from collections.abc import Callable

from acts_control.ball import ContactMeasurement
from acts_control.ball.plate import ROLLING, acceleration_of, resistance_per_speed

STEP_S = 0.001
LEVER_ARM_M = 0.06
RESISTANCE = 0.005

_LAG_S = 0.03
_NOISE_M = 0.0008
_FORCE_N = 8.0


class SimulatedTable:
    """Two motors that follow their goals, and a ball that rolls on the plate they turn, of which the skin tells.

    Attributes
    ----------
    is_on, is_gone : bool
        Whether the motors have power, and whether their cable has been pulled.
    is_silent : callable
        Whether the skin says nothing, at a time [s].
    on_contact : callable
        Takes the contacts, one a millisecond.
    """

    START_NS = 1_700_000_000_000_000_000

    def __init__(self, x_m: float = 0.02, y_m: float = -0.015) -> None:
        self.time_s = 0.0
        self.is_on = self.is_gone = False
        self.is_silent: Callable[[float], bool] = lambda _time_s: False
        self.on_contact: Callable[[ContactMeasurement], None] = lambda _contact: None
        self.angles = [0.05, -0.04]
        self.aims: list[tuple[float, float]] = []
        self._goal, self._speed_rad_s = (0.05, -0.04), 0.0
        # Place and speed of the ball without what the plate carries it sideways by turning.
        lean_x, lean_y = self._lean()
        self._z = [x_m + ROLLING * LEVER_ARM_M * lean_x, y_m + ROLLING * LEVER_ARM_M * lean_y]
        self._v = [0.0, 0.0]
        self._random = random.Random(1)

    # --- what the motors' library does

    def switch(self, on: bool) -> None:
        self._reach()
        self.is_on = on

    def clock_s(self) -> float:
        self._reach()
        return self.time_s

    def angles_rad(self) -> tuple[float, float]:
        self._reach()
        return self.angles[0], self.angles[1]

    def aim(self, x_rad: float, y_rad: float, speed_rad_s: float) -> None:
        self._reach()
        self._goal, self._speed_rad_s = (x_rad, y_rad), speed_rad_s
        self.aims.append(self._goal)

    def _reach(self) -> None:
        if self.is_gone:
            raise OSError("no such device")

    # --- time

    def now_ns(self) -> int:
        """The clock of the stamps."""
        return self.START_NS + round(self.time_s * 1e9)

    def steady_s(self) -> float:
        """The clock that waits go by."""
        return self.time_s

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(max(round(seconds / STEP_S), 1)):
            self._step()

    # --- the world

    @property
    def place_m(self) -> tuple[float, float]:
        """Where the ball is on the plate."""
        lean_x, lean_y = self._lean()
        return self._z[0] - ROLLING * LEVER_ARM_M * lean_x, self._z[1] - ROLLING * LEVER_ARM_M * lean_y

    def _lean(self) -> tuple[float, float]:
        return self.angles[1], -self.angles[0]

    def _step(self) -> None:
        self.time_s += STEP_S
        if self.is_on:
            farthest = self._speed_rad_s * STEP_S
            for axis, goal in enumerate(self._goal):
                wanted = STEP_S / _LAG_S * (goal - self.angles[axis])
                self.angles[axis] += min(max(wanted, -farthest), farthest)
        for axis, pull in enumerate(acceleration_of(*self.angles)):
            rolling = resistance_per_speed(RESISTANCE, abs(self._v[axis])) * self._v[axis]
            self._v[axis] += STEP_S * (pull - rolling)
            self._z[axis] += STEP_S * self._v[axis]
        if not self.is_silent(self.time_s):
            x, y = (place + self._random.gauss(0.0, _NOISE_M) for place in self.place_m)
            self.on_contact(ContactMeasurement(self.now_ns(), True, x, y, _FORCE_N))
