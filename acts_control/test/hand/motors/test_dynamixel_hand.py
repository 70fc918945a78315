# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The LEAP hand's motors through the real `dynamixel_sdk`, on the simulated bus behind a pseudo-terminal."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from dynamixel_bus import DEADLINE_S, Bus, leave_at, reading_where
from dynamixel_sdk import COMM_RX_TIMEOUT, Protocol2PacketHandler
from waiting import wait_for

from acts_control.hand.description import LEAP_RIGHT, HandDescription, Joint
from acts_control.hand.motors import DynamixelConfig, DynamixelHand, HandError, HandLostError
from acts_control.hand.motors.dynamixel_port import DynamixelPort
from acts_control.hand.motors.dynamixel_table import TORQUE, Register
from acts_core.errors import SettingsError

pytestmark = pytest.mark.slow

HELD = rf"is held by .*process {os.getpid()}\b.*obeys one program"


def test_the_hand_is_found_enabled_moved_and_released(bus: Bus) -> None:
    hand = bus.hand()
    assert hand.connect() == []
    assert {motor["torque_enable"] for motor in bus.motors()} == {0}
    assert {motor["operating_mode"] for motor in bus.motors()} == {5}
    hand.enable()
    at_first = hand.read()
    assert at_first.q_rad == pytest.approx([0.0] * 16, abs=0.01)  # motors open at pi
    assert at_first.faults == ("",) * 16
    wanted = [0.1 + 0.02 * k for k in range(16)]
    hand.command(wanted)
    reached = reading_where(
        hand, lambda it: it.q_rad == pytest.approx(wanted, abs=0.02) and max(map(abs, it.qd_rad_s)) == 0.0
    )
    assert len(reached.current_ma) == 16
    hand.release()
    assert {motor["torque_enable"] for motor in bus.motors()} == {0}
    hand.close()


def test_torque_that_a_crashed_program_left_on_is_no_obstacle(bus: Bus) -> None:
    first = bus.hand()
    first.connect()
    first.enable()
    first.close()
    assert {motor["torque_enable"] for motor in bus.motors()} == {1}
    second = bus.hand(max_current_ma=200)
    assert second.connect() == []
    assert {(motor["torque_enable"], motor["goal_current"]) for motor in bus.motors()} == {(0, 200)}
    second.close()


def test_goals_are_clipped_and_what_is_not_finite_is_never_sent(bus: Bus) -> None:
    hand = bus.hand()
    hand.connect()
    hand.enable()
    for angles in ([math.nan] * 16, [0.0] * 15, [0.0] * 15 + [math.inf]):
        with pytest.raises(HandError, match="16 finite numbers"):
            hand.command(angles)
    assert {motor["goal_position"] for motor in bus.motors()} == {2048}
    hand.command([100.0] * 16)
    hand.read()  # behind the command on the bus
    for motor, joint in zip(bus.motors(), LEAP_RIGHT.joints, strict=True):
        assert motor["goal_position"] == round((math.pi + joint.upper_rad) * 4096 / math.tau)
    hand.close()


def test_missing_motors_are_named(bus: Bus) -> None:
    bus.command("lose 3")
    bus.command("lose 12")
    with pytest.raises(HandError, match=r"motors 3 \(index_dip\), 12 \(thumb_cmc\) do not answer"):
        bus.hand().connect()


def test_an_overload_is_read_and_recovered_by_starting_anew(bus: Bus) -> None:
    hand = bus.hand()
    hand.connect()
    hand.enable()
    bus.command("overload 6")
    reading = hand.read()
    assert [k for k, fault in enumerate(reading.faults) if fault] == [6]
    assert reading.faults[6] == "overload"
    hand.recover(6)
    assert hand.read().faults == ("",) * 16
    hand.enable()
    motor = bus.motors()[6]
    assert (motor["torque_enable"], motor["operating_mode"], motor["goal_current"]) == (1, 5, 350)
    hand.close()


