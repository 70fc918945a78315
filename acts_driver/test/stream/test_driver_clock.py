# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The clock filter against a simulated way with known truth, and against jumps."""

from functools import partial
from operator import gt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from simulated_channel import EPOCH_NS, Channel, simulate

from acts_core.frames import SampleFrame, Scheme
from acts_driver.stream import ClockFilter, FrameStream
from acts_driver.stream.envelope import hull_slope
from acts_driver.stream.host_clock import HostClock

pytestmark = pytest.mark.slow

MS = 1_000_000


def stamps_of(channel: Channel, clock: ClockFilter) -> NDArray[np.int64]:
    return np.concatenate([clock.step_batch(board_us, arrival_ns) for board_us, arrival_ns, _ in channel.batches()])


@pytest.mark.parametrize("drift_ppm", [0.0, 40.0, -40.0, 300.0])
@pytest.mark.parametrize("jitter_us", [20.0, 400.0])
def test_stamps_are_right_within_microseconds_after_five_seconds(drift_ppm: float, jitter_us: float) -> None:
    channel = simulate(15.0, drift_ppm, jitter_us=jitter_us)
    clock = ClockFilter()
    stamps = stamps_of(channel, clock)
    error_us = (stamps - channel.measured_ns - channel.shortest_ns) / 1000
    late_us = (channel.arrival_ns - channel.measured_ns - channel.shortest_ns) / 1000
    assert np.abs(error_us[5000:]).max() < 20
    assert np.percentile(late_us[5000:], 99) > 5000, "the way is no test of the filter"
    # Until the drift is known it adds up for two and a half seconds.
    assert np.median(np.abs(error_us[:3000])) < 20 + 2.5 * abs(drift_ppm)
    assert (np.diff(stamps) > 0).all()
    assert (stamps <= channel.arrival_ns).all()
    assert clock.state.drift_ppm == pytest.approx(drift_ppm, abs=2)
    assert clock.state.resets == 0
    offset_ns = channel.measured_ns[-1] + channel.shortest_ns - 1000 * channel.board_us[-1]
    assert clock.state.offset_us == pytest.approx(offset_ns / 1000, abs=20)


@given(
    st.lists(st.tuples(st.integers(1, 5), st.integers(0, 3_000_000), st.integers(0, 200 * MS)), max_size=40),
    st.booleans(),
)
@settings(max_examples=200)
def test_stamps_increase_and_never_lie_after_the_arrival(reads: list[tuple[int, int, int]], may_restart: bool) -> None:
    clock = ClockFilter()
    board_us = 10_000_000
    arrival_ns = EPOCH_NS
    last = 0
    for count, board_step_us, wait_ns in reads:
        times_us = []
        for _ in range(count):
            board_us = 0 if may_restart and board_step_us > 2_900_000 else board_us + board_step_us + 1
            times_us.append(board_us)
        arrival_ns += wait_ns + 10
        stamps = clock.step_batch(times_us, arrival_ns)
        assert len(stamps) == count
        assert stamps[0] > last
        assert stamps == sorted(set(stamps))
        assert stamps[-1] <= arrival_ns
        last = stamps[-1]


def settled() -> tuple[ClockFilter, int, int]:
    """A filter after 4 s without jitter, with the times of the next frame."""
    clock = ClockFilter()
    for k in range(4000):
        assert clock.step(k * 1000, EPOCH_NS + k * MS) == EPOCH_NS + k * MS
    return clock, 4_000_000, EPOCH_NS + 4000 * MS


def test_a_restart_of_the_board_starts_the_estimate_anew() -> None:
    clock, _, arrival_ns = settled()
    assert clock.step(300, arrival_ns) == arrival_ns
    assert clock.step(1300, arrival_ns + 5 * MS) == arrival_ns + MS
    assert clock.state.resets == 1


def test_a_restart_within_one_read() -> None:
    clock, board_us, arrival_ns = settled()
    stamps = clock.step_batch([board_us, board_us + 1000, 0, 1000], arrival_ns + 10 * MS)
    assert stamps[:2] == [arrival_ns, arrival_ns + MS]
    assert stamps[2:] == [arrival_ns + 9 * MS, arrival_ns + 10 * MS]
    assert clock.state.resets == 1


def test_the_boards_clock_jumps_forward() -> None:
    clock, board_us, arrival_ns = settled()
    assert clock.step(board_us + 3_000_000, arrival_ns) == arrival_ns
    assert clock.state.resets == 1


