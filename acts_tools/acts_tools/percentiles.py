# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Percentiles by their names in reports."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

_PERCENT = {"median": 50.0, "p50": 50.0, "p99": 99.0, "p999": 99.9}


def percentiles(
    values: ArrayLike, names: Sequence[str] = ("median", "p99", "p999"), decimals: int | None = 3
) -> dict[str, float | None]:
    """Percentiles of values, interpolated linearly; by default those of all summaries of latencies.

    Parameters
    ----------
    values : array_like [shape=(n,)]
        Values in any unit; the result has the same.
    names : sequence of str
        Of ``median`` or ``p50``, ``p99`` and ``p999``, which is 99.9 %.
    decimals : int, optional
        Number of decimals of the result; None: all.

    Returns
    -------
    dict of str to float or None
        Keys are `names`; values are None where there are none.
    """
    known = np.asarray(values, dtype=np.float64)
    if not known.size:
        return dict.fromkeys(names)
    found = {name: float(np.percentile(known, _PERCENT[name])) for name in names}
    return {name: value if decimals is None else round(value, decimals) for name, value in found.items()}
