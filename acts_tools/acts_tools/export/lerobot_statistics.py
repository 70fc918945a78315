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
_KINDS = ("min", "max", "mean", "std", *(f"q{round(100 * share):02d}" for share in _QUANTILES))
_COLUMNS_AT_ONCE = 64


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
        channels = [_of_pixels(values[..., channel]) for channel in range(values.shape[-1])]
        return {
            **{kind: np.array([one[kind] for one in channels]).reshape(-1, 1, 1) for kind in _KINDS},
            "count": count,
        }
    # In double precision all numbers of a long recording would take several times the memory of the recording.
    rows = values.reshape(len(values), -1)
    parts = [
        _of_columns(rows[:, first : first + _COLUMNS_AT_ONCE]) for first in range(0, rows.shape[1], _COLUMNS_AT_ONCE)
    ]
    return {**{kind: np.concatenate([part[kind] for part in parts]) for kind in _KINDS}, "count": count}


def _of_columns(values: NDArray[Any]) -> dict[str, NDArray[np.float64]]:
    """Of each column of numbers [shape=(n, k)]: arrays [shape=(k,)]."""
    numbers = values.astype(np.float64)
    quantiles = np.quantile(numbers, _QUANTILES, axis=0)
    moments = (numbers.min(axis=0), numbers.max(axis=0), numbers.mean(axis=0), numbers.std(axis=0))
    return dict(zip(_KINDS, [*moments, *quantiles], strict=True))


def _of_pixels(frames: NDArray[np.uint8]) -> dict[str, float]:
    """Of all pixels of one channel [shape=(n, height, width)], from 0 to 1, by how often each of their values comes."""
    counts = np.zeros(256, dtype=np.int64)
    for frame in frames:
        counts += np.bincount(frame.ravel(), minlength=256)
    levels = np.arange(256) / 255.0
    below = counts.cumsum()
    n_pixels = int(below[-1])
    mean = float(counts @ levels) / n_pixels
    std = float(np.sqrt(counts @ (levels - mean) ** 2 / n_pixels))
    lowest, highest = levels[counts > 0][[0, -1]]
    quantiles = []
    for share in _QUANTILES:
        # As `np.quantile`: between the two pixels beside this place in their order.
        place = share * (n_pixels - 1)
        left, right = levels[np.searchsorted(below, [int(place), min(int(place) + 1, n_pixels - 1)], side="right")]
        quantiles.append(float(left + (right - left) * (place - int(place))))
    return dict(zip(_KINDS, [float(lowest), float(highest), mean, std, *quantiles], strict=True))


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
