# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Stamps as numbers and back."""

import pytest
from builtin_interfaces.msg import Time

from acts_core.errors import PacketError
from acts_msgs.msg import TactileSamples
from acts_ros.messages import ns_of, seconds_of, set_stamp, stamp_ns_of

NOW_NS = 1_700_000_000_123_456_789


@pytest.mark.parametrize("time_ns", [0, 1, 999_999_999, 1_000_000_000, NOW_NS, -1, -(2**31) * 10**9])
def test_a_stamp_is_the_time_that_was_written(time_ns: int) -> None:
    stamp = Time()
    set_stamp(stamp, time_ns)
    assert ns_of(stamp) == time_ns
    assert 0 <= stamp.nanosec < 1_000_000_000
    assert seconds_of(stamp) == pytest.approx(1e-9 * time_ns, abs=3e-7)


def test_samples_whose_stamp_is_no_time_are_refused() -> None:
    samples = TactileSamples()
    samples.header.stamp.nanosec = 1_000_000_000
    with pytest.raises(PacketError, match="stamp of 1000000000 nanoseconds: a second has 1000000000"):
        stamp_ns_of(samples)
