# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Cycles of a control loop, by a clock that passes as the test lets it."""

import pytest

from acts_control.loop_rate import LoopRate

PERIOD_S = 0.25


class Clock:
    """Stands still but for what is slept and what `now_s` is set to."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def sleep(self, seconds: float) -> None:
        assert seconds > 0.0
        self.now_s += seconds


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def rate(clock: Clock) -> LoopRate:
    return LoopRate(PERIOD_S, lambda: clock.now_s, clock.sleep)


def test_cycles_begin_at_the_rate_whatever_their_work_takes(rate: LoopRate, clock: Clock) -> None:
    for number, work_s in enumerate((0.0, 0.1, 0.2, 0.05), 1):
        assert rate.wait() == (100.0 + number * PERIOD_S, PERIOD_S, False)
        clock.now_s += work_s


def test_a_cycle_that_begins_less_than_a_period_late_is_made_up_for(rate: LoopRate, clock: Clock) -> None:
    clock.now_s += 1.75 * PERIOD_S
    assert rate.wait() == (clock.now_s, 1.75 * PERIOD_S, True)
    assert rate.wait() == (100.0 + 2 * PERIOD_S, 0.25 * PERIOD_S, False)


def test_after_a_longer_delay_no_burst_follows(rate: LoopRate, clock: Clock) -> None:
    clock.now_s += 8.5 * PERIOD_S
    late_s = clock.now_s
    assert rate.wait() == (late_s, 8.5 * PERIOD_S, True)
    assert rate.wait() == (late_s + PERIOD_S, PERIOD_S, False)
    assert rate.wait() == (late_s + 2 * PERIOD_S, PERIOD_S, False)
