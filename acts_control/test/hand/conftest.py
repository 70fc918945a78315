# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of the hand share."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from dynamixel_bus import Bus
from hand_loop_rig import Running


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
