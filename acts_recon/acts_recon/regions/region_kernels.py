# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact of every patch of an image in one pass, in numba; the reference implementation is in the tests."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.images import SMALLEST_DIVISOR, force_of

RESULTS = 19
"""Numbers of a patch that `find_regions` writes."""

PRESSED, FORCE, CENTRE, NORMAL, AREA, PEAK, SPREAD, CONCENTRATION, COUNTS = 0, 1, 2, 5, 8, 9, 10, 11, 12
ALONG_COLS, ALONG_ROWS = 13, 16
"""Where each of them is; of centre, normal and the steps along the skin, the first of three."""


@kernel
def find_regions(
    image: NDArray[np.float32],
    bounds: NDArray[np.int64],
    points_m: NDArray[np.float64],
    normals: NDArray[np.float64],
    taxel_area_m2: NDArray[np.float64],
    touch_counts: float,
    force_n: NDArray[np.float64],
    results: NDArray[np.float64],
) -> int:
    """Describe the contact of every patch.

    Parameters
    ----------
    image : np.ndarray [shape=(rows, cols), dtype=float32]
        Counts; above 1023 they count as 1023.
    bounds : np.ndarray [shape=(patches, 4), dtype=int64]
        First and end row, first and end column of every patch in the image.
    points_m, normals : np.ndarray [shape=(rows, cols, 3), dtype=float64]
        Of every taxel in the frame of its patch's link.
    taxel_area_m2 : np.ndarray [shape=(patches,), dtype=float64]
    touch_counts : float
        A taxel above it is pressed.
    force_n : np.ndarray [shape=(1025,), dtype=float64]
        The table of `acts_core.skin.force.force_table`.
    results : np.ndarray [shape=(patches, RESULTS), dtype=float64]
        Written: pressed taxels, force [N], centre [m] (3), normal (3), area [m^2], peak [N], spread [m], concentration,
        sum of the patch's counts, and how the skin goes on from the centre, one taxel along the columns and one along
        the rows [m] (3 and 3). All 0 without contact.

    Returns
    -------
    int
        Number of patches that are pressed.
    """
    touched = 0
    for p in range(bounds.shape[0]):
        first_row, end_row, first_col, end_col = bounds[p]
        total = by_row = by_col = peak = counts = 0.0
        pressed = 0
        for row in range(first_row, end_row):
            for col in range(first_col, end_col):
                value = np.float64(image[row, col])
                counts += value
                if not value > touch_counts:
                    continue
                weight = force_of(value, force_n)
                total += weight
                by_row += weight * row
                by_col += weight * col
                peak = max(peak, weight)
                pressed += 1
        found = results[p]
        found[:] = 0.0
        if pressed == 0:
            continue
        touched += 1
        total = max(total, SMALLEST_DIVISOR)
        found[PRESSED] = pressed
        found[FORCE] = total
        found[AREA] = pressed * taxel_area_m2[p]
        found[PEAK] = peak
        found[CONCENTRATION] = peak / total
        found[COUNTS] = counts
        _place(by_row / total, by_col / total, bounds[p], points_m, normals, found)
        square = 0.0
        for row in range(first_row, end_row):
            for col in range(first_col, end_col):
                value = np.float64(image[row, col])
                if value > touch_counts:
                    away = 0.0
                    for axis in range(3):
                        away += (points_m[row, col, axis] - found[CENTRE + axis]) ** 2
                    square += force_of(value, force_n) * away
        found[SPREAD] = math.sqrt(square / total)
    return touched


@kernel
def _place(
    row: float,
    col: float,
    bounds: NDArray[np.int64],
    points_m: NDArray[np.float64],
    normals: NDArray[np.float64],
    found: NDArray[np.float64],
) -> None:
    """Position, normal and tangents of the skin at a place between four taxels of a patch, bilinear."""
    first_row, end_row, first_col, end_col = bounds
    top = min(max(int(row), first_row), max(end_row - 2, first_row))
    left = min(max(int(col), first_col), max(end_col - 2, first_col))
    bottom, right = min(top + 1, end_row - 1), min(left + 1, end_col - 1)
    down, across = row - top, col - left
    length = 0.0
    for axis in range(3):
        above = (1.0 - across) * points_m[top, left, axis] + across * points_m[top, right, axis]
        below = (1.0 - across) * points_m[bottom, left, axis] + across * points_m[bottom, right, axis]
        found[CENTRE + axis] = (1.0 - down) * above + down * below
        found[ALONG_ROWS + axis] = below - above
        found[ALONG_COLS + axis] = (1.0 - down) * (points_m[top, right, axis] - points_m[top, left, axis]) + down * (
            points_m[bottom, right, axis] - points_m[bottom, left, axis]
        )
        above = (1.0 - across) * normals[top, left, axis] + across * normals[top, right, axis]
        below = (1.0 - across) * normals[bottom, left, axis] + across * normals[bottom, right, axis]
        found[NORMAL + axis] = (1.0 - down) * above + down * below
        length += found[NORMAL + axis] ** 2
    length = math.sqrt(length)
    for axis in range(3):
        found[NORMAL + axis] /= max(length, SMALLEST_DIVISOR)
