# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the uncertainty of a taxel adds to that of its contact, in numba; `uncertainty` has the formulae."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel
from acts_recon.images.uncertainty import FAR

SMALLEST_DIVISOR = 1e-30
"""What is divided by is at least this: a measured response may say next to 0 N for a pressed taxel."""


@kernel(inline="always")
def force_of(value: float, force_n: NDArray[np.float64]) -> float:
    """Force of a taxel of so many counts [N]; between two entries of the table it is interpolated."""
    value = min(value, float(COUNT_MAX))
    whole = int(value)
    return force_n[whole] + (value - whole) * (force_n[whole + 1] - force_n[whole])


@kernel(inline="always")
def taxel_variances(
    value: float,
    deviation: float,
    pressed: bool,
    least: float,
    noise_counts: float,
    together: float,
    force_n: NDArray[np.float64],
    slope_n: NDArray[np.float64],
) -> tuple[float, float]:
    """What a taxel adds to the variance of the force [N^2], and of the number of taxels.

    Parameters
    ----------
    value, deviation : float
        Counts, at least 0, and their standard deviation, above 0.
    pressed : bool
        Whether it counts in the contact.
    least : float
        Threshold that it is above, or not [counts].
    noise_counts, together : float
        Deviations beyond the first are of guesses; so many guesses err together.
    force_n, slope_n : np.ndarray [shape=(1025,) and (1024,), dtype=float64]
        The table of `acts_core.skin.force.force_table` and its slope, see `acts_recon.images.uncertainty.slope_table`.
    """
    deviation = min(deviation, float(COUNT_MAX))
    value = min(value, float(COUNT_MAX))
    # Before all branches: what an array is read for after one costs a count of its references each time.
    weight, slope = force_of(value if pressed else least, force_n), slope_n[int(value)]
    square = wrong = 0.0
    if abs(value - least) <= FAR * deviation:
        wrong = 0.5 * math.erfc(abs(value - least) / (math.sqrt(2.0) * deviation))
        square = weight * weight * wrong
    elif not pressed:
        return 0.0, 0.0
    if pressed:
        square += slope * slope * deviation * deviation
    if deviation > noise_counts:
        factor = together - (together - 1.0) * (noise_counts / deviation) ** 2
        square *= factor
        wrong *= factor
    return square, wrong
