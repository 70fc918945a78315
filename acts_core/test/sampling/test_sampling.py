# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from published_spacing import PUBLISHED_SPACING

from acts_core.errors import ArrayError, SettingsError
from acts_core.sampling import NEIGHBOURS, SCHEMES, Sampler, SamplingConfig, SkinMap, measure_in
from acts_core.sampling.basis import Pcg32, division_order
from acts_core.sampling.schemes.adaptive import adaptive
from acts_core.sampling.schemes.random_taxels import RandomTaxels
from acts_core.sampling.schemes.uniform import uniform, uniform_spacing


def arrays(path: Path) -> dict[str, NDArray]:
    with np.load(path) as archive:
        return dict(archive)


def positions(indices: NDArray[np.uint16], cols: int) -> list[tuple[int, int]]:
    return [divmod(index, cols) for index in indices.tolist()]


def test_division_order_begins_as_published() -> None:
    assert positions(division_order(32, 32)[:15], 32) == [
        (16, 16),
        *[(16, 8), (16, 24)],
        *[(8, 8), (24, 8), (8, 24), (24, 24)],
        *[(8, 4), (8, 12), (24, 4), (24, 12), (8, 20), (8, 28), (24, 20), (24, 28)],
    ]


@given(st.integers(1, 64), st.integers(1, 64))
def test_division_order_lists_every_taxel_once(rows: int, cols: int) -> None:
    assert sorted(division_order(rows, cols).tolist()) == list(range(rows * cols))


def test_long_arrays_are_divided_into_squares_first() -> None:
    assert positions(division_order(64, 16)[:7], 16) == [
        (32, 8),
        *[(16, 8), (48, 8)],
        *[(8, 8), (24, 8), (40, 8), (56, 8)],
    ]


def test_neighbour_orders() -> None:
    field = np.zeros((3, 3), dtype=int)
    field[1, 1] = 500
    for order, expected in (("columns", [4, 1, 7, 0, 3, 6, 2, 5, 8]), ("rows", [4, 0, 1, 2, 3, 5, 6, 7, 8])):
        indices, _ = adaptive(measure_in(field), 3, 3, 9, neighbour_order=order)
        assert indices.tolist() == expected


def test_search_goes_deep_before_wide() -> None:
    field = np.zeros((4, 4), dtype=int)
    field[2, 2] = field[1, 2] = 500
    indices, counts = adaptive(measure_in(field), 4, 4, 5)
    # (1, 2) is the first neighbour of (2, 2) and pressed: its own neighbours come before the other ones of (2, 2).
    assert positions(indices, 4) == [(2, 2), (1, 2), (0, 2), (0, 1), (1, 1)]
    assert counts.tolist() == [500, 500, 0, 0, 0]


def test_the_threshold_itself_is_no_touch() -> None:
    field = np.full((8, 8), 180)
    untouched, _ = adaptive(measure_in(field), 8, 8, 10, threshold_counts=180)
    assert untouched.tolist() == division_order(8, 8)[:10].tolist()
    touched, _ = adaptive(measure_in(field), 8, 8, 10, threshold_counts=179)
    assert touched.tolist() != untouched.tolist()


@settings(max_examples=40)
@given(st.integers(1, 20), st.integers(1, 20), st.integers(0, 2**32 - 1), st.sampled_from(sorted(NEIGHBOURS)))
def test_adaptive_measures_exactly_m_distinct_taxels(rows: int, cols: int, seed: int, order: str) -> None:
    rng = np.random.default_rng(seed)
    field = rng.integers(0, 1024, (rows, cols))
    m = int(rng.integers(1, rows * cols + 1))
    indices, counts = adaptive(measure_in(field), rows, cols, m, neighbour_order=order)
    assert len(set(indices.tolist())) == m
    assert counts.tolist() == field.ravel()[indices].tolist()


def test_a_palm_on_the_largest_array() -> None:
    indices, _ = adaptive(lambda row, col: 1000, 64, 64, 4096)
    assert len(set(indices.tolist())) == 4096


@pytest.mark.parametrize(("m", "spacing"), PUBLISHED_SPACING.items())
def test_published_uniform_spacing(m: int, spacing: tuple[int, int]) -> None:
    assert uniform_spacing(32, 32, m) == spacing
    seen: set[int] = set()
    for frame in range(spacing[0] * spacing[1]):
        indices = uniform(32, 32, m, frame).tolist()
        assert len(set(indices)) == m
        seen.update(indices)
    assert seen == set(range(1024))