def test_a_motor_that_fails_as_the_torque_comes_on_ends_nothing(bus: Bus, monkeypatch: pytest.MonkeyPatch) -> None:
    hand = bus.hand()
    hand.connect()
    write = hand._port.write

    def another_fails(joint: Joint, register: Register, value: int) -> None:
        if (joint, register) == (LEAP_RIGHT.joints[4], TORQUE):
            bus.command("overload 6")
        write(joint, register, value)

    monkeypatch.setattr(hand._port, "write", another_fails)
    hand.enable()
    assert [(k, fault) for k, fault in enumerate(hand.read().faults) if fault] == [(6, "overload")]
    assert [k for k, motor in enumerate(bus.motors()) if not motor["torque_enable"]] == [6]
    hand.close()


def test_a_motor_that_had_switched_itself_off_is_told_by_the_first_reading(bus: Bus) -> None:
    bus.command("overheat 9")
    hand = bus.hand()
    assert hand.connect() == []
    assert [(k, fault) for k, fault in enumerate(hand.read().faults) if fault] == [(9, "overheating")]
    hand.recover(9)
    assert hand.read().faults == ("",) * 16
    motor = bus.motors()[9]
    assert (motor["operating_mode"], motor["goal_current"], motor["torque_enable"]) == (5, 350, 0)
    hand.close()


def test_a_motor_that_is_lost_while_it_moves_is_an_error_and_comes_back(bus: Bus) -> None:
    hand = bus.hand()
    hand.connect()
    bus.command("lose 5")
    with pytest.raises(HandError, match="the motors did not answer"):
        hand.read()
    with pytest.raises(HandError, match=r"motors 5 \(middle_mcp_forward\) did not answer when they were switched off"):
        hand.release()
    bus.command("find 5")
    reading_where(hand, lambda it: len(it.q_rad) == 16)
    hand.close()


def test_a_cable_torn_off_is_told_and_the_hand_connects_again(bus: Bus) -> None:
    hand = bus.hand()
    hand.connect()
    bus.command("unplug")
    with pytest.raises(HandLostError, match="is the cable plugged in"):
        hand.read()
    with pytest.raises(HandLostError, match="not connected"):
        hand.command([0.0] * 16)
    # Nobody else gets the hand meanwhile.
    with pytest.raises(HandError, match=HELD):
        bus.hand().connect()
    with pytest.raises(HandError, match="is not there; plug the hand in"):
        hand.connect()
    bus.command("plug_in")
    assert hand.connect() == []
    hand.enable()
    assert hand.read().faults == ("",) * 16
    hand.close()


def test_motors_stop_by_themselves_when_they_hear_nothing(bus: Bus) -> None:
    hand = bus.hand(motor_watchdog_s=0.1)
    hand.connect()
    hand.enable()
    hand.command([0.3] * 16)
    wait_for(lambda: {motor["bus_watchdog"] for motor in bus.motors()} == {255}, timeout_s=DEADLINE_S)

    def set_going() -> None:
        hand.enable()
        hand.command([0.1] * 16)

    def are_there() -> bool:
        reading = hand.read()
        if reading.is_stopped:  # again, for this machine stood still
            set_going()
        return reading.q_rad == pytest.approx([0.1] * 16, abs=0.02)

    set_going()
    wait_for(are_there, timeout_s=DEADLINE_S)
    hand.close()


def test_motors_that_their_watchdog_has_stopped_are_set_up_anew(bus: Bus) -> None:
    first = bus.hand(motor_watchdog_s=0.1)
    first.connect()
    first.enable()
    wait_for(lambda: {motor["bus_watchdog"] for motor in bus.motors()} == {255}, timeout_s=DEADLINE_S)
    first.close()
    second = bus.hand(motor_watchdog_s=0.1, max_current_ma=200)
    second.connect()
    assert {(motor["bus_watchdog"], motor["goal_current"]) for motor in bus.motors()} == {(0, 200)}
    second.enable()
    second.close()


def test_motors_that_nothing_stops_when_the_program_dies_are_told(bus: Bus) -> None:
    hand = bus.hand(motor_watchdog_s=0.0)
    assert hand.connect() == ["motor_watchdog_s is 0: nothing stops the motors when this program hangs or dies"]


