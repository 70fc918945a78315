# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Registers of motors read and written through the real `dynamixel_sdk`, on the simulated bus."""

from __future__ import annotations

import itertools
import os
import select
import threading
import time
import tty
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
import serial
from dynamixel_bus import DEADLINE_S, TIMEOUT_MS, Bus, reading_where, torques
from dynamixel_sdk import COMM_RX_TIMEOUT, COMM_SUCCESS, PortHandler
from waiting import wait_for

from acts_control.hand.description import LEAP_RIGHT, Joint
from acts_control.hand.motors import DynamixelConfig, HandError, HandLostError
from acts_control.hand.motors.dynamixel_port import DynamixelPort
from acts_control.hand.motors.dynamixel_table import D_GAIN, GOAL_POSITION, P_GAIN, TORQUE, WATCHDOG_EXPIRED, Register
from acts_sim.dynamixel.packets import PacketReader, encode_status

pytestmark = pytest.mark.slow


def test_a_number_that_does_not_fit_its_register_is_not_sent(bus: Bus) -> None:
    port = DynamixelPort(DynamixelConfig(port=str(bus.link), answer_timeout_ms=TIMEOUT_MS))
    port.open()
    try:
        for number in (-1, 65536):
            told = rf"motor 2 \(index_pip\): {number} does not fit in register 84, which takes 0 to 65535"
            with pytest.raises(HandError, match=told):
                port.write(LEAP_RIGHT.joints[2], P_GAIN, number)
        port.write(LEAP_RIGHT.joints[2], P_GAIN, 16383)
        assert port.read(LEAP_RIGHT.joints[2], P_GAIN) == 16383
    finally:
        port.close()


def test_a_link_that_a_dead_hand_has_left_is_told(bus: Bus, tmp_path: Path) -> None:
    link = tmp_path / "stale"
    link.symlink_to(bus.link.readlink())
    os.utime(link, (0, 0), follow_symlinks=False)
    told = rf"port {link} \(a link to /dev/pts/\d+\) is not there: the link is older .* start the hand again"
    with pytest.raises(HandError, match=told):
        DynamixelPort(DynamixelConfig(port=str(link))).open()
    with pytest.raises(HandError, match="it makes a new terminal each time"):
        DynamixelPort(DynamixelConfig(port="/dev/ptmx")).open()


@pytest.mark.parametrize("looks", range(3))
def test_a_link_that_vanishes_while_it_is_looked_at_ends_nothing(
    bus: Bus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, looks: int
) -> None:
    readlink, link, looked = os.readlink, tmp_path / "adapter", itertools.count()
    link.symlink_to(bus.link.readlink())

    def unplugged_meanwhile(path: str) -> str:
        if path == str(link) and next(looked) == looks:
            link.unlink()
        return readlink(path)

    monkeypatch.setattr(os, "readlink", unplugged_meanwhile)
    with suppress(HandError):
        bus.hand_at(link).connect()
    assert not link.is_symlink()


def test_a_port_whose_name_no_file_can_have_is_told() -> None:
    with pytest.raises(HandError, match=r"port /tmp/x+ cannot be opened: .*File name too long"):
        DynamixelPort(DynamixelConfig(port=f"/tmp/{'x' * 300}")).open()


def test_an_answer_that_came_too_late_is_not_that_of_the_next_request(
    bus: Bus, monkeypatch: pytest.MonkeyPatch
) -> None:
    # As dynamixel_sdk 4.0, which ROS has: it takes nothing out of the port.
    monkeypatch.setattr(PortHandler, "clearPort", lambda port: port.ser.flush())
    port = DynamixelPort(DynamixelConfig(port=str(bus.link), answer_timeout_ms=TIMEOUT_MS))
    port.open()
    try:
        motor = LEAP_RIGHT.joints[2]
        port.write(motor, P_GAIN, 500)
        port.write(motor, D_GAIN, 200)
        line = port._port
        assert line is not None
        # A request whose answer nobody waits for.
        assert port._packets.readTx(line, motor.motor_id, *P_GAIN) == COMM_SUCCESS
        line.is_using = False
        wait_for(lambda: line.ser.in_waiting >= 13, "an answer: 11 bytes, and the value", DEADLINE_S)
        assert port.read(motor, D_GAIN) == 200
    finally:
        port.close()


