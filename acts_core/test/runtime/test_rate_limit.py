# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import pytest

from acts_core.runtime import RateLimit


@pytest.mark.parametrize(("rate_hz", "expected"), [(0.0, 1000), (30.0, 30), (300.0, 300), (1000.0, 1000), (7.3, 8)])
def test_of_a_thousand_frames_in_a_second_so_many_are_due(rate_hz: float, expected: int) -> None:
    limit = RateLimit(rate_hz)
    times_s = [50 + (i + 0.3 * (i % 3)) / 1000 for i in range(1000)]
    assert abs(sum(limit.due(time_s) for time_s in times_s) - expected) <= 1


@pytest.mark.parametrize(("rate_hz", "period_s"), [(10.0, 0.1), (0.0, 0.0)])
def test_a_rate_that_is_raised_is_in_force_at_once(rate_hz: float, period_s: float) -> None:
    limit = RateLimit(0.1)
    assert limit.due(100.0)
    limit.set_rate(rate_hz)
    assert not limit.due(100.0 + period_s - 0.001)
    assert limit.due(100.0 + period_s + 0.001)


def test_a_rate_that_is_lowered_is_in_force_at_once() -> None:
    limit = RateLimit(10.0)
    assert limit.due(100.0)
    limit.set_rate(0.1)
    assert not limit.due(109.9)
    assert limit.due(110.01)


def test_after_a_pause_nothing_is_made_up_for() -> None:
    limit = RateLimit(10.0)
    assert limit.due(1.0)
    assert limit.due(20.0)
    assert not limit.due(20.05)
    assert limit.due(20.11)
