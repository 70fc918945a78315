# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""In which order the torque of Dynamixel motors goes on and off. What is written to their registers is noted."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from acts_control.hand.description import LEAP_RIGHT, Joint
from acts_control.hand.motors import DynamixelConfig, DynamixelHand, HandError
from acts_control.hand.motors import dynamixel_table as table
from acts_control.hand.motors.dynamixel_table import Register

JOINTS = LEAP_RIGHT.joints
WHERE_TICKS = 2100


class NotedPort:
    """Registers of motors, without a bus; a write of `refused` fails."""

    def __init__(self) -> None:
        self.written: list[tuple[int, Register, int]] = []
        self.refused: tuple[int, Register, int] | None = None
        self.values: dict[tuple[int, Register], int] = {}

    def write(self, joint: Joint, register: Register, value: int) -> None:
        if (joint.motor_id, register, value) == self.refused:
            raise HandError(f"motor {joint.motor_id} refuses")
        self.written.append((joint.motor_id, register, value))
        self.values[joint.motor_id, register] = value

    def read(self, joint: Joint, register: Register) -> int:
        return self.values.get((joint.motor_id, register), WHERE_TICKS if register == table.POSITION else 0)

    def send(self, register: Register, values: Mapping[int, int]) -> None:
        for motor_id, value in values.items():
            self.written.append((motor_id, register, value))
            self.values[motor_id, register] = value

    def torques(self) -> list[int]:
        return [self.values.get((joint.motor_id, table.TORQUE), 0) for joint in JOINTS]


def hand_at(port: NotedPort, monkeypatch: pytest.MonkeyPatch, **settings: float) -> DynamixelHand:
    hand = DynamixelHand(LEAP_RIGHT, DynamixelConfig(**settings))  # type: ignore[arg-type]
    monkeypatch.setattr(hand, "_port", port)
    return hand


@pytest.mark.parametrize(
    ("watchdog_s", "meanwhile", "units"),
    # Its unit is 20 ms; less than one would be none.
    [(0.2, 127, 10), (0.05, 127, 3), (0.001, 127, 1), (0.0, 0, 0)],
)
def test_a_motor_gets_torque_only_once_it_can_press_no_harder_than_allowed_and_holds_where_it_is(
    monkeypatch: pytest.MonkeyPatch, watchdog_s: float, meanwhile: int, units: int
) -> None:
    port = NotedPort()
    hand_at(port, monkeypatch, max_current_ma=200, motor_watchdog_s=watchdog_s).enable()
    count = 5 * len(JOINTS)
    assert port.written[:count] == [
        (joint.motor_id, register, value)
        for joint in JOINTS
        for register, value in (
            (table.WATCHDOG, 0),  # one that it has stopped would refuse the goals
            (table.GOAL_CURRENT, 200),
            (table.GOAL_POSITION, WHERE_TICKS),
            (table.TORQUE, 1),
            (table.WATCHDOG, meanwhile),
        )
    ]
    assert port.written[count:] == [(joint.motor_id, table.WATCHDOG, units) for joint in JOINTS]


@pytest.mark.parametrize("refused", [(9, table.TORQUE, 1), (9, table.GOAL_CURRENT, 350), (15, table.WATCHDOG, 127)])
def test_where_a_motor_refuses_what_it_needs_for_torque_all_are_switched_off_again(
    monkeypatch: pytest.MonkeyPatch, refused: tuple[int, Register, int]
) -> None:
    port = NotedPort()
    hand = hand_at(port, monkeypatch)
    port.refused = refused
    with pytest.raises(HandError, match=f"motor {refused[0]} refuses"):
        hand.enable()
    assert (JOINTS[0].motor_id, table.TORQUE, 1) in port.written
    assert port.torques() == [0] * len(JOINTS)


def test_one_that_has_switched_itself_off_is_not_in_the_way_of_the_torque_of_the_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    port = NotedPort()
    port.refused = (9, table.TORQUE, 1)
    port.values[9, table.HARDWARE_ERROR] = 1 << 5
    hand_at(port, monkeypatch).enable()
    assert [joint.motor_id for joint, on in zip(JOINTS, port.torques(), strict=True) if not on] == [9]


def test_a_motor_that_its_watchdog_has_stopped_meanwhile_is_watched_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    port = NotedPort()
    hand = hand_at(port, monkeypatch)
    write, refusals = port.write, [(3, table.WATCHDOG, 10)]

    def stopped(joint: Joint, register: Register, value: int) -> None:
        if (joint.motor_id, register, value) in refusals:
            refusals.clear()
            raise HandError("it takes nothing but 0")
        write(joint, register, value)

    monkeypatch.setattr(port, "write", stopped)
    hand.enable()
    assert refusals == []
    assert port.written[-15:-11] == [
        *[(2, table.WATCHDOG, 10), (3, table.WATCHDOG, 0), (3, table.WATCHDOG, 10), (4, table.WATCHDOG, 10)]
    ]