def test_a_request_that_was_asked_again_and_answered_twice_shifts_no_later_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = {P_GAIN.address: 500, D_GAIN.address: 200}
    adapter, terminal = os.openpty()
    tty.setraw(terminal)

    def serve() -> None:
        reader, asked = PacketReader(), 0
        with suppress(OSError):  # until the test closes the line
            while True:
                for packet in reader.feed(os.read(adapter, 256)):
                    asked += 1
                    register = int.from_bytes(packet.parameters[:2], "little")
                    # The first has no answer in time; nor has a third, where this thread was late for the second.
                    if asked == 1 or (asked > 2 and register == P_GAIN.address):
                        continue
                    value = values[register]
                    answer = encode_status(packet.motor_id, 0, value.to_bytes(2, "little"))
                    os.write(adapter, answer)
                    if asked == 2:
                        # That was the answer to the first request; its own comes once the next one is there, if it is.
                        select.select([adapter], [], [], 0.1)
                        os.write(adapter, answer)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    config = DynamixelConfig(port=os.ttyname(terminal), answer_timeout_ms=TIMEOUT_MS)
    port = DynamixelPort(config)
    port.open()
    waits_s: list[float] = []

    def wait(seconds: float) -> None:
        # A busy machine may bring the answer later than this time, which only has to be the right one.
        waits_s.append(seconds)
        wait_for(lambda: port._port.ser.in_waiting >= 13, "an answer: 11 bytes, and the value", DEADLINE_S)

    try:
        motor = LEAP_RIGHT.joints[2]
        monkeypatch.setattr("acts_control.hand.motors.dynamixel_port.time", SimpleNamespace(sleep=wait))
        assert port.read(motor, P_GAIN) == 500
        assert port.read(motor, D_GAIN) == 200
        assert waits_s == [config.lost_answer_s]
    finally:
        port.close()
        for end in (terminal, adapter):
            os.close(end)
        thread.join(DEADLINE_S)


def test_a_motor_is_recovered_also_where_its_answer_to_that_is_lost(bus: Bus, monkeypatch: pytest.MonkeyPatch) -> None:
    hand = bus.hand()
    hand.connect()
    hand.enable()
    bus.command("overload 6")
    wait_for(lambda: hand.read().faults[6] == "overload", "the fault", DEADLINE_S)
    packets = hand._port._packets
    asked: list[int] = []
    reboot = packets.reboot

    def lost(port: object, motor_id: int) -> tuple[int, int]:
        # The first is lost on its way back; to the others a motor that is starting does not answer.
        if not asked:
            reboot(port, motor_id)
        asked.append(motor_id)
        return COMM_RX_TIMEOUT, 0

    monkeypatch.setattr(packets, "reboot", lost)
    hand.recover(6)
    assert set(asked) == {6}
    assert hand.read().faults == ("",) * 16
    motor = bus.motors()[6]
    assert (motor["torque_enable"], motor["operating_mode"], motor["goal_current"]) == (0, 5, 350)
    assert torques(bus) == {0, 1}
    hand.close()


