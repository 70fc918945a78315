# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand, on the simulated bus or on made motors."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from dynamixel_bus import DEADLINE_S, Bus
from waiting import wait_for

from acts_control.hand.control import Behaviour, HandLoop, HandLoopConfig, HandPhase
from acts_control.hand.description import LEAP_RIGHT, HandDescription
from acts_control.hand.motors import HandError, HandLostError, HandReading

STALE_S = 1.0
"""How long a command to a made hand counts, and for how long its motors may be silent [s]."""


class Running:
    """A loop on the bus, and what it has logged."""

    def __init__(
        self,
        bus: Bus,
        motor_watchdog_s: float = 0.0,
        behaviour: Behaviour | None = None,
        hand: HandDescription = LEAP_RIGHT,
        **settings: Any,
    ) -> None:
        self.log: list[tuple[str, str]] = []
        self.readings: list[HandReading] = []
        self.may_go_on = threading.Event()
        self.may_go_on.set()
        self.is_held = threading.Event()
        # The motors' own watchdog is off: a loaded machine holds a loop up for longer.
        motors = bus.hand_at(bus.link, hand, motor_watchdog_s=motor_watchdog_s)
        config = HandLoopConfig(**{"silence_s": 2.0, "connect_retry_s": 0.05, **settings})
        self.loop = HandLoop(hand, motors, config, lambda *told: self.log.append(told), self._on_reading, behaviour)
        self.loop.launch()

    def _on_reading(self, reading: HandReading) -> None:
        self.readings.append(reading)
        if not self.may_go_on.is_set():
            self.is_held.set()
        assert self.may_go_on.wait(DEADLINE_S)

    def until(self, condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, state=lambda: (self.loop.status, self.log))

    def enable(self) -> None:
        """Switch the torque on; ask again where that took longer than is waited for."""

        def is_on() -> bool:
            begin_s = time.monotonic()
            told = self.loop.enable()
            assert not told or time.monotonic() - begin_s > 1.9, told
            return not told

        self.until(is_on)

    def until_phase(self, phase: HandPhase) -> None:
        self.until(lambda: self.loop.status.phase is phase)


class Moved:
    """A behaviour that does nothing but remember how it was started."""

    def __init__(self) -> None:
        self.restarts: list[bool] = []

    def restart(self, *, recovered: bool) -> None:
        self.restarts.append(recovered)

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        return goal_rad

    def waited(self, seconds: float) -> None:
        pass

    def sent(self, began_s: float, sent_s: float) -> None:
        pass


class MadeBus:
    """Motors whose answers are made."""

    def __init__(self) -> None:
        self.q_rad = [0.3] * 16
        self.current_ma = [0.0] * 16
        self.faults = [""] * 16
        self.moves_to_rad = self.q_rad
        self.is_there = True
        self.answers = threading.Event()
        self.answers.set()
        self.has_torque = False
        self.sent: list[list[float]] = []
        self.connects = 0
        self.answers_to_lose = 0

    def connect(self) -> list[str]:
        self.connects += 1
        self.has_torque = False
        if not self.is_there:
            raise HandError("nobody is there")
        return []

    def enable(self) -> None:
        # Somebody moves the fingers until they have torque.
        self.q_rad = self.moves_to_rad
        self.has_torque = True

    def release(self) -> None:
        self.has_torque = False

    def read(self) -> HandReading:
        if not self.is_there:
            raise HandLostError("nobody is there any more")
        self.answers.wait(DEADLINE_S)
        if self.answers_to_lose:
            self.answers_to_lose -= 1
            raise HandError("no answer")
        none = (0.0,) * 16
        return HandReading(tuple(self.q_rad), none, tuple(self.current_ma), (30,) * 16, tuple(self.faults))

    def command(self, q_rad: Sequence[float]) -> None:
        self.sent.append(list(q_rad))

    def recover(self, joint: int) -> None:
        self.faults[joint] = ""

    def disconnect(self) -> None:
        pass

    def close(self) -> None:
        pass


Made = tuple[MadeBus, HandLoop, Callable[[Callable[[], bool]], None]]
