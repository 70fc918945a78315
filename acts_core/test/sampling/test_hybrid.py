# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Hybrid sampling: adaptive for its quota, then random among what is left."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.sampling import NEIGHBOURS, Sampler, SamplingConfig, measure_in
from acts_core.sampling.schemes.adaptive import adaptive


def test_the_quota_is_the_share_rounded_up() -> None:
    cases = [(55, 0.5), (56, 0.5), (55, 0.0001), (55, 1.0), (1, 0.5)]
    assert [SamplingConfig("hybrid", m=m, adaptive_share=share).adaptive_quota for m, share in cases] == [
        28,
        28,
        1,
        55,
        1,
    ]


@pytest.mark.parametrize("share", [0.0, -0.5, 1.01, float("nan")])
def test_shares_that_are_none_are_refused(share: float) -> None:
    with pytest.raises(SettingsError, match="adaptive_share"):
        SamplingConfig("hybrid", adaptive_share=share)


@settings(max_examples=60, deadline=None)
@given(
    st.integers(1, 20),
    st.integers(1, 20),
    st.floats(0.0001, 1.0),
    st.sampled_from(sorted(NEIGHBOURS)),
    st.integers(0, 2**32 - 1),
)
def test_a_frame_is_an_adaptive_one_and_distinct_others(
    rows: int, cols: int, share: float, order: str, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, rows * cols + 1))
    config = SamplingConfig("hybrid", rows, cols, m, neighbour_order=order, seed=seed, adaptive_share=share)
    sampler = Sampler(config)
    for _ in range(4):
        field = rng.integers(0, 400, (rows, cols))
        indices, counts = sampler.frame(measure_in(field))
        quota = config.adaptive_quota
        expected, _ = adaptive(measure_in(field), rows, cols, quota, neighbour_order=order)
        assert indices[:quota].tolist() == expected.tolist()
        assert len(set(indices.tolist())) == len(indices) == m
        assert counts.tolist() == field.ravel()[indices].tolist()
        assert indices.dtype == counts.dtype == np.uint16


def test_all_taxels_that_are_left_are_equally_likely() -> None:
    config = SamplingConfig("hybrid", 5, 5, 10, adaptive_share=0.5)
    field = np.zeros((5, 5), dtype=int)
    sampler = Sampler(config)
    frames = 4000
    drawn = np.zeros(25, dtype=int)
    for _ in range(frames):
        drawn[sampler.frame(measure_in(field))[0][5:]] += 1
    found, _ = adaptive(measure_in(field), 5, 5, 5)
    assert drawn[found].tolist() == [0] * 5
    # Five of the twenty others in each frame; six standard deviations.
    others = np.delete(drawn, found)
    assert np.abs(others - frames / 4).max() < 6 * np.sqrt(frames * 0.25 * 0.75)


def test_the_seed_decides_what_is_drawn() -> None:
    field = measure_in(np.zeros((32, 32), dtype=int))
    first, second, other = (Sampler(SamplingConfig("hybrid", seed=seed)) for seed in (7, 7, 8))
    frames = [[sampler.frame(field)[0].tolist() for _ in range(3)] for sampler in (first, second, other)]
    assert frames[0] == frames[1] != frames[2]
    assert len({tuple(frame) for frame in frames[0]}) == 3


def test_a_share_of_one_is_adaptive_sampling() -> None:
    field = np.full((32, 32), 500)
    indices, _ = Sampler(SamplingConfig("hybrid", adaptive_share=1.0)).frame(measure_in(field))
    assert indices.tolist() == adaptive(measure_in(field), 32, 32, 55)[0].tolist()