def test_uniform_grid_falling_off_the_array_takes_its_edge() -> None:
    # 32 rows at spacing 5 from row 4: 4, 9, .., 29, and 34 is none.
    assert (uniform(32, 32, 49, 20).reshape(7, 7)[:, 0] // 32).tolist() == [4, 9, 14, 19, 24, 29, 31]


def test_impossible_uniform_m_names_the_nearest() -> None:
    with pytest.raises(SettingsError, match="49 and 55"):
        SamplingConfig(scheme="uniform", m=53)


def test_random_numbers_are_pcg32() -> None:
    # First outputs of the reference implementation's demonstration, seed 42, stream 54.
    random = Pcg32(42, 54)
    assert [random.next() for _ in range(6)] == [
        0xA15C02B7,
        0x7B47F409,
        0xBA1D3330,
        0x83D2F293,
        0xBFA4784B,
        0xCBED606E,
    ]


def test_random_taxels_are_distinct_and_all_equally_likely() -> None:
    taxels = RandomTaxels(SamplingConfig(rows=4, cols=5, m=5, seed=3), SkinMap.of_matrix(4, 5))
    counts = np.zeros(20, dtype=int)
    frames = 4000
    for _ in range(frames):
        drawn = taxels.draw(5)
        assert len(set(drawn.tolist())) == 5
        counts[drawn] += 1
    # A quarter of the frames each; six standard deviations.
    assert np.abs(counts - frames / 4).max() < 6 * np.sqrt(frames * 0.25 * 0.75)


@pytest.mark.parametrize("scheme", sorted(SCHEMES))
def test_sampler_measures_what_it_lists(scheme: str) -> None:
    rng = np.random.default_rng(1)
    sampler = Sampler(SamplingConfig(scheme=scheme, rows=6, cols=9, m=12))
    for _ in range(5):
        field = rng.integers(0, 1024, (6, 9))
        indices, counts = sampler.frame(measure_in(field))
        assert len(set(indices.tolist())) == (54 if scheme == "raster" else 12)
        assert counts.tolist() == field.ravel()[indices].tolist()
        assert indices.dtype == counts.dtype == np.uint16


def test_same_seed_same_random_frames() -> None:
    config = SamplingConfig(scheme="random", m=20, seed=2**64 - 1)
    field = measure_in(np.zeros((32, 32), dtype=int))
    first, second = Sampler(config), Sampler(config)
    assert [first.frame(field)[0].tolist() for _ in range(3)] == [second.frame(field)[0].tolist() for _ in range(3)]


def test_more_taxels_than_there_are_are_refused() -> None:
    with pytest.raises(SettingsError, match="25 taxels"):
        SamplingConfig(rows=5, cols=5, m=26)


def test_a_field_of_fractions_is_refused() -> None:
    with pytest.raises(ArrayError, match="whole counts"):
        measure_in(np.full((2, 2), 0.5))


def test_raster_is_row_by_row() -> None:
    field = [[10, 11, 12], [13, 14, 15]]
    indices, counts = Sampler(SamplingConfig("raster", 2, 3)).frame(measure_in(field))
    assert (indices.tolist(), counts.tolist()) == ([0, 1, 2, 3, 4, 5], [10, 11, 12, 13, 14, 15])


def test_published_adaptive_order_of_15_x_15(recording_path: Callable[[str], Path]) -> None:
    ranks = arrays(recording_path("paper/sampling_orders.npz"))["binSamOrd"]
    field = np.zeros((15, 15), dtype=int)
    # The two objects of Fig. S15C.
    field[(11, 11, 12, 12, 12), (5, 6, 4, 5, 6)] = 500
    field[(11, 11, 12, 12), (13, 14, 13, 14)] = 500
    indices, _ = adaptive(measure_in(field), 15, 15, 55)
    drawn = np.zeros(225, dtype=int)
    drawn[indices] = np.arange(1, 56)
    assert np.array_equal(drawn.reshape(15, 15), ranks)


def test_published_uniform_order(recording_path: Callable[[str], Path]) -> None:
    for frame, cutout in enumerate(arrays(recording_path("paper/sampling_orders.npz"))["downSamOrd"]):
        measured = np.zeros(1024, dtype=bool)
        measured[uniform(32, 32, 64, frame)] = True
        assert np.array_equal(measured.reshape(32, 32)[:10, :10], cutout > -5)


@pytest.mark.parametrize("m", [64, 128, 256])
def test_published_adaptive_frames(m: int, recording_path: Callable[[str], Path]) -> None:
    archive = arrays(recording_path("paper/frames.npz"))
    which = archive["names"].tolist().index(f"fig4__{m}_binary_raw")
    measured = archive["measured"][which]
    # What the board measured, and nothing elsewhere; the figure keeps values above 50 only.
    field = np.where(measured, archive["frames"][which], 0).astype(int)
    indices, _ = adaptive(measure_in(field), 32, 32, m, threshold_counts=50, neighbour_order="rows")
    assert set(indices.tolist()) == set(np.flatnonzero(measured).tolist())


@pytest.mark.parametrize("shape", [(4, 8), (8, 4), (0, 0)])
def test_a_field_smaller_than_the_array_is_refused(shape: tuple[int, int]) -> None:
    sampler = Sampler(SamplingConfig("uniform", 8, 8, 64))
    with pytest.raises(ArrayError, match=f"a field of {shape[0]} x {shape[1]}: give a field as large as the array"):
        sampler.frame(measure_in(np.zeros(shape, dtype=np.uint16)))
