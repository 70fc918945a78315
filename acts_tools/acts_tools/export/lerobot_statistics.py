# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics of columns in LeRobot datasets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Statistics = dict[str, dict[str, NDArray[Any]]]
"""For each column min, max, mean, std, count and the quantiles q01, q10, q50, q90, q99."""

_QUANTILES = (0.01, 0.10, 0.50, 0.90, 0.99)


def statistics_of(values: NDArray[Any], is_picture: bool) -> dict[str, NDArray[Any]]:
    """Statistics of one column.

    Parameters
    ----------
    values : np.ndarray [shape=(n, ...)]
        Pictures as (n, height, width, channels) of 8 bits.
    is_picture : bool
        True: statistics of each channel, shape (channels, 1, 1), from 0 to 1. False: of each number in a row.
    """
    count = np.array([len(values)])
    if is_picture:
        values = values.reshape(-1, values.shape[-1]) / 255.0
    numbers = values.astype(np.float64)
    found = {
        "min": numbers.min(axis=0),
        "max": numbers.max(axis=0),
        "mean": numbers.mean(axis=0),
        "std": numbers.std(axis=0),
    }
    quantiles = np.quantile(numbers, _QUANTILES, axis=0)
    found |= {f"q{round(100 * q):02d}": one for q, one in zip(_QUANTILES, quantiles, strict=True)}
    found = {kind: np.atleast_1d(one) for kind, one in found.items()}
    if is_picture:
        found = {kind: one.reshape(-1, 1, 1) for kind, one in found.items()}
    return {**found, "count": count}


def pooled(episodes: Sequence[Statistics]) -> Statistics:
    """Statistics over all episodes.

    Quantiles are only bounds: the lowest of those up to the median, the highest of those above.
    """
    return {name: _pooled([one[name] for one in episodes]) for name in episodes[0]}


def _pooled(parts: Sequence[dict[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    counts = np.array([part["count"][0] for part in parts])
    means = np.stack([part["mean"] for part in parts])
    weights = counts.reshape(-1, *[1] * (means.ndim - 1)) / counts.sum()
    mean = (weights * means).sum(axis=0)
    squares = np.stack([part["std"] for part in parts]) ** 2 + (means - mean) ** 2
    lowest = ["min", "q01", "q10", "q50"]
    highest = ["max", "q90", "q99"]
    return {
        **{kind: np.min([part[kind] for part in parts], axis=0) for kind in lowest},
        **{kind: np.max([part[kind] for part in parts], axis=0) for kind in highest},
        "mean": mean,
        "std": np.sqrt((weights * squares).sum(axis=0)),
        "count": np.array([counts.sum()]),
    }
