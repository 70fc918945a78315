# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What continues a stream, what begins it anew, and frames of two sources in turn."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from acts_recon.frame_order import FrameOrder


def followed(places: Iterable[tuple[int, int]]) -> tuple[list[bool], int]:
    """Which frames began anew, and how often the source changed."""
    order = FrameOrder()
    return [order.step(sequence % 2**32, time_us) for sequence, time_us in places], order.changes


def source(first: int, first_us: int, frames: int) -> list[tuple[int, int]]:
    return [(first + number, first_us + 1000 * number) for number in range(frames)]


def test_gaps_and_the_largest_number_continue_a_stream() -> None:
    assert followed([(-3, 1000), (-1, 3000), (0, 4000), (900, 904_000)]) == ([False] * 4, 0)


@pytest.mark.parametrize("first_us", [0, 600_000_000], ids=["clock begins anew, too", "clock goes on"])
@pytest.mark.parametrize("first", [0, 7])
def test_boards_that_begin_anew_are_no_second_source(first: int, first_us: int) -> None:
    lives = [source(500 * (life == 0) + first, life * first_us, 600) for life in range(4)]
    anew, changes = followed([place for life in lives for place in life])
    assert [number for number, is_anew in enumerate(anew) if is_anew] == [600, 1200, 1800]
    assert changes == 0


@pytest.mark.parametrize("early_us", [-300, -20, 0, 20, 300])
def test_a_board_that_begins_anew_twice_at_once_is_no_second_source(early_us: int) -> None:
    """As one whose supply fails while it starts: its third life comes by the number that the second one ended with."""
    lives = (source(1000, 1_000_000, 600), source(0, 1000, 30), source(0, 1000 - early_us, 200))
    anew, changes = followed([place for life in lives for place in life])
    assert [number for number, is_anew in enumerate(anew) if is_anew] == [600, 630]
    assert changes == 0


@pytest.mark.parametrize(
    ("first", "first_us"),
    [(5, 900_000), (6, 5_300), (90_000, 5_300), (700, 70_000_000), (4, 5_300)],
    ids=["same numbers", "close", "ahead", "another clock", "behind"],
)
def test_two_sources_in_turn_are_told(first: int, first_us: int) -> None:
    turns = zip(source(5, 5000, 100), source(first, first_us, 100), strict=True)
    assert followed([place for turn in turns for place in turn])[1] >= 97


def test_numbers_that_stand_still_begin_anew_each_time() -> None:
    order = FrameOrder()
    assert [order.step(7, 1000 * number) for number in range(5)] == [False, True, True, True, True]
    assert (order.restarts, order.changes) == (4, 0)


def test_two_sources_may_come_in_bursts() -> None:
    ours, theirs = source(5, 5000, 99), source(90_000, 5300, 99)
    bursts = [place for at in range(0, 99, 3) for place in (*ours[at : at + 3], *theirs[at : at + 3])]
    assert followed(bursts)[1] >= 60
