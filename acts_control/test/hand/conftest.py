# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of the hand share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from dynamixel_bus import DEADLINE_S, Bus
from hand_loop_rig import STALE_S, Made, MadeBus, Running
from waiting import wait_for

from acts_control.hand.control import HandLoop, HandLoopConfig
from acts_control.hand.description import LEAP_RIGHT


@pytest.fixture
def bus(tmp_path: Path) -> Iterator[Bus]:
    bus = Bus(tmp_path)
    yield bus
    bus.close()


@pytest.fixture
def running(bus: Bus) -> Iterator[Running]:
    running = Running(bus)
    yield running
    running.loop.close()
    assert {motor["torque_enable"] for motor in bus.motors()} == {0}


@pytest.fixture
def made() -> Iterator[Made]:
    bus = MadeBus()
    config = HandLoopConfig(autostart=False, silence_s=STALE_S, connect_retry_s=0.05, command_stale_after_s=STALE_S)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, _sentence: None)

    def until(condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, state=lambda: loop.status)

    loop.launch()
    yield bus, loop, until
    loop.close()
