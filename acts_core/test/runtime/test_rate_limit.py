# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from collections import Counter

import pytest

from acts_core.runtime import RateLimit, Turns


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


TOPICS = ["image", "confidence", "age"]


@pytest.mark.parametrize(("frame_rate_hz", "expected"), [(1000, 30), (100, 30), (50, 30), (20, 20)])
def test_of_several_outputs_each_is_due_so_many_times_a_second_whatever_the_frame_rate(
    frame_rate_hz: int, expected: int
) -> None:
    turns = Turns(30.0)
    due = [turns.due(50 + i / frame_rate_hz, TOPICS) for i in range(4 * frame_rate_hz)]
    counts = Counter(topic for topics in due for topic in topics)
    assert set(counts) == set(TOPICS)
    assert all(abs(count - 4 * expected) <= 2 for count in counts.values()), counts


def test_outputs_take_turns_where_there_are_frames_enough() -> None:
    turns = Turns(30.0)
    due = [turns.due(50 + i / 1000, TOPICS) for i in range(200)]
    assert max(map(len, due)) == 1
    assert [topics[0] for topics in due if topics][:6] == TOPICS * 2


def test_an_output_that_nobody_wants_any_more_is_not_due_in_the_next_round() -> None:
    turns = Turns(30.0)
    assert turns.due(1.0, TOPICS) == ["image"]
    rest = [turns.due(1.0 + i / 1000, []) for i in range(1, 100)]
    assert [topics for topics in rest if topics] == [["confidence"], ["age"]]
