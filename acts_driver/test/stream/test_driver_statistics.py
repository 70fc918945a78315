# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Gaps, wraps, restarts, repetitions and the rate; what of it is published."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from pty_board import frame

from acts_driver.stream import FrameStream
from acts_driver.stream.statistics import StreamStatistics

MS = 1_000_000
T0 = 1_700_000_000_000 * MS


def fed(*frames: tuple[int, int]) -> StreamStatistics:
    """Statistics over (sequence, board milliseconds); arrival follows the board's clock."""
    statistics = StreamStatistics()
    for sequence, board_ms in frames:
        statistics.observe(sequence, board_ms * 1000, 0, T0 + board_ms * MS)
    return statistics


@pytest.mark.parametrize(
    ("frames", "lost", "repeated", "restarts"),
    [
        ([(7, 100), (8, 101), (9, 102)], 0, 0, 0),
        ([(7, 100), (10, 103)], 2, 0, 0),
        ([(2**32 - 1, 100), (0, 101)], 0, 0, 0),
        ([(2**32 - 2, 100), (1, 103)], 2, 0, 0),
        ([(7000, 9000), (0, 1), (1, 2)], 0, 0, 1),
        ([(5, 9), (0, 1), (1, 2)], 0, 0, 1),
        ([(0, 5), (0, 1), (1, 2)], 0, 0, 1),
        ([(7000, 9000), (7005, 30)], 0, 0, 1),
        ([(7, 100), (8, 101), (8, 101), (9, 102)], 0, 1, 0),
        ([(7, 100), (8, 101), (7, 100), (8, 101), (9, 102)], 0, 2, 0),
        ([(7, 100), (9, 102), (8, 101), (10, 103)], 1, 1, 0),
        ([(2**32 - 1, 100), (0, 101), (2**32 - 1, 100)], 0, 1, 0),
    ],
)
def test_what_is_counted(frames: list[tuple[int, int]], lost: int, repeated: int, restarts: int) -> None:
    statistics = fed(*frames)
    assert (statistics.lost, statistics.repeated, statistics.restarts) == (lost, repeated, restarts)
    assert statistics.frames == len(frames) - repeated


def test_after_a_reconnection_the_clock_tells_a_gap_from_a_restart() -> None:
    statistics = fed((7, 100), (8, 101))
    statistics.reconnected()
    assert statistics.observe(3008, 3_101_000, 0, T0 + 3_101 * MS)
    assert (statistics.lost, statistics.restarts) == (2999, 0)
    # Off for 10 s, then on for 5 s: further than it ever was before, yet nothing was lost.
    statistics.reconnected()
    assert statistics.observe(5000, 5_000_000, 0, T0 + 18_101 * MS)
    assert (statistics.lost, statistics.restarts) == (2999, 1)


def test_a_frame_that_waited_to_be_read_after_a_reconnection_is_of_no_restarted_board() -> None:
    statistics = fed((1007, 1000), (1008, 1001))
    statistics.reconnected()
    assert statistics.observe(1308, 1_301_000, 0, T0 + 1_701 * MS)
    assert (statistics.lost, statistics.restarts) == (299, 0)


def test_rate_of_the_last_second() -> None:
    statistics = StreamStatistics()
    for k in range(3000):
        statistics.observe(k, 1000 * k, 0, T0 + k * MS)
    assert statistics.rate_hz(T0 + 3000 * MS) == pytest.approx(1000)
    assert statistics.rate_hz(T0 + 3500 * MS) == pytest.approx(500)
    assert statistics.rate_hz(T0 + 4200 * MS) == 0
    assert StreamStatistics().rate_hz(T0) == 0


def test_the_rate_is_taken_between_two_frames_of_the_thread_that_counts() -> None:
    statistics = StreamStatistics()
    for k in range(2000):
        statistics.observe(k, 1000 * k, 0, T0 + k * MS)
    with ThreadPoolExecutor(1) as pool:
        with statistics.lock:
            rate_hz = pool.submit(statistics.rate_hz, T0 + 3000 * MS)
            for k in range(2000, 3000):
                statistics.observe(k, 1000 * k, 0, T0 + k * MS)
        assert rate_hz.result(10.0) == pytest.approx(1000)


def test_a_frame_of_another_size_is_dropped_and_counted_but_not_lost() -> None:
    stream = FrameStream(32, 32)
    frames = [frame(0), frame(1, rows=16, cols=24), frame(2)]
    accepted = stream.accept(frames, T0)
    assert [one.sequence for one, _ in accepted] == [0, 2]
    assert (stream.wrong_size, stream.wrong_size_last) == (1, (16, 24))
    assert (stream.statistics.frames, stream.statistics.lost) == (3, 0)
    assert accepted[1][1] - accepted[0][1] == 2 * MS


def test_a_doubled_frame_is_published_once() -> None:
    stream = FrameStream(32, 32)
    assert len(stream.accept([frame(0), frame(0), frame(1)], T0)) == 2
    assert stream.accept([frame(1)], T0 + MS) == []
    assert stream.statistics.repeated == 2


def test_without_a_board_clock_stamps_are_arrivals() -> None:
    stream = FrameStream(32, 32, has_board_clock=False)
    frames = [frame(k)._replace(board_us=0) for k in range(2)]
    assert [stamp for _, stamp in stream.accept(frames, T0)] == [T0 - 1, T0]
    assert stream.clock.state.resets == 0


def test_without_a_board_clock_a_reconnection_is_no_restart() -> None:
    # The scans of one line after another, which leave out how long the port was gone.
    stream = FrameStream(32, 32, has_board_clock=False)
    stream.accept([frame(0)], T0)
    stream.reconnected()
    stream.accept([frame(1)], T0 + 3000 * MS)
    stream.accept([frame(4)], T0 + 3001 * MS)
    assert (stream.statistics.restarts, stream.statistics.lost) == (0, 2)


def test_the_boards_overruns_are_told() -> None:
    stream = FrameStream(32, 32)
    stream.accept([frame(0)._replace(overruns=12)], T0)
    assert stream.statistics.overruns == 12
