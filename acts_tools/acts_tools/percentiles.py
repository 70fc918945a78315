# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Percentiles, as in all summaries of latencies."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

PERCENTILES = (("median", 50.0), ("p99", 99.0), ("p99_9", 99.9))


def percentiles(values: ArrayLike, decimals: int = 3) -> dict[str, float | None]:
    """Median, 99 % and 99.9 % of values.

    Parameters
    ----------
    values : array_like [shape=(n,)]
        Values in any unit; the result has the same.
    decimals : int
        Number of decimals of the result.

    Returns
    -------
    dict of str to float or None
        Keys are ``median``, ``p99`` and ``p99_9``; values are None where there are none.
    """
    known = np.asarray(values, dtype=np.float64)
    if not known.size:
        return {name: None for name, _ in PERCENTILES}
    return {name: round(float(np.percentile(known, percent)), decimals) for name, percent in PERCENTILES}
