# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How far the loop of a hand moves goals at once, and that no motor keeps its torque when the loop ends."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from itertools import pairwise

import pytest
from dynamixel_bus import DEADLINE_S
from hand_loop_rig import Made, MadeBus, Moved
from waiting import wait_for

from acts_control.hand.control import HandLoop, HandLoopConfig, HandPhase
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import HandError, HandLostError, HandReading
from acts_control.loop_rate import Cycle, LoopRate

pytestmark = pytest.mark.slow

PIP = 2


def test_a_late_cycle_makes_up_for_no_more_than_four_periods(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    until(lambda: len(bus.sent) > 3)
    wait = LoopRate.wait
    # To the loop each cycle comes 0.3 s after the one before.
    monkeypatch.setattr(LoopRate, "wait", lambda rate: Cycle(wait(rate).now_s, 0.3, True))
    sent = len(bus.sent)

    def is_there() -> bool:
        loop.command({"index_pip": 1.2})
        return bus.sent[-1][PIP] == pytest.approx(1.2)

    until(is_there)
    config = HandLoopConfig()
    most_rad = 4.0 / config.rate_hz * config.max_speed_rad_s
    steps_rad = [after[PIP] - before[PIP] for before, after in pairwise(bus.sent[sent:])]
    assert max(steps_rad) == pytest.approx(most_rad)


def test_a_joint_beyond_its_limit_comes_back_no_faster_than_any_joint_may_move() -> None:
    bus = MadeBus()
    joint = LEAP_RIGHT.joints[PIP]
    bus.q_rad = bus.moves_to_rad = [0.3] * PIP + [joint.upper_rad + 0.3] + [0.3] * (15 - PIP)
    config = HandLoopConfig(max_speed_rad_s=0.05)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, _sentence: None)
    loop.launch()
    try:
        wait_for(lambda: len(bus.sent) > 20, lambda: f"goals, {loop.status}", DEADLINE_S)
    finally:
        loop.close()
    steps_rad = [before[PIP] - after[PIP] for before, after in pairwise(bus.sent)]
    assert 0.0 < max(steps_rad) <= config.max_speed_rad_s * 4.0 / config.rate_hz + 1e-9


@pytest.mark.parametrize("lost", ["read", "command"])
def test_single_answers_that_are_lost_now_and_then_do_not_add_up_to_silence(
    lost: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, answers_to_lose = MadeBus(), [0]
    answer = getattr(bus, lost)

    def answer_or_not(*given: object) -> object:
        if answers_to_lose[0]:
            answers_to_lose[0] -= 1
            raise HandError("no answer")
        return answer(*given)

    monkeypatch.setattr(bus, lost, answer_or_not)
    config = HandLoopConfig(silence_s=0.05)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, _sentence: None)
    loop.launch()
    try:
        wait_for(lambda: loop.status.phase is HandPhase.ENABLED, lambda: f"torque, {loop.status}", DEADLINE_S)
        for count in (1, 2, 3):
            answers_to_lose[0] = 1
            wait_for(lambda: loop.status.unanswered == count, lambda: f"a lost answer, {loop.status}", DEADLINE_S)  # noqa: B023
            later = loop.status.cycles + round(4.0 * config.silence_s * config.rate_hz)
            wait_for(lambda: loop.status.cycles >= later, lambda: f"cycles, {loop.status}", DEADLINE_S)  # noqa: B023
        assert bus.connects == 1
    finally:
        loop.close()


def test_the_torque_goes_off_when_asked_also_while_motors_do_not_answer() -> None:
    bus = MadeBus()
    loop = HandLoop(LEAP_RIGHT, bus, HandLoopConfig(silence_s=10.0), lambda _level, _sentence: None)
    loop.launch()
    try:
        wait_for(lambda: bus.has_torque, lambda: f"torque, {loop.status}", DEADLINE_S)
        bus.answers_to_lose = 10**9
        wait_for(lambda: loop.status.unanswered > 0, lambda: f"silence, {loop.status}", DEADLINE_S)
        loop.release()
        wait_for(lambda: not bus.has_torque, lambda: f"the torque to go off, {loop.status}", DEADLINE_S)
        # They hear it before they are taken for lost.
        assert bus.connects == 1
    finally:
        loop.close()


def test_motors_of_which_one_was_silent_at_the_last_release_are_switched_off_by_connecting_once_more(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""

    def silent() -> None:
        raise HandError("motor 14 (thumb_mcp) did not answer when it was switched off")

    monkeypatch.setattr(bus, "release", silent)
    loop.close()
    assert bus.connects == 2
    assert not bus.has_torque


def test_torque_that_was_coming_on_when_the_port_was_lost_is_off_when_the_loop_has_ended(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    enable, is_enabling, may_go_on = bus.enable, threading.Event(), threading.Event()

    def torn_off() -> None:
        enable()
        is_enabling.set()
        assert may_go_on.wait(DEADLINE_S)
        lost()

    def lost() -> None:
        raise HandLostError("the port is gone")

    monkeypatch.setattr(bus, "enable", torn_off)
    monkeypatch.setattr(bus, "release", lost)
    loop.ask_enable()
    assert is_enabling.wait(DEADLINE_S)
    loop.close(timeout_s=0.0)
    may_go_on.set()
    loop.close()
    assert bus.connects == 2
    assert not bus.has_torque


def test_motors_that_refuse_goals_for_too_long_are_connected_anew(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""

    def refused(_q_rad: Sequence[float]) -> None:
        raise HandError("no answer")

    monkeypatch.setattr(bus, "command", refused)
    until(lambda: bus.connects == 2)


def test_a_hand_stays_given_up_where_its_motors_do_not_answer_as_they_are_switched_off(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    release, refusals = bus.release, [True]

    def silent_once() -> None:
        if refusals:
            refusals.clear()
            raise HandError("motor 14 (thumb_mcp) did not answer when it was switched off")
        release()

    monkeypatch.setattr(bus, "release", silent_once)
    bus.faults[PIP] = "overload"
    until(lambda: loop.status.recovered == 1 and loop.status.phase is HandPhase.ENABLED)
    bus.faults[PIP] = "overload"
    until(lambda: bus.connects == 2)
    bus.faults[PIP] = ""
    cycles = loop.status.cycles
    until(lambda: loop.status.cycles > cycles + 10)
    assert not loop.is_torque_wanted
    assert not bus.has_torque


class Asking(Moved):
    """A behaviour that asks for the same angles at any time."""

    def __init__(self, q_rad: Sequence[float]) -> None:
        super().__init__()
        self._q_rad = q_rad

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        return self._q_rad


@pytest.mark.parametrize(
    ("asked_rad", "reached_rad"),
    [
        ([9.0] * 16, [joint.upper_rad for joint in LEAP_RIGHT.joints]),
        ([-9.0] * 16, [joint.lower_rad for joint in LEAP_RIGHT.joints]),
        # Of such an answer nothing is done.
        ([0.5] * 15, [0.3] * 16),
        ([0.5] * 17, [0.3] * 16),
    ],
)
def test_whatever_a_behaviour_asks_for_goals_stay_within_limits(
    asked_rad: list[float], reached_rad: list[float]
) -> None:
    bus = MadeBus()
    config = HandLoopConfig(max_speed_rad_s=8.0)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, _sentence: None, behaviour=Asking(asked_rad))
    loop.launch()
    try:
        wait_for(lambda: len(bus.sent) > 100, lambda: f"goals, {loop.status}", DEADLINE_S)
    finally:
        loop.close()
    assert bus.sent[-1] == pytest.approx(reached_rad)