def test_motors_that_stop_while_the_program_stands_still_as_it_switches_them_on_are_on_in_the_end(
    bus: Bus, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand = bus.hand(motor_watchdog_s=2.54)
    hand.connect()
    write = hand._port.write

    def stand_still_before_the_last(joint: Joint, register: Register, value: int) -> None:
        if (joint, register, value) == (LEAP_RIGHT.joints[-1], TORQUE, 1):
            wait_for(lambda: bus.motors()[0]["bus_watchdog"] == WATCHDOG_EXPIRED, "a motor to stop", DEADLINE_S)
        write(joint, register, value)

    monkeypatch.setattr(hand._port, "write", stand_still_before_the_last)
    hand.enable()
    assert torques(bus) == {1}
    # They obey: one that was stopped takes no goal.
    hand.command([0.2] * 16)
    reading_where(hand, lambda it: min(it.q_rad) > 0.15)
    hand.close()


def test_a_program_that_stood_still_while_it_wrote_has_not_lost_the_port(
    bus: Bus, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, later_s = itertools.count(1), 0.0

    def clock() -> float:
        # It is read at the beginning of a write, and after that.
        nonlocal later_s
        if next(asked) == 2:
            later_s += 5.0
        return time.monotonic() + later_s

    motor = LEAP_RIGHT.joints[2]
    port = DynamixelPort(DynamixelConfig(port=str(bus.link), answer_timeout_ms=TIMEOUT_MS))
    port.open()
    try:
        port.write(motor, P_GAIN, 500)
        monkeypatch.setattr(serial.serialutil.Timeout, "TIME", staticmethod(clock))
        with pytest.raises(HandError, match="nothing could be sent: ") as told:
            port.send(GOAL_POSITION, dict.fromkeys(range(16), 0))
        assert told.type is HandError
        asked = itertools.count(1)
        assert port.read(motor, P_GAIN) == 500
        assert later_s == 10.0
        port.choose([2], *P_GAIN)
        assert port.gather() == [(500).to_bytes(2, "little")]
    finally:
        port.close()


def test_a_motor_whose_power_was_gone_just_before_the_torque_comes_on_presses_no_harder_than_allowed(bus: Bus) -> None:
    hand = bus.hand(max_current_ma=200)
    hand.connect()
    hand._port.reboot(LEAP_RIGHT.joints[5])
    assert bus.motors()[5]["goal_current"] > 1000
    hand.enable()
    assert {(motor["torque_enable"], motor["goal_current"]) for motor in bus.motors()} == {(1, 200)}
    hand.close()


def test_a_port_that_takes_nothing_more_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acts_control.hand.motors.dynamixel_port._WRITE_TIMEOUT_S", 0.2)
    nobody_reads, terminal = os.openpty()
    tty.setraw(terminal)
    port = DynamixelPort(DynamixelConfig(port=os.ttyname(terminal), answer_timeout_ms=TIMEOUT_MS))
    port.open()
    told: list[str] = []

    def send() -> None:
        while not told:
            try:
                port.send(GOAL_POSITION, dict.fromkeys(range(16), 0))
            except HandLostError as error:
                told.append(str(error))
            except HandError:
                continue  # the machine stood still while this wrote, and the port takes more

    # In a thread: it would wait without end.
    thread = threading.Thread(target=send, daemon=True)
    thread.start()
    thread.join(DEADLINE_S)
    try:
        assert told == [f"{os.ttyname(terminal)} is gone (it has taken nothing for 0.2 s); is the cable plugged in?"]
    finally:
        for end in (nobody_reads, terminal):
            os.close(end)
        thread.join(DEADLINE_S)
        port.close()


def test_who_asks_what_sends_without_end_is_told_that_no_motor_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    # As a skin's board, whose port was given for that of the hand.
    is_over, told = threading.Event(), []
    monkeypatch.setattr(serial.Serial, "read", lambda _port, size: b"" if is_over.is_set() else b"\x11" * size)
    nobody_reads, terminal = os.openpty()
    tty.setraw(terminal)
    port = DynamixelPort(DynamixelConfig(port=os.ttyname(terminal), answer_timeout_ms=5.0))
    port.open()

    def ask() -> None:
        try:
            port.ping(LEAP_RIGHT.joints[2])
        except HandError as error:
            told.append(str(error))

    # In a thread: it would wait without end.
    thread = threading.Thread(target=ask, daemon=True)
    thread.start()
    thread.join(DEADLINE_S)
    is_over.set()
    try:
        assert told == ["motor 2 (index_pip) does not answer"]
    finally:
        thread.join(DEADLINE_S)
        port.close()
        for end in (nobody_reads, terminal):
            os.close(end)
