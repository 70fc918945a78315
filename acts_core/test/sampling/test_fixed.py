# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fixed sampling: which taxels, in which order, and how often."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import Sampler, SamplingConfig, SkinMap, measure_in
from acts_core.skin import layout

FIELD = np.arange(1024).reshape(32, 32)


def sampled(config: SamplingConfig, skin_map: SkinMap | None = None) -> list[int]:
    sampler = Sampler(config, skin_map)
    frames = [sampler.frame(measure_in(FIELD)) for _ in range(3)]
    for indices, counts in frames:
        assert indices.tolist() == frames[0][0].tolist()
        assert counts.tolist() == FIELD.ravel()[indices].tolist()
    return frames[0][0].tolist()


def test_the_chosen_taxel_and_those_around_it_each_once() -> None:
    config = SamplingConfig("fixed", m=9, fixed_row=4, fixed_col=31)
    middle = 4 * 32 + 31
    assert sampled(config) == [middle + step for step in (0, -32, -1, 32, -33, 31, -64, -2, 64)]


def test_one_taxel_fills_a_frame_and_several_take_turns() -> None:
    assert sampled(SamplingConfig("fixed", m=50, fixed_row=3, fixed_col=5, fixed_taxels=1)) == [101] * 50
    assert sampled(SamplingConfig("fixed", m=1, fixed_row=3, fixed_col=5)) == [101]
    assert sampled(SamplingConfig("fixed", m=5, fixed_row=3, fixed_col=5, fixed_taxels=2)) == [101, 69, 101, 69, 101]


@given(st.integers(0, 31), st.integers(0, 31), st.integers(1, 1024), st.integers(0, 4096))
def test_no_taxel_has_more_than_one_turn_more_than_another(row: int, col: int, m: int, taxels: int) -> None:
    indices = sampled(SamplingConfig("fixed", m=m, fixed_row=row, fixed_col=col, fixed_taxels=taxels))
    _, turns = np.unique(indices, return_counts=True)
    assert turns.size == min(taxels or m, m)
    assert turns.max() - turns.min() <= 1


def test_neighbours_are_those_on_the_skin_and_those_of_its_patch_come_first() -> None:
    glove = layout("glove", 32, 32)
    row, col = divmod(int(glove.taxels[0, 0]), 32)
    config = SamplingConfig("fixed", m=200, fixed_row=row, fixed_col=col)
    indices = sampled(config, SkinMap.of(glove))
    patch = glove.patch_of_taxel.ravel()[indices]
    size = int((glove.patch_of == patch[0]).sum())
    assert (patch[:size] == patch[0]).all()
    assert set(indices[:3]) == {int(glove.taxels[place]) for place in ((0, 0), (0, 1), (1, 0))}


def test_a_taxel_outside_of_the_array_is_refused() -> None:
    with pytest.raises(SettingsError, match="fixed_row = 8: allowed is 0 to 7 of a fixed frame of 8 x 9 taxels"):
        SamplingConfig("fixed", 8, 9, 5, fixed_row=8)
    with pytest.raises(SettingsError, match="fixed_col = 9"):
        SamplingConfig("fixed", 8, 9, 5, fixed_col=9)
    SamplingConfig("adaptive", 8, 9, 5, fixed_row=8)  # another scheme does not use it


def frame(indices: list[int], scheme: Scheme = Scheme.FIXED) -> SampleFrame:
    taxels = np.array(indices, dtype=np.uint16)
    return SampleFrame(7, 1000, 90, scheme, 32, 32, 0, taxels, np.arange(taxels.size, dtype=np.uint16))


def test_once_keeps_the_last_sample_of_each_taxel() -> None:
    once = frame([5, 6, 7, 5, 6, 7, 5, 6, 6]).once()
    assert (once.indices.tolist(), once.counts.tolist(), once.duration_us) == ([7, 5, 6], [5, 6, 8], 30)
    other = frame([5, 6, 7], Scheme.ADAPTIVE)
    assert other.once() is other


@given(st.lists(st.integers(0, 20), max_size=30), st.integers(0, 30))
def test_once_takes_any_frame(indices: list[int], counts: int) -> None:
    given = frame(indices)._replace(counts=np.zeros(counts, dtype=np.uint16))
    once = given.once()
    assert once is given or len(set(once.indices.tolist())) == len(once.counts) == len(set(indices))
