# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand, on the simulated bus."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import pytest
from dynamixel_bus import DEADLINE_S, Bus, leave_at, torques
from hand_loop_rig import Running

from acts_control.hand.control import HandPhase
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import DynamixelHand, HandError, HandReading

pytestmark = pytest.mark.slow


@pytest.fixture
def running(bus: Bus) -> Iterator[Running]:
    running = Running(bus)
    yield running
    running.loop.close()
    assert {motor["torque_enable"] for motor in bus.motors()} == {0}


def test_a_command_is_followed_no_faster_than_allowed_and_kept(bus: Bus) -> None:
    running = Running(bus, max_speed_rad_s=1.0)
    try:
        running.until_phase(HandPhase.ENABLED)
        begin_s = time.monotonic()
        seen = [0.0]

        def arrived() -> bool:
            running.loop.command({"index_pip": 0.5})
            seen.append(running.loop.status.goal_rad[2])
            # The first step may stand for four periods that had passed before.
            assert seen[-1] <= 1.0 * (time.monotonic() - begin_s) + 0.05
            return seen[-1] == pytest.approx(0.5)

        running.until(arrived)
        assert running.loop.status.goal_rad[3] == pytest.approx(0.0, abs=0.01)  # nobody asked for it
        running.until(lambda: running.loop.status.reason == "holding")
        assert running.loop.status.goal_rad[2] == pytest.approx(0.5)
    finally:
        running.loop.close()
    assert torques(bus) == {0}


