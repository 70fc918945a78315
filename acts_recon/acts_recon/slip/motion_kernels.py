# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The least squares of `acts_recon.slip.motion`, in numba; its reference implementation in NumPy is in the tests."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel

_UNKNOWNS = 4


@kernel
def _slope(values: NDArray[np.float32], row: int, col: int, down: int, right: int) -> float:
    """Central difference along an axis, one-sided at the border; as `np.gradient`."""
    rows, cols = values.shape
    row_a, col_a = max(row - down, 0), max(col - right, 0)
    row_b, col_b = min(row + down, rows - 1), min(col + right, cols - 1)
    return (float(values[row_b, col_b]) - float(values[row_a, col_a])) / (row_b - row_a + col_b - col_a)


@kernel
def normal_equations(
    reference: NDArray[np.float32], image: NDArray[np.float32], is_dead: NDArray[np.bool_], matrix: NDArray[np.float64]
) -> Any:
    """Write A'A and A'b side by side into `matrix` (4, 5); returns b'b and the number of live taxels.

    Where nothing presses the number is 0. `is_dead`, of the images' shape, says which taxels are estimated from others.

    The centre of growth is weighted by the square of the pressure: of a contact that the border cuts, the mean of what
    is left lies farther from its middle.
    """
    rows, cols = image.shape
    weight = centre_row = centre_col = 0.0
    for row in range(rows):
        for col in range(cols):
            pressed = max(0.5 * (float(reference[row, col]) + float(image[row, col])), 0.0) ** 2
            weight += pressed
            centre_row += pressed * row
            centre_col += pressed * col
    matrix[:] = 0.0
    if weight <= 0.0:
        return 0.0, 0
    centre_row /= weight
    centre_col /= weight
    line = np.empty(_UNKNOWNS + 1)
    squares = 0.0
    taxels = 0
    for row in range(rows):
        for col in range(cols):
            # It says nothing that those around do not say.
            if is_dead[row, col]:
                continue
            taxels += 1
            right = 0.5 * (_slope(reference, row, col, 0, 1) + _slope(image, row, col, 0, 1))
            down = 0.5 * (_slope(reference, row, col, 1, 0) + _slope(image, row, col, 1, 0))
            line[0] = reference[row, col]
            line[1] = right
            line[2] = down
            line[3] = (col - centre_col) * right + (row - centre_row) * down
            line[4] = float(image[row, col]) - float(reference[row, col])
            squares += line[4] * line[4]
            for i in range(_UNKNOWNS):
                for j in range(i, _UNKNOWNS + 1):
                    matrix[i, j] += line[i] * line[j]
    for i in range(_UNKNOWNS):
        for j in range(i):
            matrix[i, j] = matrix[j, i]
    return squares, taxels


@kernel
def cut(reference: NDArray[np.float32], image: NDArray[np.float32]) -> float:
    """How hard the taxels along the border are pressed, relative to the hardest pressed one: 0 to 1."""
    rows, cols = image.shape
    border = peak = 0.0
    for row in range(rows):
        for col in range(cols):
            pressed = float(reference[row, col]) + float(image[row, col])
            peak = max(peak, pressed)
            if row == 0 or col == 0 or row == rows - 1 or col == cols - 1:
                border = max(border, pressed)
    return border / peak if peak > 0.0 else 0.0


@kernel
def _invert(matrix: NDArray[np.float64], inverse: NDArray[np.float64]) -> None:
    """Invert the left part of `matrix` by Gauss and Jordan; pivots are above 0, as of A'A with more on its diagonal.

    Numba would import scipy's linear algebra for `np.linalg.inv`, which takes an eighth of a second of a node's start.
    """
    work = matrix[:, :_UNKNOWNS].copy()
    inverse[:] = 0.0
    for i in range(_UNKNOWNS):
        inverse[i, i] = 1.0
    for i in range(_UNKNOWNS):
        pivot = work[i, i]
        for j in range(_UNKNOWNS):
            work[i, j] /= pivot
            inverse[i, j] /= pivot
        for k in range(_UNKNOWNS):
            if k != i:
                factor = work[k, i]
                for j in range(_UNKNOWNS):
                    work[k, j] -= factor * work[i, j]
                    inverse[k, j] -= factor * inverse[i, j]


@kernel
def solve(
    matrix: NDArray[np.float64],
    inverse: NDArray[np.float64],
    squares: float,
    count: int,
    noise_counts: float,
    ridge: float,
) -> Any:
    """Columns, rows, their standard deviation, gain and growth, out of what `normal_equations` has written."""
    trace = 0.0
    for i in range(_UNKNOWNS):
        trace += matrix[i, i]
    # Gradients and force have other sizes: each unknown is held back by its own.
    for i in range(_UNKNOWNS):
        matrix[i, i] += ridge * (matrix[i, i] + 1e-9 * trace) + 1e-12
    _invert(matrix, inverse)
    solution = np.zeros(_UNKNOWNS)
    explained = 0.0
    for i in range(_UNKNOWNS):
        for j in range(_UNKNOWNS):
            solution[i] += inverse[i, j] * matrix[j, _UNKNOWNS]
        explained += solution[i] * matrix[i, _UNKNOWNS]
    left = max(squares - explained, 0.0) / max(count - _UNKNOWNS, 1)
    variance = max(left, 2.0 * noise_counts * noise_counts)
    deviation = math.sqrt(variance * max(inverse[1, 1] + inverse[2, 2], 0.0))
    return -solution[1], -solution[2], deviation, 1.0 + solution[0], -solution[3]
