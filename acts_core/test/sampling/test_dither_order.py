# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The order of search: every taxel once, and no block unseen for long."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.sampling.basis import dither_order


@given(st.integers(1, 64), st.integers(1, 64))
def test_it_holds_every_taxel_once(rows: int, cols: int) -> None:
    order = dither_order(rows, cols)
    assert order.dtype == np.uint16
    assert np.sort(order).tolist() == list(range(rows * cols))


@pytest.mark.parametrize(("side", "longest"), [(4, 73), (2, 448)])
def test_no_block_is_left_out_for_longer_than_stated(side: int, longest: int) -> None:
    rank = np.empty(1024, dtype=int)
    rank[dither_order(32, 32)] = np.arange(1024)
    gaps = []
    for row in range(33 - side):
        for col in range(33 - side):
            seen = np.sort(rank.reshape(32, 32)[row : row + side, col : col + side].ravel())
            gaps.append(np.diff(np.append(seen, seen[0] + 1024)).max())
    assert max(gaps) == longest
