# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import pytest

from acts_core.runtime import RateLimit


@pytest.mark.parametrize(("rate_hz", "expected"), [(0.0, 1000), (30.0, 30), (300.0, 300), (1000.0, 1000), (7.3, 8)])
def test_of_a_thousand_frames_in_a_second_so_many_are_due(rate_hz: float, expected: int) -> None:
    limit = RateLimit(rate_hz)
    times_s = [50 + (i + 0.3 * (i % 3)) / 1000 for i in range(1000)]
    assert abs(sum(limit.due(time_s) for time_s in times_s) - expected) <= 1


def test_after_a_pause_nothing_is_made_up_for() -> None:
    limit = RateLimit(10.0)
    assert limit.due(1.0)
    assert limit.due(20.0)
    assert not limit.due(20.05)
    assert limit.due(20.11)
