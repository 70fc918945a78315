# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Confidence interval of a share."""

from __future__ import annotations

import math

_Z_95 = 1.959964


def wilson(right: int, n: int) -> tuple[float, float]:
    """The 95 % interval of the share `right / n` by Wilson's method; 0 to 1 for `n` = 0."""
    if n == 0:
        return 0.0, 1.0
    z, share = _Z_95, right / n
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    # Rounded: with all or none right, the bound is 1 or 0 except for the last digit.
    return max(middle - half, 0.0), min(middle + half, 1.0)
