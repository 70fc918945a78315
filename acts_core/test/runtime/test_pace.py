# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The usual interval of a stream, and limits that follow it."""

from __future__ import annotations

import pytest

from acts_core.runtime import Pace


def paced(*times_s: float) -> Pace:
    pace = Pace()
    for time_s in times_s:
        pace.step(time_s)
    return pace


def test_before_the_second_message_limits_are_as_given() -> None:
    for pace in (paced(), paced(5.0)):
        assert pace.interval_s == 0.0
        assert pace.limit_s(0.1) == 0.1


def test_a_slow_stream_has_longer_limits_and_a_quick_one_those_that_are_given() -> None:
    slow = paced(*(0.2 * number for number in range(8)))
    assert slow.interval_s == pytest.approx(0.2)
    assert slow.limit_s(0.1) == pytest.approx(0.5)
    assert slow.limit_s(0.1, 5.0) == pytest.approx(1.0)
    quick = paced(*(0.001 * number for number in range(8)))
    assert quick.limit_s(0.1) == 0.1


def test_single_pauses_change_nothing() -> None:
    pace = paced(0.0, 60.0, 60.001, 60.002, 120.0, 120.001, 120.002)
    assert pace.interval_s == pytest.approx(0.001)


def test_no_stream_is_slower_than_a_board_can_be() -> None:
    assert paced(0.0, 20.0, 40.0, 60.0).limit_s(0.1) == 2.5


def test_messages_may_be_counted_together() -> None:
    pace = paced(0.0)
    for second in range(1, 5):
        pace.step(float(second), 5)
    assert pace.interval_s == pytest.approx(0.2)


def test_silence_is_longer_than_the_limit() -> None:
    assert paced().is_silent(0.0)
    pace = paced(0.0, 0.2, 0.4, 0.6)
    assert [pace.is_silent(now_s) for now_s in (0.6, 1.0, 1.2)] == [False, False, True]
    assert not pace.is_silent(1.2, 1.0)
    # The clock was set back: nobody knows.
    assert pace.is_silent(-3000.0)
