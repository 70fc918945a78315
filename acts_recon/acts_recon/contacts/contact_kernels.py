# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact in an image, in numba, without allocation: the same as `contact_reference` in the tests.

Positions are weighted by force, not by counts as in the published analysis: counts saturate, which pulls their mean
towards the lightly pressed side of an object that is not pressed evenly (docs/reconstruction.md has figures).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.contacts.grid import Grid, Thresholds
from acts_recon.images import FAR, SMALLEST_DIVISOR, force_of, taxel_variances

RESULTS = 12
"""Numbers that `find_contact` writes."""

X, Y, FORCE, PEAK, AREA, TAXELS, SPREAD, X_SD, Y_SD, FORCE_SD, AREA_SD, SPREAD_SD = range(RESULTS)
"""Where each of them is: in the order of `acts_recon.contacts.contact.Contact`."""


@kernel
def find_contact(
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    grid: Grid,
    thresholds: Thresholds,
    results: NDArray[np.float64],
) -> None:
    """Describe the contact.

    Parameters
    ----------
    image : np.ndarray [shape=(rows * cols,), dtype=float32]
        Counts, 0 to 1023.
    sigma : np.ndarray [shape=(rows * cols,) or (0,), dtype=float32]
        Standard deviations of the taxels [counts]; empty where not known, those of the contact are then 0.
    grid : Grid
    thresholds : Thresholds
    results : np.ndarray [shape=(RESULTS,), dtype=float64]
        Written: the fields of `acts_recon.contacts.contact.Contact` after the first, in order. All 0 without contact.
    """
    cols, pitch_m, pitch_y_m, bounds = grid.cols, grid.pitch_m, grid.pitch_y_m, grid.bounds
    force_n, touch_counts = grid.force_n, thresholds.touch_counts
    noise_counts, together = thresholds.noise_counts, thresholds.together
    total = by_col = by_row = by_col_square = by_row_square = peak = 0.0
    pressed = 0
    rows = image.shape[0] // cols
    top, bottom, left, right = rows, -1, cols, -1
    for t in range(image.shape[0]):
        value = np.float64(image[t])
        if not value > touch_counts:
            continue
        row = t // cols
        col = t - row * cols
        top, bottom = min(top, row), max(bottom, row)
        left, right = min(left, col), max(right, col)
        weight = force_of(value, force_n)
        total += weight
        by_col += weight * col
        by_row += weight * row
        by_col_square += weight * (col * col)
        by_row_square += weight * (row * row)
        peak = max(peak, value)
        pressed += 1
    for i in range(RESULTS):
        results[i] = 0.0
    if pressed == 0:
        return
    total = max(total, SMALLEST_DIVISOR)
    mean_col = by_col / total
    mean_row = by_row / total
    x_square = max(by_col_square / total - mean_col * mean_col, 0.0) * pitch_m * pitch_m
    y_square = max(by_row_square / total - mean_row * mean_row, 0.0) * pitch_y_m * pitch_y_m
    results[X] = (mean_col - (cols - 1) / 2) * pitch_m
    results[Y] = ((rows - 1) / 2 - mean_row) * pitch_y_m
    results[FORCE] = total
    results[PEAK] = peak
    results[AREA] = pressed * pitch_m * pitch_y_m
    results[TAXELS] = pressed
    spread_square = x_square + y_square
    results[SPREAD] = math.sqrt(spread_square)
    if sigma.shape[0] == 0:
        return
    x_var = y_var = force_var = taxels_var = spread_square_var = 0.0
    for row in range(max(top - 1, 0), min(bottom + 2, rows)):
        for col in range(max(left - 1, 0), min(right + 2, cols)):
            t = row * cols + col
            value = np.float64(image[t])
            deviation = np.float64(sigma[t])
            inside = value > touch_counts
            if not deviation > 0.0 or (not inside and value + FAR * deviation < touch_counts):
                continue
            if not (inside or _beside(image, bounds[t], cols, row, col, touch_counts)):
                continue
            square, wrong = taxel_variances(
                max(value, 0.0), deviation, inside, touch_counts, noise_counts, together, force_n, grid.slope_n
            )
            x_away = ((col - mean_col) * pitch_m) ** 2
            y_away = ((row - mean_row) * pitch_y_m) ** 2
            x_var += square * x_away
            y_var += square * y_away
            force_var += square
            taxels_var += wrong
            spread_square_var += square * (x_away + y_away - spread_square) ** 2
    results[X_SD] = math.sqrt(x_var) / total
    results[Y_SD] = math.sqrt(y_var) / total
    results[FORCE_SD] = math.sqrt(force_var)
    results[AREA_SD] = math.sqrt(taxels_var) * pitch_m * pitch_y_m
    # Of a root whose square has this variance; also where the square is next to 0.
    results[SPREAD_SD] = math.sqrt(spread_square + math.sqrt(spread_square_var) / total) - math.sqrt(spread_square)


@kernel(inline="always")
def _beside(
    image: NDArray[np.float32], bounds: NDArray[np.int32], cols: int, row: int, col: int, touch_counts: float
) -> bool:
    """Whether a taxel around this one is pressed, on the same side of all borders."""
    for r in range(max(row - 1, bounds[0]), min(row + 2, bounds[1])):
        for c in range(max(col - 1, bounds[2]), min(col + 2, bounds[3])):
            if image[r * cols + c] > touch_counts:
                return True
    return False
