# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics in the reports: means and distributions, which are None without values, and intervals of shares."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

_Z_95 = 1.959964


def mean(values: ArrayLike) -> float | None:
    """Mean of numbers, or the share of booleans that are true; None where there are none."""
    known = np.asarray(values)
    return float(known.mean()) if known.size else None


def distribution(values: ArrayLike) -> dict[str, float | None]:
    """Mean, median and 95th percentile; None where there are no values."""
    known = np.asarray(values)
    if not known.size:
        return {"mean": None, "median": None, "p95": None}
    return {"mean": mean(known), "median": float(np.median(known)), "p95": float(np.percentile(known, 95))}


def distribution_with_max(values: ArrayLike) -> dict[str, float | None]:
    """The same, and the largest value as `max`."""
    known = np.asarray(values)
    return {**distribution(known), "max": float(known.max()) if known.size else None}


def wilson(right: int, n: int) -> tuple[float, float]:
    """The 95 % interval of the share `right / n` by Wilson's method; 0 to 1 for `n` = 0."""
    if n == 0:
        return 0.0, 1.0
    z, share = _Z_95, right / n
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    # Rounded: with all or none right, the bound is 1 or 0 except for the last digit.
    return max(middle - half, 0.0), min(middle + half, 1.0)
