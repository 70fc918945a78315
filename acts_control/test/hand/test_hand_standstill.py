# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand where its program or the machine stands still, and where only its motors are silent."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from types import SimpleNamespace

import pytest
from dynamixel_bus import DEADLINE_S
from hand_loop_rig import STALE_S, Made, MadeBus, Moved
from waiting import wait_for

from acts_control.hand.control import HandLoop, HandLoopConfig, HandPhase, PendingAnswer, torque_wish
from acts_control.hand.control.status import HandStatus
from acts_control.hand.control.torque_wish import TorqueWish
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import HandError
from acts_control.loop_rate import Cycle, LoopRate

pytestmark = pytest.mark.slow


def test_what_was_commanded_while_the_loop_stood_still_is_not_done(made: Made) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    until(lambda: len(bus.sent) > 3)
    bus.answers.clear()
    begin_s = time.monotonic()
    until(lambda: time.monotonic() - begin_s > 1.5 * STALE_S)
    bus.answers.set()
    # As from a queue that has waited: now, whether the loop goes on before or after it.
    loop.command({"index_pip": 0.9})
    cycles = loop.status.cycles
    until(lambda: loop.status.cycles > cycles + 20)
    assert bus.sent[-1] == pytest.approx(bus.q_rad)

    def is_obeyed() -> bool:
        loop.command({"index_pip": 0.9})
        return bus.sent[-1][2] > 0.5

    until(is_obeyed)


def sleeping(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """For how long the machine has slept, to be set [s]."""
    clock_gettime, slept_s = time.clock_gettime, [0.0]

    def clock(number: int) -> float:
        # Of the steady ones, Linux lets only this one run meanwhile.
        return clock_gettime(number) + (slept_s[0] if number == time.CLOCK_BOOTTIME else 0.0)

    monkeypatch.setattr(time, "clock_gettime", clock)
    return slept_s


def test_what_was_commanded_before_the_machine_slept_is_not_done_afterwards(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    slept_s, bus, told = sleeping(monkeypatch), MadeBus(), []
    config = HandLoopConfig(silence_s=10.0, command_stale_after_s=10.0, max_speed_rad_s=0.1)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, sentence: told.append(sentence))
    loop.launch()

    def until(condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, state=lambda: (loop.status, told))

    try:
        until(lambda: len(bus.sent) > 3)
        loop.command({"index_pip": 1.3})
        until(lambda: bus.sent[-1][2] > 0.31)
        slept_s[0] = 600.0
        until(lambda: loop.status.reason == "holding")
        # A busy machine adds to it.
        assert [sentence[:31] for sentence in told] == ["this program stood still for 60"]
        assert bus.sent[-1][2] < 1.2
    finally:
        loop.close()


class Waiting(Moved):
    """A behaviour that notes for how long it was told that motors did not answer."""

    def __init__(self) -> None:
        super().__init__()
        self.waited_s: list[float] = []

    def waited(self, seconds: float) -> None:
        self.waited_s.append(seconds)


@pytest.mark.parametrize("behaviour", [None, Waiting()])
def test_motors_that_do_not_answer_are_no_standstill_of_the_program(behaviour: Waiting | None) -> None:
    bus, told = MadeBus(), []
    config = HandLoopConfig(silence_s=10.0, command_stale_after_s=STALE_S)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, sentence: told.append(sentence), behaviour=behaviour)
    loop.launch()

    def until(condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, state=lambda: (loop.status, told))

    try:
        until(lambda: len(bus.sent) > 3)
        bus.answers_to_lose, begin_s = 10**9, time.monotonic()
        until(lambda: time.monotonic() - begin_s > 1.5 * STALE_S)
        bus.answers_to_lose, sent = 0, len(bus.sent)
        until(lambda: len(bus.sent) > sent)
        assert told == []
        if behaviour is None:
            loop.command({"index_pip": 0.9})
            until(lambda: bus.sent[-1][2] > 0.31)
        else:
            assert len(behaviour.waited_s) == loop.status.unanswered
            assert all(0.0 <= seconds <= config.silence_s for seconds in behaviour.waited_s)
    finally:
        loop.close()


def test_motors_that_do_not_answer_after_one_of_them_was_started_anew_are_none_either(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bus, told = MadeBus(), []
    config = HandLoopConfig(silence_s=10.0, command_stale_after_s=STALE_S)
    loop = HandLoop(LEAP_RIGHT, bus, config, lambda _level, sentence: told.append(sentence))
    recover = bus.recover

    def fall_silent(joint: int) -> None:
        recover(joint)
        bus.answers_to_lose = 10**9

    def until(condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, state=lambda: (loop.status, told))

    monkeypatch.setattr(bus, "recover", fall_silent)
    loop.launch()
    try:
        until(lambda: len(bus.sent) > 3)
        bus.faults[2], begin_s = "overload", time.monotonic()
        until(lambda: time.monotonic() - begin_s > 1.5 * STALE_S)
        bus.answers_to_lose, sent = 0, len(bus.sent)
        until(lambda: len(bus.sent) > sent)
        loop.command({"index_pip": 0.9})
        until(lambda: bus.sent[-1][2] > 0.31)
        assert [sentence for sentence in told if "stood still" in sentence] == []
    finally:
        loop.close()


@pytest.mark.parametrize("lost", ["read", "command"])
def test_an_answer_that_is_lost_after_this_program_stood_still_ends_nothing(
    made: Made, monkeypatch: pytest.MonkeyPatch, lost: str
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    until(lambda: len(bus.sent) > 3)
    wait, command, is_to_stand_still, is_to_be_lost = LoopRate.wait, bus.command, threading.Event(), threading.Event()

    def stands_still(rate: LoopRate) -> Cycle:
        if is_to_stand_still.is_set():
            is_to_stand_still.clear()
            begin_s = time.monotonic()
            until(lambda: time.monotonic() - begin_s > 1.5 * STALE_S)
            is_to_be_lost.set()
            bus.answers_to_lose = int(lost == "read")
        return wait(rate)

    def is_lost(q_rad: Sequence[float]) -> None:
        if lost == "command" and is_to_be_lost.is_set():
            is_to_be_lost.clear()
            raise HandError("no answer")
        command(q_rad)

    monkeypatch.setattr(LoopRate, "wait", stands_still)
    monkeypatch.setattr(bus, "command", is_lost)
    is_to_stand_still.set()
    until(lambda: loop.status.unanswered == 1)
    sent = len(bus.sent)
    until(lambda: len(bus.sent) > sent)
    assert bus.connects == 1
    assert loop.status.phase is HandPhase.ENABLED


def test_motors_are_not_told_as_silent_because_this_program_stood_still(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [0.0]
    monkeypatch.setattr(torque_wish, "time", SimpleNamespace(monotonic=lambda: now_s[0]))
    wish = TorqueWish(is_on=True)
    wish.is_served = True
    wish.off("released by request")
    status = HandStatus(phase=HandPhase.ENABLED)
    asked = PendingAnswer(wish.off_is_known, lambda: wish.why_not_off(status), waits=True)
    now_s[0] += 5.0
    assert asked.poll() is None
    # The loop goes on, and with it the motors; or these are silent.
    answers = []
    for _ in range(25):
        now_s[0] += 0.1
        answers.append(asked.poll())
    assert answers[10] is None
    assert "have not said within 2 s that they are released" in str(answers[-1])
    wish.off_is_known.set()
    assert asked.poll() == ""