def test_the_return_delay_is_told_and_set_where_that_is_wanted(tmp_path: Path) -> None:
    bus = Bus(tmp_path, "--return-delay", "250")
    try:
        hand = bus.hand()
        assert ["16 motors wait before they answer" in told for told in hand.connect()] == [True]
        hand.close()
        hand = bus.hand(set_return_delay=True)
        assert hand.connect() == ["the return delay of 16 motors has been set to 0 in their EEPROM"]
        hand.close()
        assert bus.hand().connect() == []
    finally:
        bus.close()


def test_a_port_that_is_none_and_a_rate_nobody_knows_are_refused(tmp_path: Path, bus: Bus) -> None:
    missing = r"nothing is not there; plug the hand in or name another port\. (Ports present:|No serial ports)"
    with pytest.raises(HandError, match=missing):
        DynamixelHand(LEAP_RIGHT, DynamixelConfig(port=str(tmp_path / "nothing"))).connect()
    (tmp_path / "file").touch()
    with pytest.raises(HandError, match="file is no serial port"):
        DynamixelHand(LEAP_RIGHT, DynamixelConfig(port=str(tmp_path / "file"))).connect()
    with pytest.raises(HandError, match="baud = 12345"):
        bus.hand(baud=12345).connect()


def test_a_bus_that_another_program_moves_is_refused_with_its_name_and_goes_on(bus: Bus) -> None:
    first = bus.hand(motor_watchdog_s=0.0)
    first.connect()
    first.enable()
    with pytest.raises(HandError, match=HELD):
        bus.hand().connect()
    first.command([0.1] * 16)
    reading_where(first, lambda reading: reading.q_rad == pytest.approx([0.1] * 16, abs=0.02))
    # While the first one connects anew, nobody else gets the hand.
    first.disconnect()
    with pytest.raises(HandError, match=HELD):
        bus.hand().connect()
    first.connect()
    first.close()
    second = bus.hand()
    second.connect()
    second.close()


def test_a_port_that_has_two_names_is_one_hand_also_while_it_connects_anew(bus: Bus, tmp_path: Path) -> None:
    by_id, device = tmp_path / "by_id", bus.link.resolve()
    by_id.symlink_to(bus.link)
    for name, other_name in ((by_id, device), (device, by_id), (bus.link, by_id)):
        first, second = bus.hand_at(name), bus.hand_at(other_name)
        first.connect()
        with pytest.raises(HandError, match=HELD):
            second.connect()
        first.disconnect()
        with pytest.raises(HandError, match=HELD):
            second.connect()
        first.connect()
        first.close()
        second.connect()
        second.close()


def test_a_name_that_leads_to_a_port_only_later_is_that_port_from_then_on(bus: Bus, tmp_path: Path) -> None:
    by_id, device = tmp_path / "by_id", bus.link.resolve()
    first, second = bus.hand_at(by_id), bus.hand_at(device)
    with pytest.raises(HandError, match="is not there; plug the hand in"):
        first.connect()
    second.connect()
    by_id.symlink_to(device)
    with pytest.raises(HandError, match=HELD):
        first.connect()
    second.close()
    first.connect()
    first.disconnect()
    with pytest.raises(HandError, match=HELD):
        second.connect()
    first.close()


