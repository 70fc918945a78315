# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The motors of a simulated hand, set up and sent somewhere as over the bus; for the tests."""

from __future__ import annotations

import math
from collections.abc import Sequence

from acts_sim.dynamixel import RAD_PER_TICK
from acts_sim.hand import HandWorld

# All joints, in the order of the motors, around something that lies on the palm.
AROUND_SPHERE = (*(0.0, 1.3, 1.0, 0.6) * 3, 1.5, 0.0, 0.3, 0.5)


def switch_on(world: HandWorld, cap_ma: int = 350) -> None:
    """Current-based position mode with LEAP's gains, torque on."""
    for motor in world.motors:
        for address, size, value in ((64, 1, 0), (11, 1, 5), (84, 2, 600), (80, 2, 200), (102, 2, cap_ma), (64, 1, 1)):
            assert motor.write(address, value.to_bytes(size, "little")) == 0


def send(world: HandWorld, q_rad: Sequence[float]) -> None:
    """Goals for all joints, in the order of the motors."""
    for motor, angle in zip(world.motors, q_rad, strict=True):
        ticks = round((math.pi + angle) / RAD_PER_TICK)
        assert motor.write(116, ticks.to_bytes(4, "little", signed=True)) == 0


def close(world: HandWorld, q_rad: Sequence[float], steps: int = 500, rest: int = 250) -> None:
    """Close the open hand evenly, then wait."""
    for k in range(steps):
        send(world, [angle * (k + 1) / steps for angle in q_rad])
        world.step()
    for _ in range(rest):
        world.step()