@pytest.mark.parametrize("begins_anew", [False, True])
def test_a_first_frame_that_is_read_late_is_no_jump(begins_anew: bool) -> None:
    # Of a slow board: the frames of a fast one would have come together with the next.
    clock = ClockFilter()
    if begins_anew:
        clock.step(0, EPOCH_NS)
        clock.host_was_set()
    before = clock.state.resets
    clock.step(1_000_000, EPOCH_NS + 1200 * MS)
    assert clock.step(2_000_000, EPOCH_NS + 2000 * MS) == EPOCH_NS + 2000 * MS
    assert clock.step(3_000_000, EPOCH_NS + 3100 * MS) == EPOCH_NS + 3000 * MS
    assert clock.state.resets == before
    # The next one is.
    assert clock.step(5_000_000, EPOCH_NS + 4000 * MS) == EPOCH_NS + 4000 * MS
    assert clock.state.resets == before + 1


def test_the_hosts_clock_is_set_back() -> None:
    clock, board_us, arrival_ns = settled()
    assert clock.step(board_us, arrival_ns - 3_600_000 * MS) == arrival_ns - 3_600_000 * MS
    assert clock.state.resets == 1


def test_the_hosts_clock_is_set_forward() -> None:
    clock, board_us, arrival_ns = settled()
    for k in range(2100):
        stamp = clock.step(board_us + 1000 * k, arrival_ns + (3_600_000 + k) * MS)
    assert stamp == arrival_ns + (3_600_000 + 2099) * MS
    assert clock.state.resets == 1


def test_a_stall_of_five_seconds_is_no_jump() -> None:
    clock, board_us, arrival_ns = settled()
    backlog_us = [board_us + 1000 * k for k in range(16)]
    assert clock.step_batch(backlog_us, arrival_ns + 5000 * MS) == [arrival_ns + k * MS for k in range(16)]
    for k in range(5000, 9000):
        assert abs(clock.step(board_us + 1000 * k, arrival_ns + k * MS) - (arrival_ns + k * MS)) < 10_000
    assert clock.state.resets == 0


def test_what_a_host_that_is_too_slow_reads_late_is_stamped_as_old_as_it_is() -> None:
    clock, board_us, arrival_ns = settled()
    # A terminal hands over 16 frames at a time. The host begins 1.5 s late, keeps up for 10 s, and then catches up.
    late_ms = 1500.0
    for k in range(0, 20_000, 16):
        read_us = [board_us + 1000 * (k + i) for i in range(16)]
        late_ms = max(late_ms - (8.0 if k > 10_000 else 0.0), 0.0)
        arrived_ns = arrival_ns + (k + 15) * MS + int(late_ms * MS)
        stamps = clock.step_batch(read_us, arrived_ns)
        assert abs(stamps[-1] - (arrival_ns + (k + 15) * MS)) < 10 * MS
    assert late_ms == 0
    assert clock.state.resets == 0


def test_large_frames_of_a_backlog_which_come_one_at_a_time_are_stamped_as_old_as_they_are() -> None:
    stream = FrameStream(32, 32, host_clock=HostClock(lambda: EPOCH_NS, lambda: 0))
    taxels = np.arange(1024, dtype=np.uint16)
    for k in range(6000):
        frame = SampleFrame(k, 2000 * k, 1900, Scheme.RASTER, 32, 32, 0, taxels, taxels)
        # From the fourth second on the host is half a second late; what it has not read waits.
        late_ms = 0 if k < 2000 else 500
        arrival_ns = EPOCH_NS + (2 * k + late_ms) * MS
        ((_, stamp_ns),) = stream.accept([frame], arrival_ns, partial(gt, late_ms, 0))
        assert abs(stamp_ns - (EPOCH_NS + 2 * k * MS)) < 10 * MS
    assert stream.clock.state.resets == 0
    # Small ones would come many at a time: one that is followed by another is no backlog.
    small = FrameStream(32, 32, host_clock=HostClock(lambda: EPOCH_NS, lambda: 0))
    for k in range(6000):
        frame = SampleFrame(k, 2000 * k, 1900, Scheme.ADAPTIVE, 32, 32, 0, taxels[:55], taxels[:55])
        small.accept([frame], EPOCH_NS + (2 * k + (0 if k < 2000 else 500)) * MS, lambda: True)
    assert small.clock.state.resets == 1


def test_slope_of_the_lower_hull() -> None:
    assert hull_slope([(0, 5)]) == 0
    assert hull_slope([(0, 0), (1, 9), (2, 2), (3, 9), (4, 4)]) == 1
    assert hull_slope([(0, 4), (2, 0), (3, 50), (8, 6)]) == 1
