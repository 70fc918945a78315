# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand whose motors fail, fall silent or lose their power or cable, on the simulated bus."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from functools import partial
from types import SimpleNamespace

import pytest
from dynamixel_bus import DEADLINE_S, Bus, torques
from hand_loop_rig import STALE_S, Made, MadeBus, Moved, Running

from acts_control.hand.control import HandPhase, fault_memory
from acts_control.hand.control.fault_memory import FaultMemory
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import HandError, HandReading

pytestmark = pytest.mark.slow


def test_an_overload_is_recovered_once_and_given_up_the_second_time(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    bus.command("overload 6")
    running.until(lambda: running.loop.status.recovered == 1 and running.loop.status.phase is HandPhase.ENABLED)
    assert torques(bus) == {1}
    bus.command("overload 6")
    running.until_phase(HandPhase.GIVEN_UP)
    assert running.loop.status.reason == "middle_pip: overload, 2 times within a minute; call enable to go on"
    assert torques(bus) == {0}
    running.enable()  # a person has looked after it
    running.until_phase(HandPhase.ENABLED)
    assert torques(bus) == {1}


def test_asking_for_torque_again_and_again_keeps_no_motor_from_being_given_up(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    bus.command("overload 6")
    running.until(lambda: running.loop.status.recovered == 1 and running.loop.status.phase is HandPhase.ENABLED)
    # Nobody has looked after a hand that has torque: as a program does that asks until it is told that it is on.
    assert running.loop.enable() == ""
    bus.command("overload 6")
    running.until(lambda: running.loop.status.phase is HandPhase.GIVEN_UP or running.loop.status.recovered == 2)
    assert running.loop.status.phase is HandPhase.GIVEN_UP
    assert torques(bus) == {0}


def test_a_loop_that_was_held_up_until_the_motors_stopped_moves_them_again(bus: Bus) -> None:
    running = Running(bus, motor_watchdog_s=0.1)
    try:
        running.until_phase(HandPhase.ENABLED)
        running.may_go_on.clear()
        running.until(lambda: {motor["bus_watchdog"] for motor in bus.motors()} == {255})
        running.may_go_on.set()

        def arrived() -> bool:
            running.loop.command({"index_pip": 0.5})
            reading = running.loop.status.reading
            return reading is not None and abs(reading.q_rad[2] - 0.5) < 0.02

        running.until(arrived)
        assert any("watchdog has stopped them" in sentence for _, sentence in running.log)
    finally:
        running.may_go_on.set()
        running.loop.close()
    assert torques(bus) == {0}


def test_a_cable_torn_off_and_put_back_ends_with_an_enabled_hand(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    bus.command("unplug")
    running.until_phase(HandPhase.CONNECTING)
    bus.command("plug_in")
    running.until_phase(HandPhase.ENABLED)
    told = [sentence for level, sentence in running.log if level == "error"]
    # The loop may be about to write, or to read.
    either = ("Input/output error", "it gives nothing more")
    assert {f"{bus.link} is gone ({words}); is the cable plugged in?" for words in either} & set(told)


def test_a_motor_that_falls_silent_is_waited_for_and_named(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    bus.command("lose 14")
    running.until(lambda: "motors 14 (thumb_mcp) do not answer" in running.loop.status.reason)
    assert running.loop.status.unanswered >= 1
    bus.command("find 14")
    running.until_phase(HandPhase.ENABLED)


def test_where_one_motor_is_silent_the_others_are_switched_off(bus: Bus) -> None:
    running = Running(bus)
    try:
        running.until_phase(HandPhase.ENABLED)
        bus.command("lose 14")
        running.until_phase(HandPhase.CONNECTING)
        running.until(lambda: [motor["torque_enable"] for motor in bus.motors()].count(1) == 1)
    finally:
        running.loop.close()
    told = [sentence for level, sentence in running.log if level == "error"]
    assert "not all motors could be switched off: motors 14 (" in told[-1]


def test_who_ends_a_hand_with_a_silent_motor_is_told_to_cut_its_power(bus: Bus) -> None:
    # Motors without a watchdog: nothing stops the silent one.
    running = Running(bus, silence_s=10.0)
    try:
        running.until_phase(HandPhase.ENABLED)
        bus.command("lose 14")
    finally:
        running.loop.close()
    told = [sentence for level, sentence in running.log if level == "error"]
    assert any("14 (thumb_mcp) did not answer when they were switched off; motors that are" in one for one in told)
    assert any("cut their power to be sure" in one for one in told)


def test_an_answer_without_its_data_is_asked_for_again(running: Running, monkeypatch: pytest.MonkeyPatch) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.loop.release()
    running.until_phase(HandPhase.RELEASED)
    packets = running.loop._bus._port._packets  # type: ignore[attr-defined]
    read, broken = packets.read4ByteTxRx, [7, 7]

    def broken_twice(port: object, motor_id: int, address: int) -> object:
        if motor_id in broken:
            broken.remove(motor_id)
            # Beyond its table a motor answers with an error alone, which the library takes for data.
            address = 5000
        return read(port, motor_id, address)

    monkeypatch.setattr(packets, "read4ByteTxRx", broken_twice)
    running.loop.enable()
    running.until_phase(HandPhase.ENABLED)
    assert broken == []


def test_a_motor_whose_power_was_gone_for_a_moment_is_set_up_again(
    bus: Bus, running: Running, monkeypatch: pytest.MonkeyPatch
) -> None:
    running.until_phase(HandPhase.ENABLED)
    hand, read, off = running.loop._bus, running.loop._bus.read, [2]

    def without_power() -> HandReading:
        if off:
            # Its registers are those of a motor that has just started, as after a reboot.
            hand._port.reboot(LEAP_RIGHT.joints[off.pop()])  # type: ignore[attr-defined]
        return read()

    monkeypatch.setattr(hand, "read", without_power)
    running.until(lambda: running.loop.status.recovered == 1 and running.loop.status.phase is HandPhase.ENABLED)
    assert any("index_pip: torque is off" in sentence for _, sentence in running.log)
    assert torques(bus) == {1}


def test_a_motor_whose_power_was_gone_while_the_torque_was_off_is_set_up_before_it_gets_any(
    bus: Bus, running: Running, monkeypatch: pytest.MonkeyPatch
) -> None:
    running.until_phase(HandPhase.ENABLED)
    assert running.loop.release() == ""
    hand, read, off = running.loop._bus, running.loop._bus.read, [2]

    def without_power() -> HandReading:
        if off:
            hand._port.reboot(LEAP_RIGHT.joints[off.pop()])  # type: ignore[attr-defined]
        return read()

    monkeypatch.setattr(hand, "read", without_power)
    running.readings.clear()
    running.until(lambda: not off)
    # Its own limit of the current is several times the hand's.
    running.until(lambda: {motor["goal_current"] for motor in bus.motors()} == {350})
    running.until(lambda: running.loop.status.recovered == 1)
    assert any("index_pip: its settings are gone, as after a loss of power" in told for _, told in running.log)
    assert running.loop.status.phase is HandPhase.RELEASED
    assert torques(bus) == {0}
    # What its registers hold then is no angle, and nobody is told that it were.
    assert {round(reading.q_rad[2], 1) for reading in running.readings} == {0.0}
    running.enable()
    reading = running.loop.status.reading
    assert reading is not None
    assert reading.q_rad[2] == pytest.approx(0.0, abs=0.01)


def test_who_asks_for_a_release_while_a_motor_is_silent_is_told_and_the_others_are_off_at_once(bus: Bus) -> None:
    running = Running(bus, silence_s=10.0)
    try:
        running.until_phase(HandPhase.ENABLED)
        bus.command("lose 14")
        assert "cut their power to be sure" in running.loop.release()
        running.until_phase(HandPhase.CONNECTING)
        # Long before they count as silent.
        assert running.loop.status.unanswered < 5
        assert [motor["torque_enable"] for motor in bus.motors()].count(1) == 1
        assert "motors 14 (thumb_mcp) d" in running.loop.release()
        bus.command("find 14")
        running.until_phase(HandPhase.RELEASED)
        assert running.loop.release() == ""
    finally:
        running.loop.close()
    assert torques(bus) == {0}


def test_a_motor_that_is_found_switched_off_counts_like_one_that_does_it_later(bus: Bus) -> None:
    bus.command("overheat 9")
    running = Running(bus)
    try:
        running.until(lambda: running.loop.status.recovered == 1 and running.loop.status.phase is HandPhase.ENABLED)
        bus.command("unplug")
        running.until_phase(HandPhase.CONNECTING)
        bus.command("overheat 9")
        bus.command("plug_in")
        running.until_phase(HandPhase.GIVEN_UP)
        assert "ring_mcp_forward: overheating, 2 times within a minute" in running.loop.status.reason
        assert torques(bus) == {0}
    finally:
        running.loop.close()


def test_a_motor_that_was_started_anew_while_the_torque_was_off_is_not_told_as_why_it_is_off(
    bus: Bus, running: Running
) -> None:
    running.until_phase(HandPhase.ENABLED)
    assert running.loop.release() == ""
    bus.command("overload 6")
    running.until(lambda: running.loop.status.recovered == 1)
    cycles = running.loop.status.cycles
    running.until(lambda: running.loop.status.cycles > cycles + 5)
    assert (running.loop.status.phase, running.loop.status.reason) == (HandPhase.RELEASED, "released by request")


def test_only_faults_of_one_motor_within_a_minute_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    memory, now_s = FaultMemory(motors=2, most=3), [0.0]
    monkeypatch.setattr(fault_memory, "time", SimpleNamespace(monotonic=lambda: now_s[0]))

    def failed_too_often(motor: int, at_s: float) -> bool:
        now_s[0] = at_s
        return memory.add(motor)

    assert not any(failed_too_often(0, at_s) for at_s in (0.0, 30.0, 61.0))
    assert not failed_too_often(1, 62.0)
    assert failed_too_often(0, 89.0)


def test_faults_may_be_forgotten_just_while_one_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    memory = FaultMemory(motors=1, most=1)

    def count(times_s: Sequence[float]) -> int:
        counted = len(times_s)
        memory.forget()  # as another thread does that asks for torque
        return counted

    monkeypatch.setattr(fault_memory, "len", count, raising=False)
    assert memory.add(0)


def test_a_motor_that_may_not_switch_itself_off_even_once_starts_anew_when_that_is_asked_for(bus: Bus) -> None:
    running = Running(bus, max_faults=1)
    try:
        running.until_phase(HandPhase.ENABLED)
        bus.command("overload 6")
        running.until_phase(HandPhase.GIVEN_UP)
        running.loop.enable()
        running.until_phase(HandPhase.ENABLED)
    finally:
        running.loop.close()


def test_a_hand_that_was_given_up_begins_anew_when_it_is_enabled(bus: Bus) -> None:
    moved = Moved()
    running = Running(bus, behaviour=moved)

    def is_over(restarts: int) -> bool:
        return len(moved.restarts) > restarts or not running.loop._wish.is_on

    try:
        for number in (1, 2):
            running.until_phase(HandPhase.ENABLED)
            bus.command("overload 6")
            running.until(partial(is_over, number))
        running.until_phase(HandPhase.GIVEN_UP)
        running.loop.enable()
        running.until_phase(HandPhase.ENABLED)
        assert moved.restarts == [False, True, False]
    finally:
        running.loop.close()


class HeldReboots:
    """Motors 0 to 3 of a made bus switch themselves off; starting them anew takes as long as the test wants.

    Attributes
    ----------
    had_torque : list of bool
        For each reboot that has begun, whether the others had torque then.
    may_go_on : threading.Event
    """

    def __init__(self, bus: MadeBus, monkeypatch: pytest.MonkeyPatch) -> None:
        self.had_torque: list[bool] = []
        self.may_go_on = threading.Event()
        recover = bus.recover

        def held(joint: int) -> None:
            self.had_torque.append(bus.has_torque)
            assert self.may_go_on.wait(DEADLINE_S)
            recover(joint)

        monkeypatch.setattr(bus, "recover", held)
        bus.faults = ["overload"] * 4 + [""] * 12


@pytest.fixture
def reboots(made: Made, monkeypatch: pytest.MonkeyPatch) -> HeldReboots:
    """Of the made hand, which is enabled; the first reboot has begun."""
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    held = HeldReboots(bus, monkeypatch)
    until(lambda: len(held.had_torque) == 1)
    return held


def test_a_release_while_a_motor_is_started_anew_is_obeyed_before_the_next_one_is(
    made: Made, reboots: HeldReboots
) -> None:
    bus, loop, until = made
    asked = loop.ask_release()
    reboots.may_go_on.set()
    until(lambda: loop.status.recovered == 4)
    assert reboots.had_torque == [True, False, False, False]
    assert asked.poll() == ""
    cycles = loop.status.cycles
    until(lambda: loop.status.cycles > cycles + 10)
    assert loop.status.phase is HandPhase.RELEASED
    assert not bus.has_torque


def test_a_loop_that_is_to_end_while_a_motor_is_started_anew_does_not_wait_for_the_next_one(
    made: Made, reboots: HeldReboots
) -> None:
    bus, loop, until = made
    loop.close(timeout_s=0.0)
    reboots.may_go_on.set()
    until(lambda: loop.status.reason == "shutting down")
    assert len(reboots.had_torque) == 1
    assert not bus.has_torque


@pytest.mark.parametrize("slow", ["recover", "enable"])
def test_an_answer_that_is_lost_after_motors_took_long_to_start_anew_ends_nothing(
    made: Made, monkeypatch: pytest.MonkeyPatch, slow: str
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    quick = getattr(bus, slow)

    def takes_long(*joint: int) -> None:
        begin_s = time.monotonic()
        until(lambda: time.monotonic() - begin_s > 1.5 * STALE_S)
        quick(*joint)
        bus.answers_to_lose = 1

    monkeypatch.setattr(bus, slow, takes_long)
    bus.faults[2] = "overload"
    until(lambda: loop.status.unanswered == 1)
    until(lambda: loop.status.phase is HandPhase.ENABLED)
    sent = len(bus.sent)
    until(lambda: len(bus.sent) > sent)
    assert bus.connects == 1
    # Nobody stood still meanwhile: a command counts at once.
    loop.command({"index_pip": 0.9})
    until(lambda: bus.sent[-1][2] > 0.31)


def test_why_the_torque_is_off_is_told_also_after_the_hand_was_connected_anew(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    release, silent = bus.release, [True]

    def one_is_silent() -> None:
        release()
        if silent:
            silent.clear()
            raise HandError("motors 14 (thumb_mcp) did not answer when they were switched off")

    monkeypatch.setattr(bus, "release", one_is_silent)
    loop.release()
    why = "released by request"
    until(lambda: bus.connects == 2 and loop.status.phase is HandPhase.RELEASED)
    cycles = loop.status.cycles
    until(lambda: loop.status.cycles > cycles + 5)
    assert (bus.connects, loop.status.reason) == (2, why)
