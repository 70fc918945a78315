# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import ArrayError
from acts_recon.sparse import patch_layout, patch_starts


def test_the_papers_array_has_49_patches() -> None:
    layout = patch_layout(32, 32)
    assert layout.n_patches == 49
    assert layout.overlap.reshape(32, 32)[0, 0] == 1
    assert layout.overlap.reshape(32, 32)[0, 16] == 2
    assert layout.overlap.reshape(32, 32)[16, 16] == 4


def test_pixels_are_numbered_column_first() -> None:
    taxels = patch_layout(32, 32).taxels
    assert taxels[0, :9].tolist() == [0, 32, 64, 96, 128, 160, 192, 224, 1]
    assert taxels[1, 0] == 4
    assert taxels[7, 0] == 4 * 32


def test_the_last_patch_is_flush_with_the_edge() -> None:
    assert patch_starts(15, 8, 4) == [0, 4, 7]
    assert patch_starts(33, 8, 4) == [0, 4, 8, 12, 16, 20, 24, 25]
    assert patch_starts(8, 8, 4) == [0]


@settings(max_examples=30, deadline=None)
@given(rows=st.integers(4, 20), cols=st.integers(4, 20), size=st.integers(1, 4), data=st.data())
def test_every_taxel_is_covered_and_the_inverse_fits(rows: int, cols: int, size: int, data: st.DataObject) -> None:
    layout = patch_layout(rows, cols, size=size, step=data.draw(st.integers(1, size)))
    assert layout.overlap.min() >= 1
    assert np.array_equal(np.bincount(layout.taxels.ravel(), minlength=rows * cols), layout.overlap)
    for taxel in range(rows * cols):
        entries = slice(layout.entry_start[taxel], layout.entry_start[taxel + 1])
        assert (layout.taxels[layout.entry_patch[entries], layout.entry_pixel[entries]] == taxel).all()
    assert layout.entry_start[-1] == layout.taxels.size


@pytest.mark.parametrize(("size", "step", "word"), [(9, 4, "do not fit"), (0, 1, "do not fit"), (8, 9, "patch step 9")])
def test_patches_that_cannot_cover_the_array_are_refused(size: int, step: int, word: str) -> None:
    with pytest.raises(ArrayError, match=word):
        patch_layout(8, 20, size=size, step=step)
