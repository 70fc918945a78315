# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which changes of a state are logged, and throttled lines where the clock is set."""

import time

import pytest
from rclpy.clock import Clock
from rclpy.impl.rcutils_logger import Throttle
from rclpy.logging import get_logger
from rclpy.time import Time
from waiting import wait_for

from acts_ros.log import STEADY, LoggedChanges


@pytest.fixture
def now_s(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now_s = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now_s[0])
    return now_s


def test_a_first_state_and_what_has_not_changed_are_not_logged(now_s: list[float]) -> None:
    changes = LoggedChanges("waiting", "not started")
    assert not changes.is_due("waiting", "not started")
    assert changes.is_due("moving", "asked for")
    now_s[0] += 100.0
    assert not changes.is_due("moving", "asked for")


def test_reasons_that_come_and_go_are_logged_once_a_second_after_the_first(now_s: list[float]) -> None:
    changes = LoggedChanges("waiting", "not started")
    due = 0
    for _ in range(500):
        for reason in ("for touch", "for a ball"):
            due += changes.is_due("waiting", reason)
            now_s[0] += 0.01
    # In 10 s.
    assert 14 <= due <= 15
    assert sum(changes.is_due("waiting", f"{number}") for number in range(9)) <= 1
    # What holds in the end is told, and no state is left out.
    now_s[0] += 1.0
    assert changes.is_due("waiting", "for nothing")
    assert all(changes.is_due(state, "again") for state in ["moving", "waiting"] * 20)


class SystemClock(Clock):
    """One that can be set."""

    set_by_s = 0.0

    def now(self) -> Time:
        return Time(nanoseconds=time.time_ns() + round(self.set_by_s * 1e9))


def test_a_throttled_line_does_not_stay_away_after_the_clock_was_set_back(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = SystemClock()
    monkeypatch.setitem(Throttle.params, "throttle_time_source_type", clock)
    logger = get_logger("throttled")

    def is_told() -> bool:
        return logger.warning("dropped", throttle_duration_sec=0.05, throttle_time_source_type=STEADY)

    def is_told_by_the_system() -> bool:
        return logger.warning("dropped", throttle_duration_sec=0.05)

    assert (is_told(), is_told_by_the_system()) == (True, True)
    clock.set_by_s = -3600.0
    wait_for(is_told, "the line")
    wait_for(is_told, "the next one")
    assert not is_told_by_the_system()