def test_a_hand_that_comes_back_at_another_port_leaves_the_old_one_to_others(bus: Bus, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    other, by_id = Bus(tmp_path / "other"), tmp_path / "by_id"
    try:
        by_id.symlink_to(bus.link.resolve())
        moved = bus.hand_at(by_id)
        moved.connect()
        moved.disconnect()
        by_id.unlink()
        by_id.symlink_to(other.link.resolve())
        moved.connect()
        newcomer = bus.hand_at(bus.link)
        newcomer.connect()
        with pytest.raises(HandError, match=HELD):
            bus.hand_at(other.link).connect()
        newcomer.close()
        moved.close()
    finally:
        other.close()


def test_gains_beyond_what_a_motor_takes_are_refused_with_their_joint() -> None:
    joints = [replace(joint, gain_scale=8.0) if joint.name == "ring_pip" else joint for joint in LEAP_RIGHT.joints]
    hand = replace(LEAP_RIGHT, joints=tuple(joints))
    for name in ("position_p_gain", "position_d_gain"):
        told = f"joint ring_pip: {name} 9000 times gain_scale 8 is 72000; a motor takes 0 to 16383"
        gain: dict[str, Any] = {name: 9000}
        with pytest.raises(SettingsError, match=told):
            DynamixelHand(hand, DynamixelConfig(**gain))
    DynamixelHand(hand, DynamixelConfig(position_p_gain=2047, position_i_gain=16383))


def test_a_joint_beyond_its_limit_stays_there_until_it_is_sent_back_and_does_not_jump(bus: Bus) -> None:
    leave_at(bus, 2.7)
    hand = bus.hand()
    hand.connect()
    hand.enable()

    def goals_rad() -> list[float]:
        hand.read()  # behind the command on the bus
        return [motor["goal_position"] * math.tau / 4096 - math.pi for motor in bus.motors()]

    assert goals_rad() == pytest.approx([2.7] * 16, abs=0.02)
    for angle_rad in (2.6, 2.5):  # beyond the limits of all joints
        hand.command([angle_rad] * 16)
        assert goals_rad() == pytest.approx([angle_rad] * 16, abs=0.001)
    hand.command([2.7] * 16)
    assert goals_rad() == pytest.approx([2.5] * 16, abs=0.001)
    hand.command([0.5] * 16)
    hand.command([2.7] * 16)
    assert goals_rad() == pytest.approx([joint.upper_rad for joint in LEAP_RIGHT.joints], abs=0.001)
    hand.close()


def test_motors_that_hear_but_cannot_answer_are_switched_off_too(bus: Bus, monkeypatch: pytest.MonkeyPatch) -> None:
    first = bus.hand()
    first.connect()
    first.enable()
    first.disconnect()
    ask = Protocol2PacketHandler.txRxPacket

    def unheard(packets: Any, port: Any, packet: Any) -> Any:
        if packet[4] != 7:  # the ID
            return ask(packets, port, packet)
        packets.txPacket(port, packet)
        port.is_using = False
        return None, COMM_RX_TIMEOUT, 0

    monkeypatch.setattr(Protocol2PacketHandler, "txRxPacket", unheard)
    with pytest.raises(HandError, match=r"motors 7 \(middle_dip\) do not answer"):
        first.connect()
    assert {motor["torque_enable"] for motor in bus.motors()} == {0}
    first.close()


def test_a_release_waits_for_no_silent_motor_before_the_others_are_off(
    bus: Bus, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand = bus.hand()
    hand.connect()
    hand.enable()
    bus.command("lose 0")
    write, seen = DynamixelPort.write, []

    def noted(port: DynamixelPort, joint: Joint, register: Register, value: int) -> None:
        seen.append([motor["torque_enable"] for motor in bus.motors()])
        write(port, joint, register, value)

    monkeypatch.setattr(DynamixelPort, "write", noted)
    with pytest.raises(HandError, match=r"motors 0 \(index_mcp_side\) did not answer"):
        hand.release()
    assert seen[0] == [1, *[0] * 15]
    bus.command("find 0")
    hand.release()


@pytest.mark.parametrize("port", ["/dev/ptmx", "/dev/zero", "/dev/null", "/", "/etc/hostname"])
def test_what_is_no_port_is_refused(port: str) -> None:
    with pytest.raises(HandError, match=port):
        DynamixelHand(LEAP_RIGHT, DynamixelConfig(port=port)).connect()


@pytest.mark.parametrize(
    "change",
    [
        {"lower_rad": 1.0},
        {"upper_rad": math.nan},
        {"direction": 0},
        {"motor_id": 253},
        {"gain_scale": 0.0},
    ],
)
def test_a_joint_that_cannot_be_is_refused(change: dict[str, Any]) -> None:
    values: dict[str, Any] = {"name": "a", "motor_id": 0, "lower_rad": -1.0, "upper_rad": 1.0, **change}
    with pytest.raises(SettingsError, match="joint a"):
        Joint(**values)


def test_no_two_joints_share_a_motor() -> None:
    with pytest.raises(SettingsError, match="may occur twice"):
        HandDescription("hand", (Joint("a", 1, 0.0, 1.0), Joint("b", 1, 0.0, 1.0)))
