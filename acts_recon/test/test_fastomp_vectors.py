"""The explicit vectors of FastOMP against NumPy."""

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from acts_recon.fastomp_kernels import in_blocks
from acts_recon.fastomp_vectors import LANES, best_column, dot, padded, subtract


@numba.njit
def best(blocks: NDArray[np.float32], pixels: NDArray[np.int64], residual: NDArray[np.float32], m: int) -> int:
    return best_column(blocks, pixels, residual, m)


@numba.njit
def inner(x: NDArray[np.float32], i: int, y: NDArray[np.float32], j: int, n: int) -> float:
    return dot(x, i, y, j, n)


@numba.njit
def take_off(x: NDArray[np.float32], i: int, share: float, y: NDArray[np.float32], j: int, n: int) -> None:
    subtract(x, i, np.float32(share), y, j, n)


@pytest.mark.parametrize("columns", [1, 63, 64, 65, 1000])
def test_the_best_column_is_that_of_numpy(columns: int) -> None:
    rng = np.random.default_rng(columns)
    A = rng.standard_normal((64, columns)).astype(np.float32)
    blocks = in_blocks(A)
    for m in range(1, 65):
        pixels = rng.permutation(64)
        residual = rng.standard_normal(64).astype(np.float32)
        correlation = np.abs(residual[:m] @ A[pixels[:m]])
        found = best(blocks, pixels, residual, m)
        assert correlation[found] == pytest.approx(correlation.max(), rel=1e-5)


def test_of_equal_columns_the_first_is_taken() -> None:
    A = np.zeros((3, 200), dtype=np.float32)
    A[1, [7, 70, 71, 199]] = [-2, 2, 2, -2]
    residual = np.ones(3, dtype=np.float32)
    assert best(in_blocks(A), np.arange(3), residual, 3) == 7
    A[:, 7] = 0
    assert best(in_blocks(A), np.arange(3), residual, 3) == 70


def test_without_any_correlation_there_is_no_best_column() -> None:
    A = np.eye(4, dtype=np.float32)
    assert best(in_blocks(A), np.arange(4), np.zeros(4, dtype=np.float32), 4) == -1
    assert best(in_blocks(A), np.arange(4), np.ones(4, dtype=np.float32), 0) == -1
    assert best(in_blocks(A), np.arange(4), np.full(4, np.nan, dtype=np.float32), 4) == -1


def test_rows_are_multiplied_and_subtracted() -> None:
    rng = np.random.default_rng(0)
    x = rng.standard_normal((3, 3 * LANES)).astype(np.float32)
    y = rng.standard_normal(3 * LANES).astype(np.float32)
    for n in (0, LANES, 2 * LANES):
        assert inner(x, 1, y, 0, n) == pytest.approx(float(x[1, :n] @ y[:n]), abs=1e-4)
        expected = x.copy()
        expected[2, :n] -= np.float32(0.7) * y[:n]
        take_off(x, 2, 0.7, y, 0, n)
        np.testing.assert_allclose(x, expected, rtol=1e-5, atol=1e-6)


def test_rows_are_filled_up_to_whole_vectors() -> None:
    assert [padded(n) for n in (0, 1, LANES, LANES + 1)] == [0, LANES, LANES, 2 * LANES]


def test_blocks_begin_at_a_line_of_the_cache() -> None:
    for size in (1, 5, 8):
        blocks = in_blocks(np.ones((size, 70), dtype=np.float32))
        assert blocks.ctypes.data % 64 == 0
        assert blocks.shape == (2, size, 64)
        assert blocks.sum() == size * 70
