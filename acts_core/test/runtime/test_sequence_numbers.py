# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is missing in numbered streams, of one source and of two that mix."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.runtime import SequenceNumbers

MODULUS = 2**32


def followed(numbers: Sequence[int]) -> tuple[list[int], int]:
    stream = SequenceNumbers()
    missing = [stream.step(number % MODULUS) for number in numbers]
    return missing, stream.lost


@pytest.mark.parametrize(
    ("numbers", "missing"),
    [
        ((), []),
        ((7,), [0]),
        ((7, 8, 9), [0, 0, 0]),
        ((7, 10, 11, 14), [0, 2, 0, 2]),
        ((-2, -1, 0, 2, 3), [0, 0, 0, 1, 0]),
        ((5000, 0, 1, 3), [0, 0, 0, 1]),
        ((-1, 2, 3, 0, 1), [0, 2, 0, 0, 0]),
        ((3, 3, 4, 4, 6), [0, 0, 0, 0, 1]),
        ((0, 2, 2, 3), [0, 1, 0, 0]),
    ],
    ids=[
        "nothing",
        "one",
        "none missing",
        "gaps",
        "wrap",
        "began anew",
        "began anew where numbers are missing",
        "repeated",
        "repeated after a gap",
    ],
)
def test_of_one_source_every_gap_counts(numbers: tuple[int, ...], missing: list[int]) -> None:
    assert followed(numbers) == (missing, sum(missing))


@given(st.integers(0, MODULUS - 1), st.lists(st.integers(1, 2**20), max_size=40))
def test_losses_of_one_source_add_up(first: int, steps: list[int]) -> None:
    numbers = [first]
    for step in steps:
        numbers.append(numbers[-1] + step)
    gaps = [after - before - 1 for before, after in pairwise(numbers)]
    assert followed(numbers) == ([0, *gaps], sum(gaps))


@given(
    st.integers(0, MODULUS - 1),
    st.integers(2000, MODULUS - 2000),
    st.lists(st.integers(1, 8), min_size=3, max_size=40),
)
def test_numbers_of_two_sources_that_mix_are_no_losses(first: int, off: int, bursts: list[int]) -> None:
    places = [first, first + off]
    stream = SequenceNumbers()
    for turn, burst in enumerate(bursts):
        for _ in range(burst):
            stream.step(places[turn % 2] % MODULUS)
            places[turn % 2] += 1
        # When the second appears, it cannot be told from a loss.
        assert stream.lost == 0 or turn == 1


def test_of_two_sources_one_may_pass_the_largest_number() -> None:
    assert followed([*range(-8, 0), 1992, 0, 1993, 1])[1] == 0


def test_what_two_sources_lose_is_counted() -> None:
    assert followed([1000, 500_000, 1001, 500_001, 1003, 500_002, 1004, 500_007])[1] == 1 + 4


def test_two_sources_that_are_close_to_one_another() -> None:
    numbers = [number for step in range(100) for number in (1000 + step, 1030 + step)]
    assert followed(numbers)[1] == 0


def test_a_message_that_was_overtaken_is_not_lost() -> None:
    assert followed([10, 12, 11, 13, 14])[1] == 0
