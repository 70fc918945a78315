# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tracking sampling: what it promises, on contacts that come, slide and go."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_core.sampling.basis import dither_order

pytestmark = pytest.mark.slow

THRESHOLD = 180


def contact(row: int, col: int, side: int = 3, counts: int = 500) -> NDArray[np.int64]:
    """A square contact on 32 x 32 with its first taxel at (row, col)."""
    field = np.zeros((32, 32), dtype=np.int64)
    field[row : row + side, col : col + side] = counts
    return field


def run(sampler: Sampler, field: NDArray[np.integer], frames: int) -> list[set[int]]:
    """The taxels of each of the next frames on a still field."""
    return [set(sampler.frame(measure_in(field))[0].tolist()) for _ in range(frames)]


def pressed(field: NDArray[np.integer]) -> set[int]:
    return set(np.flatnonzero(field > THRESHOLD).tolist())


def with_ring(taxels: set[int], rows: int, cols: int) -> set[int]:
    """These taxels and their neighbours."""
    return {
        row * cols + col
        for index in taxels
        for row in range(max(index // cols - 1, 0), min(index // cols + 2, rows))
        for col in range(max(index % cols - 1, 0), min(index % cols + 2, cols))
    }


def test_quota_is_the_share_rounded_up() -> None:
    cases = [(55, 0.2), (56, 0.2), (55, 0.0001), (1, 0.2), (55, 1.0), (1024, 0.0001)]
    quotas = [SamplingConfig("tracking", m=m, search_share=share).search_quota for m, share in cases]
    assert quotas == [11, 12, 1, 1, 55, 1]


@pytest.mark.parametrize("share", [0.0, -0.1, 1.01, float("nan")])
def test_shares_that_are_none_are_refused(share: float) -> None:
    with pytest.raises(SettingsError, match="search_share"):
        SamplingConfig("tracking", search_share=share)


def test_untouched_it_walks_the_order_of_search_from_frame_to_frame() -> None:
    sampler = Sampler(SamplingConfig("tracking"))
    walked = [index for _ in range(40) for index in sampler.frame(measure_in(np.zeros((32, 32), dtype=int)))[0]]
    assert walked == np.resize(dither_order(32, 32), 40 * 55).tolist()


def test_the_search_goes_on_then_a_found_contact_and_its_ring_end_the_frame_row_by_row() -> None:
    field = contact(16, 16, side=1)  # in the first lattice of the search
    order = dither_order(32, 32).tolist()
    sampler = Sampler(SamplingConfig("tracking"))
    while not (sampler.frame(measure_in(field))[1] > 180).any():
        pass
    indices, counts = sampler.frame(measure_in(field))
    around = [row * 32 + col for row in (15, 16, 17) for col in (15, 16, 17)]
    assert indices[-9:].tolist() == around
    assert counts[-9:].tolist() == [0, 0, 0, 0, 500, 0, 0, 0, 0]
    start = order.index(indices[0])
    searched = [index for index in order[start:] + order[:start] if index not in around]
    assert indices[:-9].tolist() == searched[:46]


def test_what_the_search_finds_is_seen_whole_in_the_same_frame_after_the_search_had_its_share() -> None:
    field = contact(1, 1, side=4)  # rows and columns 1 to 4; 4, 4 is the tenth taxel of the search
    sampler = Sampler(SamplingConfig("tracking"))
    indices, _ = sampler.frame(measure_in(field))
    assert indices[:11].tolist() == dither_order(32, 32)[:11].tolist()
    assert with_ring(pressed(field), 32, 32) <= set(indices.tolist())


def test_candidates_that_do_not_fit_are_taken_in_turns() -> None:
    field = np.full((4, 4), 500)
    sampler = Sampler(SamplingConfig("tracking", 4, 4, 5, search_share=0.4))
    for _ in range(8):  # finds all 16
        sampler.frame(measure_in(field))
    followed = [sampler.frame(measure_in(field))[0][-3:].tolist() for _ in range(16)]
    flat = [index for frame in followed for index in frame]
    assert all(after == (before + 1) % 16 for before, after in pairwise(flat))


@settings(max_examples=100, deadline=None)
@given(st.integers(1, 12), st.integers(1, 12), st.floats(0.0001, 1.0), st.integers(0, 2**32 - 1), st.booleans())
def test_guarantees_on_changing_fields(rows: int, cols: int, share: float, seed: int, noise: bool) -> None:
    rng = np.random.default_rng(seed)
    taxels = rows * cols
    config = SamplingConfig("tracking", rows, cols, int(rng.integers(1, taxels + 1)), search_share=share)
    follow_quota = config.m - config.search_quota
    longest = -(-taxels // config.search_quota)
    sampler = Sampler(config)
    last_count = np.zeros(taxels, dtype=int)
    unseen = np.zeros(taxels, dtype=int)  # frames since each taxel was measured
    # For each candidate, which taxels were candidates since it became one or was last measured, and for how long.
    waiting: dict[int, tuple[int, set[int]]] = {}
    field = rng.integers(0, 360, (rows, cols))
    for frame in range(min(longest + 10, 60)):
        if noise or frame % 5 == 0:
            field = rng.integers(0, 360, (rows, cols))
        candidates = with_ring(set(np.flatnonzero(last_count > THRESHOLD).tolist()), rows, cols)
        waited = {index: waiting.get(index, (0, set())) for index in candidates}
        waiting = {index: (frames + 1, others | candidates) for index, (frames, others) in waited.items()}

        indices, counts = sampler.frame(measure_in(field))

        measured = indices.tolist()
        assert len(measured) == len(set(measured)) == config.m
        assert counts.tolist() == field.ravel()[indices].tolist()
        last_count[indices] = counts
        unseen += 1
        unseen[indices] = 0
        assert unseen.max() < longest
        for index in measured:
            waiting.pop(index, None)
        for frames, others in waiting.values():
            assert follow_quota == 0 or frames < -(-len(others) // follow_quota)


@pytest.mark.parametrize("step", [(0, 1), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)])
@pytest.mark.parametrize("phase", range(4))
def test_a_sliding_contact_is_not_lost(step: tuple[int, int], phase: int) -> None:
    sampler = Sampler(SamplingConfig("tracking"))
    found_at = None
    for frame in range(48):
        moved = (frame + phase) // 4
        field = contact(14 + step[0] * moved, 14 + step[1] * moved)
        indices = set(sampler.frame(measure_in(field))[0].tolist())
        if found_at is None and indices & pressed(field):
            found_at = frame
        if found_at is not None:
            assert indices & pressed(field)
            if frame >= found_at + 3:
                assert pressed(field) <= indices
    assert found_at is not None


def test_a_second_contact_is_noticed_within_the_guaranteed_number_of_frames() -> None:
    config = SamplingConfig("tracking")
    longest = -(-1024 // config.search_quota)
    assert longest == 94
    rng = np.random.default_rng(2)
    for _ in range(20):
        sampler = Sampler(config)
        first = contact(14, 14, side=5)
        run(sampler, first, int(rng.integers(20, 120)))
        row, col = (int(value) for value in rng.integers(20, 32, 2))
        both = first + contact(row, col, side=1)
        assert row * 32 + col in set.union(*run(sampler, both, longest))


def test_a_contact_larger_than_a_frame_is_followed_whole_and_the_search_goes_on() -> None:
    config = SamplingConfig("tracking")
    sampler = Sampler(config)
    field = contact(8, 8, side=16)
    run(sampler, field, 200)
    candidates = with_ring(pressed(field), 32, 32)
    assert candidates <= set.union(*run(sampler, field, -(-len(candidates) // 44)))
    assert set.union(*run(sampler, field, 94)) == set(range(1024))


@pytest.mark.parametrize("side", [1, 3, 12])
def test_after_release_the_flags_clear(side: int) -> None:
    sampler = Sampler(SamplingConfig("tracking"))
    field = contact(12, 12, side=side)
    run(sampler, field, 120)
    nothing = np.zeros_like(field)
    run(sampler, nothing, -(-len(with_ring(pressed(field), 32, 32)) // 44))
    # Nothing is followed any more: frames are one walk through the order of search again.
    order = dither_order(32, 32).tolist()
    walked = [index for _ in range(20) for index in sampler.frame(measure_in(nothing))[0].tolist()]
    start = order.index(walked[0])
    assert walked == [order[(start + i) % 1024] for i in range(len(walked))]


def test_a_share_of_one_only_searches() -> None:
    sampler = Sampler(SamplingConfig("tracking", search_share=1.0))
    walked = [index for _ in range(30) for index in sampler.frame(measure_in(np.full((32, 32), 900)))[0]]
    assert walked == np.resize(dither_order(32, 32), 30 * 55).tolist()
