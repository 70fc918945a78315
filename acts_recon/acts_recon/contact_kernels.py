"""The contact in an image, in numba: the same as `acts_recon.contact.find_contact`, without allocation."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

RESULTS = 7
"""Numbers that `find_contact` writes: column, row, force [N], peak [counts], pressed taxels, variances of both."""


@numba.njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def find_contact(
    image: NDArray[np.float32],
    cols: int,
    touch_counts: float,
    force_n: NDArray[np.float64],
    results: NDArray[np.float64],
) -> None:
    """Describe the contact in units of taxels.

    Parameters
    ----------
    image : np.ndarray [shape=(rows * cols,), dtype=float32]
        Counts, 0 to 1023.
    cols : int
    touch_counts : float
    force_n : np.ndarray [shape=(1025,), dtype=float64]
        The table of `acts_core.force.force_table`; values between two counts are interpolated.
    results : np.ndarray [shape=(RESULTS,), dtype=float64]
        Written: mean column and row, force [N], peak [counts], pressed taxels, variances of column and row; all 0
        without contact.
    """
    total = 0.0
    by_col = 0.0
    by_row = 0.0
    by_col_square = 0.0
    by_row_square = 0.0
    peak = 0.0
    pressed = 0
    for t in range(image.shape[0]):
        value = np.float64(image[t])
        if not value > touch_counts:
            continue
        row = t // cols
        col = t - row * cols
        whole = int(value)
        weight = force_n[whole] + (value - whole) * (force_n[whole + 1] - force_n[whole])
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
    mean_col = by_col / total
    mean_row = by_row / total
    results[0] = mean_col
    results[1] = mean_row
    results[2] = total
    results[3] = peak
    results[4] = pressed
    results[5] = max(by_col_square / total - mean_col * mean_col, 0.0)
    results[6] = max(by_row_square / total - mean_row * mean_row, 0.0)
