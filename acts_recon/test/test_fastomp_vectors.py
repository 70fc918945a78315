"""Rows in explicit vectors against NumPy."""

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from acts_recon.fastomp_ir import LANES
from acts_recon.fastomp_vectors import add_square, clear, dot, padded, subtract


@numba.njit
def inner(x: NDArray[np.float32], i: int, y: NDArray[np.float32], j: int, n: int) -> float:
    return dot(x, i, y, j, n)


@numba.njit
def take_off(x: NDArray[np.float32], out: int, row: int, share: float, other: int, n: int) -> None:
    subtract(x, out, row, np.float32(share), other, n)


@numba.njit
def set_zero(x: NDArray[np.float32], row: int, n: int) -> None:
    clear(x, row, n)


@numba.njit
def add(
    image: NDArray[np.float32], first: int, stride: int, share: float, atoms: NDArray[np.float32], atom: int, side: int
) -> None:
    add_square(image, first, stride, np.float32(share), atoms, atom, side)


def rows(*shape: int) -> NDArray[np.float32]:
    return np.random.default_rng(0).standard_normal(shape).astype(np.float32)


@pytest.mark.parametrize("n", [0, LANES, 2 * LANES])
def test_rows_are_multiplied_subtracted_and_cleared(n: int) -> None:
    x = rows(3, 3 * LANES)
    y = x[0] + 1
    assert inner(x, 1, y, 0, n) == pytest.approx(float(x[1, :n] @ y[:n]), abs=1e-4)
    expected = x.copy()
    expected[2, :n] = x[0, :n] - np.float32(0.7) * x[1, :n]
    take_off(x, 2, 0, 0.7, 1, n)
    np.testing.assert_allclose(x, expected, rtol=1e-5, atol=1e-6)
    expected[0, :n] = 0
    set_zero(x, 0, n)
    np.testing.assert_allclose(x, expected, rtol=1e-5, atol=1e-6)


def test_rows_of_all_planes_are_counted_on() -> None:
    x = rows(2, 3, LANES)
    assert inner(x, 4, x, 5, LANES) == pytest.approx(float(x[1, 1] @ x[1, 2]), abs=1e-4)


@pytest.mark.parametrize("side", [1, 5, 8, 11, 16])
def test_squares_are_added_to_an_image(side: int) -> None:
    image, atoms = rows(20, 20), rows(3, side * side)
    expected = image.copy()
    expected[2 : 2 + side, 3 : 3 + side] += np.float32(-1.5) * atoms[2].reshape(side, side)
    add(image.reshape(-1), 2 * 20 + 3, 20, -1.5, atoms, 2, side)
    np.testing.assert_allclose(image, expected, rtol=1e-5, atol=1e-6)


def test_rows_are_filled_up_to_whole_vectors() -> None:
    assert [padded(n) for n in (0, 1, LANES, LANES + 1)] == [0, LANES, LANES, 2 * LANES]
