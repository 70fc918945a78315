# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The choice of an atom against NumPy."""

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_recon.sparse import in_blocks
from acts_recon.sparse.fastomp_kernels import choose
from acts_recon.sparse.fastomp_model import BLOCK


def find(
    A: NDArray[np.float32], pixels: NDArray[np.integer], residuals: NDArray[np.float32], counts: list[int]
) -> list[int]:
    n = len(counts)
    # Every problem but the first, last one first: what is not asked for must stay as it was.
    problems = np.arange(n - 1, 0, -1, dtype=np.int32)
    best = np.full(n, -7, dtype=np.int32)
    sums, largest = np.full(BLOCK, np.nan, dtype=np.float32), np.full(n, np.nan, dtype=np.float32)
    numbers = np.array(counts, dtype=np.int32)
    choose(in_blocks(A), pixels.astype(np.uint32), residuals, numbers, problems, n - 1, sums, largest, best)
    assert best[0] == -7
    return [int(column) for column in best[1:]]


@pytest.mark.parametrize("columns", [1, 16, BLOCK - 1, BLOCK, BLOCK + 1, 1000, 1025])
def test_the_best_column_is_that_of_numpy(columns: int) -> None:
    rng = np.random.default_rng(columns)
    A = rng.standard_normal((64, columns)).astype(np.float32)
    counts = list(range(65))
    pixels = np.array([rng.permutation(64) for _ in counts])
    residuals = rng.standard_normal((65, 64)).astype(np.float32)
    for m, column in enumerate(find(A, pixels, residuals, counts), 1):
        correlation = np.abs(residuals[m, :m] @ A[pixels[m, :m]])
        assert correlation[column] == pytest.approx(correlation.max(), rel=1e-5)


def test_of_equal_columns_the_first_is_taken() -> None:
    A = np.zeros((3, 200), dtype=np.float32)
    A[1, [7, 70, 71, 199]] = [-2, 2, 2, -2]
    pixels, ones = np.tile(np.arange(3), (2, 1)), np.ones((2, 3), dtype=np.float32)
    assert find(A, pixels, ones, [3, 3]) == [7]
    A[:, 7] = 0
    assert find(A, pixels, ones, [3, 3]) == [70]


def test_of_many_equal_columns_the_first_is_taken() -> None:
    # Steps and boxes are alike on a few pixels: whatever their neighbours in memory are, the first one counts.
    rng = np.random.default_rng(0)
    A = rng.integers(-1, 2, (16, 500)).astype(np.float32)
    counts = [0, *rng.integers(1, 5, 60).tolist()]
    pixels = np.array([rng.permutation(16) for _ in counts])
    residuals = rng.integers(1, 4, (61, 16)).astype(np.float32)
    found = find(A, pixels, residuals, counts)
    expected = [int(np.argmax(np.abs(residuals[k, :m] @ A[pixels[k, :m]]))) for k, m in enumerate(counts) if k > 0]
    assert found == expected


def test_without_any_correlation_there_is_no_best_column() -> None:
    A = np.eye(4, dtype=np.float32)
    residuals = np.array([[1, 1, 1, 1], [0, 0, 0, 0], [1, 1, 1, 1], [np.nan] * 4, [0, 0, 3, 0]], dtype=np.float32)
    assert find(A, np.tile(np.arange(4), (5, 1)), residuals, [4, 4, 0, 4, 4]) == [-1, -1, -1, 2]


def test_blocks_begin_at_a_line_of_the_cache() -> None:
    for size in (1, 5, 8):
        blocks = in_blocks(np.ones((size, BLOCK + 6), dtype=np.float32))
        assert blocks.ctypes.data % 64 == 0
        assert blocks.shape == (2, size, BLOCK)
        assert blocks.sum() == size * (BLOCK + 6)
