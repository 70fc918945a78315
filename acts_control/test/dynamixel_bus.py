# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated Dynamixel bus as a process, and hands at it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from motor_process import MotorProcess
from waiting import wait_for

from acts_control.hand.description import LEAP_RIGHT, HandDescription
from acts_control.hand.motors import DynamixelConfig, DynamixelHand, HandReading

DEADLINE_S = 30.0
# Half of how long an answer is waited for: a loaded machine is slow.
TIMEOUT_MS = 200.0


class Bus(MotorProcess):
    """The simulated motors."""

    def __init__(self, folder: Path, *options: str) -> None:
        self._hands: list[DynamixelHand] = []
        super().__init__(folder, "acts_sim.dynamixel.main", "--return-delay", "0", *options)

    def motors(self) -> list[dict[str, Any]]:
        return list(json.loads(self.command("state"))["motors"])

    def hand(self, **settings: Any) -> DynamixelHand:
        return self.hand_at(self.link, **settings)

    def hand_at(self, port: Path, hand: HandDescription = LEAP_RIGHT, **settings: Any) -> DynamixelHand:
        """A hand at any name of the port; it is given back in the end, for the next bus gets the same device."""
        # By default motors bear a lost answer, as `DynamixelConfig.check_rate` asks for.
        settings = {"motor_watchdog_s": 1.0, **settings}
        config = DynamixelConfig(port=str(port), answer_timeout_ms=TIMEOUT_MS, **settings)
        self._hands.append(DynamixelHand(hand, config))
        return self._hands[-1]

    def close(self) -> None:
        for hand in self._hands:
            hand.close()
        super().close()


def reading_where(hand: DynamixelHand, condition: Callable[[HandReading], bool]) -> HandReading:
    read = [hand.read()]
    wait_for(lambda: condition(read[-1]), "a reading", DEADLINE_S, lambda: read.append(hand.read()), lambda: read[-1])
    return read[-1]


def leave_at(bus: Bus, angle_rad: float) -> None:
    """Another program, which knows wider limits, leaves all joints somewhere, without torque."""
    wide = [replace(joint, upper_rad=2.9) for joint in LEAP_RIGHT.joints]
    config = DynamixelConfig(port=str(bus.link), answer_timeout_ms=TIMEOUT_MS, motor_watchdog_s=1.0)
    hand = DynamixelHand(replace(LEAP_RIGHT, joints=tuple(wide)), config)
    hand.connect()
    hand.enable()
    hand.command([angle_rad] * 16)
    reading_where(hand, lambda it: it.q_rad == pytest.approx([angle_rad] * 16, abs=0.02) and not any(it.qd_rad_s))
    hand.release()
    hand.close()


def torques(bus: Bus) -> set[float]:
    return {motor["torque_enable"] for motor in bus.motors()}