def test_without_commands_the_goals_stand_still_half_way(running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.loop.command({"ring_pip": 1.8})
    running.until(lambda: running.loop.status.reason == "moving as commanded")
    running.until(lambda: running.loop.status.reason == "holding")
    stood_rad = running.loop.status.goal_rad[10]
    cycles = running.loop.status.cycles
    running.until(lambda: running.loop.status.cycles > cycles + 20)
    assert running.loop.status.goal_rad[10] == stood_rad


def test_names_and_numbers_that_cannot_be_are_refused_and_change_nothing(running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    with pytest.raises(HandError, match="no joint 'little_pip'; its joints are index_mcp_side"):
        running.loop.command({"little_pip": 0.1, "index_pip": 0.4})
    with pytest.raises(HandError, match="index_pip = nan"):
        running.loop.command({"ring_pip": 0.4, "index_pip": math.nan})
    assert running.loop.status.reason == "holding"


def test_the_hand_is_released_and_enabled_again(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    assert torques(bus) == {1}
    assert running.loop.release() == ""
    assert running.loop.status.phase is HandPhase.RELEASED
    assert torques(bus) == {0}
    assert running.loop.enable() == ""
    assert running.loop.status.phase is HandPhase.ENABLED
    assert torques(bus) == {1}


def test_who_asks_for_torque_is_told_why_it_is_still_off(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    bus.command("unplug")
    running.until_phase(HandPhase.CONNECTING)
    assert "the hand is not connected (" in running.loop.enable()
    bus.command("plug_in")
    running.until_phase(HandPhase.ENABLED)
    running.loop.release()
    # The loop does not come to it.
    running.may_go_on.clear()
    assert running.is_held.wait(DEADLINE_S)
    assert "the hand is released (released by request); its torque comes on as soon as it can" in running.loop.enable()
    running.may_go_on.set()


def test_an_overload_is_recovered_once_and_given_up_the_second_time(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    bus.command("overload 6")
    running.until(lambda: running.loop.status.recovered == 1 and running.loop.status.phase is HandPhase.ENABLED)
    assert torques(bus) == {1}
    bus.command("overload 6")
    running.until_phase(HandPhase.GIVEN_UP)
    assert running.loop.status.reason == "middle_pip: overload, 2 times within a minute; call enable to go on"
    assert torques(bus) == {0}
    assert running.loop.enable() == ""  # a person has looked after it
    running.until_phase(HandPhase.ENABLED)
    assert torques(bus) == {1}


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
    assert any("is the cable plugged in" in sentence for _, sentence in running.log)


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


def test_torque_that_comes_on_for_a_part_of_the_motors_is_switched_off_again(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.loop.release()
    running.until_phase(HandPhase.RELEASED)
    # On the loop's thread everything stops as soon as a motor is silent: here between two of its steps.
    running.may_go_on.clear()
    running.loop.enable()
    bus.command("lose 15")
    running.may_go_on.set()
    running.until_phase(HandPhase.CONNECTING)
    running.until(lambda: torques(bus) == {0})


def test_torque_that_is_unwanted_while_it_comes_on_does_not_stay(
    bus: Bus, running: Running, monkeypatch: pytest.MonkeyPatch
) -> None:
    running.until_phase(HandPhase.ENABLED)
    assert not running.loop.cancel_enable()  # it is on
    assert running.loop.release() == ""
    hand, enable = running.loop._bus, running.loop._bus.enable
    cancelled: list[bool] = []

    def stopped_meanwhile() -> None:
        enable()
        cancelled.append(running.loop.cancel_enable())

    monkeypatch.setattr(hand, "enable", stopped_meanwhile)
    assert running.loop.enable() == "the torque is off: stopped before it was on"
    running.until(lambda: running.loop.status.reason == "stopped before it was on")
    assert cancelled == [True]
    assert running.loop.status.phase is HandPhase.RELEASED
    assert torques(bus) == {0}
    monkeypatch.setattr(hand, "enable", enable)
    assert running.loop.enable() == ""
    assert torques(bus) == {1}


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
    running.until(lambda: not off)
    # Its own limit of the current is several times the hand's.
    running.until(lambda: {motor["goal_current"] for motor in bus.motors()} == {350})
    running.until(lambda: running.loop.status.recovered == 1)
    assert any("index_pip: its settings are gone, as after a loss of power" in told for _, told in running.log)
    assert running.loop.status.phase is HandPhase.RELEASED
    assert torques(bus) == {0}
    assert running.loop.enable() == ""
    reading = running.loop.status.reading
    assert reading is not None
    assert reading.q_rad[2] == pytest.approx(0.0, abs=0.01)


def test_what_was_commanded_long_ago_is_not_resumed_with_another_joint(running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.loop.command({"ring_pip": 1.8})
    running.until(lambda: running.loop.status.reason == "moving as commanded")
    running.until(lambda: running.loop.status.reason == "holding")
    stood_rad = running.loop.status.goal_rad[10]
    with pytest.raises(HandError, match="without a joint"):
        running.loop.command({})
    running.loop.command({"index_pip": 0.2})
    running.until(lambda: running.loop.status.goal_rad[2] == pytest.approx(0.2))
    assert running.loop.status.goal_rad[10] == stood_rad


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


def test_a_release_that_the_loop_has_not_come_to_is_not_told_as_done(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.may_go_on.clear()
    assert running.is_held.wait(DEADLINE_S)
    assert "cut their power to be sure" in running.loop.release()
    running.may_go_on.set()
    running.until_phase(HandPhase.RELEASED)


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


def test_a_joint_beyond_its_limit_is_brought_back_slowly_and_that_is_told(
    bus: Bus, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_at(bus, 2.7)
    sent: list[Sequence[float]] = []
    command = DynamixelHand.command

    def noted(hand: DynamixelHand, q_rad: Sequence[float]) -> None:
        command(hand, q_rad)
        sent.append(list(q_rad))

    monkeypatch.setattr(DynamixelHand, "command", noted)
    running = Running(bus, max_speed_rad_s=8.0)
    limits_rad = [joint.upper_rad for joint in LEAP_RIGHT.joints]

    def is_back() -> bool:
        running.loop.command({"index_pip": 0.0})  # asks for more speed than it gets
        return bool(sent) and all(sent[-1][k] == limit for k, limit in enumerate(limits_rad) if k != 2)

    try:
        running.until(is_back)
        running.until(lambda: sent[-1][2] == 0.0)
    finally:
        running.loop.close()
    assert sent[0] == pytest.approx([2.7] * 16, abs=0.05)
    for before, after in pairwise(sent):
        for k, limit in enumerate(limits_rad):
            # At most four periods of 10 ms are made up for at once.
            allowed_rad = 0.5 * 0.04 if before[k] > limit else 8.0 * 0.04
            assert 0.0 <= before[k] - after[k] <= allowed_rad + 1e-9
    told = [sentence for level, sentence in running.log if level == "warning"]
    assert any("index_pip is at 2.7" in sentence and "0.5 rad/s" in sentence for sentence in told), told


def test_a_joint_that_is_said_to_be_where_no_joint_comes_gets_no_torque(bus: Bus) -> None:
    turned = replace(LEAP_RIGHT.joints[2], motor_zero_rad=180.0)  # in degrees, for once
    hand = replace(LEAP_RIGHT, joints=(*LEAP_RIGHT.joints[:2], turned, *LEAP_RIGHT.joints[3:]))
    running = Running(bus, hand=hand)
    try:
        running.until_phase(HandPhase.GIVEN_UP)
        for _ in range(2):
            assert torques(bus) == {0}
            assert "index_pip is said to be at -176.86 rad" in running.loop.status.reason
            assert running.loop.enable() == f"the torque is off: {running.loop.status.reason}"
    finally:
        running.loop.close()


class Moved:
    """A behaviour that does nothing but remember how it was started."""

    def __init__(self) -> None:
        self.restarts: list[bool] = []

    def restart(self, *, recovered: bool) -> None:
        self.restarts.append(recovered)

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        return goal_rad

    def sent(self, began_s: float, sent_s: float) -> None:
        pass


class Broken(Moved):
    """A behaviour with a mistake."""

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        raise KeyError("little_distal")


def test_a_mistake_in_a_reflex_switches_the_torque_off_and_is_told(bus: Bus, monkeypatch: pytest.MonkeyPatch) -> None:
    raised: list[threading.ExceptHookArgs] = []
    monkeypatch.setattr(threading, "excepthook", raised.append)
    running = Running(bus, behaviour=Broken())
    running.until(lambda: bool(raised))
    assert torques(bus) == {0}
    told = "the loop failed with KeyError: 'little_distal'; start the node again"
    assert running.loop.status.reason == told
    for asked in (running.loop.enable, running.loop.release):
        assert asked() == f"the hand's loop has ended: {told}"


def test_a_hand_that_was_given_up_begins_anew_when_it_is_enabled(bus: Bus) -> None:
    moved = Moved()
    running = Running(bus, behaviour=moved)
    try:
        for number in (1, 2):
            running.until_phase(HandPhase.ENABLED)
            bus.command("overload 6")
            running.until(lambda number=number: len(moved.restarts) > number or not running.loop._wish.is_on)
        running.until_phase(HandPhase.GIVEN_UP)
        running.loop.enable()
        running.until_phase(HandPhase.ENABLED)
        assert moved.restarts == [False, True, False]
    finally:
        running.loop.close()
