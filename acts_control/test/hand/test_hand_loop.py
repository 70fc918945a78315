# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand, on the simulated bus."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import pytest
from dynamixel_bus import DEADLINE_S, Bus, leave_at, torques
from hand_loop_rig import Made, Moved, Running

from acts_control.hand.control import HandPhase
from acts_control.hand.control.status import HandStatus
from acts_control.hand.control.torque_wish import TorqueWish
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import DynamixelHand, HandError, HandReading

pytestmark = pytest.mark.slow


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


def begin_to_move(running: Running, angles_rad: dict[str, float]) -> None:
    """Command joints until they move: after this machine stood still, commands are left out for half a second."""

    def is_moving() -> bool:
        running.loop.command(angles_rad)
        return running.loop.status.reason == "moving as commanded"

    running.until(is_moving)


def test_without_commands_the_goals_stand_still_half_way(running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    begin_to_move(running, {"ring_pip": 1.8})
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
    released = running.loop.status.phase
    assert torques(bus) == {0}
    running.enable()
    assert (released, running.loop.status.phase) == (HandPhase.RELEASED, HandPhase.ENABLED)
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


def test_torque_that_comes_on_for_a_part_of_the_motors_is_switched_off_again(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.loop.release()
    running.until_phase(HandPhase.RELEASED)
    # On the loop's thread everything stops as soon as a motor is silent: here between two of its steps.
    running.may_go_on.clear()
    assert running.is_held.wait(DEADLINE_S)
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
    running.enable()
    assert torques(bus) == {1}


def test_what_was_commanded_long_ago_is_not_resumed_with_another_joint(running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    begin_to_move(running, {"ring_pip": 1.8})
    running.until(lambda: running.loop.status.reason == "holding")
    stood_rad = running.loop.status.goal_rad[10]
    with pytest.raises(HandError, match="without a joint"):
        running.loop.command({})
    begin_to_move(running, {"index_pip": 0.2})
    running.until(lambda: running.loop.status.goal_rad[2] == pytest.approx(0.2))
    assert running.loop.status.goal_rad[10] == stood_rad


def test_a_release_that_the_loop_has_not_come_to_is_not_told_as_done(bus: Bus, running: Running) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.may_go_on.clear()
    assert running.is_held.wait(DEADLINE_S)
    assert "cut their power to be sure" in running.loop.release()
    running.may_go_on.set()
    running.until_phase(HandPhase.RELEASED)


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


def test_fingers_that_are_moved_while_the_torque_comes_on_are_not_pulled_back(made: Made) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    bus.moves_to_rad = [0.9] * 16
    assert loop.enable() == ""
    until(lambda: len(bus.sent) > 3)
    assert bus.sent[0] == pytest.approx(bus.moves_to_rad)


def test_what_was_commanded_before_the_torque_came_on_is_not_told_as_followed(made: Made) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    loop.command({"index_pip": 0.9})
    assert loop.enable() == ""
    until(lambda: len(bus.sent) > 5)
    assert loop.status.reason == "holding"
    assert bus.sent[-1] == pytest.approx(bus.q_rad)


def test_a_hand_that_was_lost_and_then_stopped_gets_no_torque_when_it_is_back(made: Made) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    bus.is_there = False
    until(lambda: loop.status.phase is HandPhase.CONNECTING)
    assert loop.cancel_enable()
    bus.is_there = True
    until(lambda: loop.status.reason == "stopped before it was on")
    cycles = loop.status.cycles
    until(lambda: loop.status.cycles > cycles + 10)
    assert not bus.has_torque
    assert loop.enable() == ""
    assert bus.has_torque


def test_who_enables_a_hand_that_is_being_released_is_told_once_its_torque_is_on_again(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    release, is_releasing, may_go_on = bus.release, threading.Event(), threading.Event()

    def held() -> None:
        release()
        is_releasing.set()
        assert may_go_on.wait(DEADLINE_S)

    monkeypatch.setattr(bus, "release", held)
    loop.ask_release()
    assert is_releasing.wait(DEADLINE_S)
    assert "have not said within 2 s that their torque is on" in loop.enable()
    asked = loop.ask_enable()
    assert asked.poll() is None
    may_go_on.set()
    until(lambda: asked.poll() is not None)
    assert asked.poll() == ""
    assert bus.has_torque


def test_a_hand_that_was_released_and_enabled_between_two_cycles_is_not_released_by_a_later_stop(
    bus: Bus, running: Running
) -> None:
    running.until_phase(HandPhase.ENABLED)
    running.may_go_on.clear()
    assert running.is_held.wait(DEADLINE_S)
    running.loop.ask_release()
    asked = running.loop.ask_enable()
    cycles = running.loop.status.cycles
    running.may_go_on.set()
    running.until(lambda: running.loop.status.cycles > cycles + 5)
    assert asked.poll() == ""
    assert not running.loop.cancel_enable()
    assert torques(bus) == {1}


@pytest.mark.parametrize("broken", ["q_rad", "current_ma"])
def test_motors_whose_numbers_are_not_finite_count_as_silent(made: Made, broken: str) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    setattr(bus, broken, [math.nan] * 16)
    until(lambda: "not finite" in loop.status.reason)
    until(lambda: not bus.has_torque)


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


def test_a_release_is_told_as_done_only_where_the_motors_have_said_so() -> None:
    wish, released = TorqueWish(is_on=True), HandStatus(phase=HandPhase.RELEASED, reason="released by request")
    assert "loop has ended" in wish.why_not_off(released)
    wish.is_served = True
    wish.off("released by request")
    # Also where the status says so: what it says may be of a time before.
    assert wish.why_not_off(released).endswith("cut their power to be sure")
    lost = HandStatus(phase=HandPhase.CONNECTING, reason="the cable is gone")
    wish.off_is_known.set()
    assert "not connected (the cable is gone); it is released as soon as it is" in wish.why_not_off(lost)
    assert wish.why_not_off(released) == ""
    # Another one is not yet known of, though the one before was.
    wish.off("released by request")
    assert not wish.off_is_known.is_set()
    wish.tell_all()
    assert wish.off_is_known.is_set()
    wish.off("released by request")
    wish.on()
    assert wish.off_is_known.is_set()
    assert wish.why_not_off(HandStatus(phase=HandPhase.ENABLED)) == "the torque was asked for again meanwhile"
    wish.is_served = False
    assert "loop has ended" in wish.why_not_off(released)


def test_torque_is_told_as_on_only_where_the_motors_have_said_so_since_it_was_asked_for() -> None:
    wish, enabled = TorqueWish(is_on=False), HandStatus(phase=HandPhase.ENABLED)
    assert "loop has ended" in wish.why_not_on(enabled)
    wish.is_served = True
    assert (wish.why_released, wish.is_under_way) == ("connected", False)
    wish.on()
    assert (wish.is_on, wish.is_under_way, wish.on_is_known.is_set()) == (True, True, False)
    wish.on()
    assert "have not said within 2 s that their torque is on" in wish.why_not_on(enabled)
    wish.has_come_on()
    assert wish.on_is_known.is_set()
    assert wish.why_not_on(enabled) == ""
    # Who asks for what is there already does not wait for it, and one that goes off by itself is on its way again.
    wish.on()
    assert not wish.is_under_way
    wish.has_gone_off()
    assert wish.is_under_way
    assert "the hand is given up (hot); its" in wish.why_not_on(HandStatus(phase=HandPhase.GIVEN_UP, reason="hot"))
    wish.off("a stop")
    assert (wish.is_on, wish.is_under_way, wish.on_is_known.is_set()) == (False, False, True)
    assert (wish.why_not_on(enabled), wish.why_released) == ("the torque is off: a stop", "a stop")
    wish.has_gone_off()
    assert not wish.is_under_way
    wish.on()
    assert (wish.why_released, wish.on_is_known.is_set()) == ("connected", False)
    wish.tell_all()
    assert wish.on_is_known.is_set()
