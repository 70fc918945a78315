# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm without wires, for tests of the loop that moves it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from acts_control.robots.base import RobotReading
from acts_core.errors import RobotError

DEADLINE_S = 20.0


class ArmInProcess:
    """A plate on two joints that follows at once; notes the calls; can be made to fail."""

    address = "in this process"

    def __init__(self) -> None:
        self.longest_step_rad = math.inf
        self.q = (0.1, 0.0)
        self.calls: list[str] = []
        self.commands: list[tuple[float, float]] = []
        self.connect_errors: list[RobotError] = []
        self.connected = True
        self.stopped = ""
        self.frozen = False
        self.moves = True
        self.refuses: Callable[[], None] | None = None
        # What is asked of it never gets done while set.
        self.is_busy = False
        self._time = itertools.count()
        self._timestamp = 0.0

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        self.calls.append("connect")
        if self.connect_errors:
            raise self.connect_errors.pop(0)

    def read(self) -> RobotReading:
        if not self.frozen:
            self._timestamp = 0.002 * next(self._time)
        return RobotReading(self.connected, self._timestamp, self.q, max(map(abs, self.q)), self.q, self.stopped)

    def begin_levelling(self) -> float:
        self.calls.append("begin_levelling")
        if self.moves:
            self.q = (0.0, 0.0)
        return DEADLINE_S

    def end_levelling(self) -> None:
        self.calls.append("end_levelling")

    def tilt(self, tilt_x_rad: float, tilt_y_rad: float) -> tuple[float, ...]:
        if self.refuses:
            self.refuses()
        self.q = (tilt_x_rad, tilt_y_rad)
        self.commands.append(self.q)
        return self.q

    def end_tilting(self) -> None:
        self.calls.append("end_tilting")

    def release(self) -> None:
        self.calls.append("release")

    def disconnect(self) -> None:
        self.calls.append("disconnect")
