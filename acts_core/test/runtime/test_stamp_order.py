# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which stamps continue a stream, whatever its clock does."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.runtime import Order, StampOrder

MS = 1_000_000
NOW_NS = 1_700_000_000_000_000_000


def orders(*times_ms: float) -> list[Order]:
    order = StampOrder()
    return [order.step(NOW_NS + round(time_ms * MS)) for time_ms in times_ms]


def test_a_stream_is_followed_and_repeated_and_late_messages_are_strays() -> None:
    assert orders(0, 1, 1, 0.5, 2) == [Order.ANEW, Order.NEXT, Order.STRAY, Order.STRAY, Order.NEXT]


@pytest.mark.parametrize("step_ms", [-3_600_000, -20, 60, 2000, 3_600_000])
def test_a_clock_that_was_set_is_followed_from_the_fifth_stamp_on(step_ms: int) -> None:
    assert orders(0, 1, *(step_ms + k for k in range(6)))[2:] == [*[Order.STRAY] * 4, Order.ANEW, Order.NEXT]


def test_strays_that_do_not_follow_one_another_change_nothing() -> None:
    order = StampOrder()
    order.step(NOW_NS)
    for k in range(1, 100):
        assert order.step(NOW_NS + k * MS) is Order.NEXT
        for stray_ns in (NOW_NS - 7 * k * MS, NOW_NS + 3_600_000 * MS):
            assert order.step(stray_ns) is Order.STRAY


@pytest.mark.parametrize("interval_ms", [1, 40, 200, 900])
def test_a_slow_stream_is_followed_too(interval_ms: int) -> None:
    assert set(orders(*(k * interval_ms for k in range(20)))[6:]) == {Order.NEXT}


@settings(max_examples=50)
@given(st.lists(st.integers(-(2**61), 2**61), max_size=30), st.integers(-(2**61), 2**61))
def test_whatever_came_before_a_stream_is_followed_from_its_fifth_message_on(before: list[int], first_ns: int) -> None:
    order = StampOrder()
    for stamp_ns in before:
        order.step(stamp_ns)
    found = [order.step(first_ns + k * MS) for k in range(30)]
    # Where what came before lay a little ahead of the stream, it is met again: five more.
    assert found.count(Order.STRAY) <= 8
    assert set(found[10:]) == {Order.NEXT}
