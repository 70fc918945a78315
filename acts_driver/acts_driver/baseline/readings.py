# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics of every taxel's readings over some time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX

LEAST_READINGS = 8
"""Readings of a taxel that a calibration needs."""


class Block:
    """Sums over the readings of every taxel in some time, to which `baseline_kernels.observe` adds.

    Attributes
    ----------
    n : np.ndarray [shape=(size,), dtype=int64]
        Number of readings.
    sums : np.ndarray [shape=(size, 2), dtype=float64]
        Sum of the readings, and of their squares [counts, counts^2].
    ends : np.ndarray [shape=(size, 2), dtype=int64]
        Smallest and largest reading [counts].
    """

    def __init__(self, size: int) -> None:
        self.n = np.zeros(size, dtype=np.int64)
        self.sums = np.zeros((size, 2))
        self.ends = np.zeros((size, 2), dtype=np.int64)
        self.clear()

    def clear(self) -> None:
        """Begin anew."""
        self.n[:] = 0
        self.sums[:] = 0.0
        self.ends[:, 0] = COUNT_MAX + 1
        self.ends[:, 1] = -1


class Readings(NamedTuple):
    """Of every taxel: number of readings, their mean, standard deviation and largest difference [counts].

    np.ndarray [shape=(size,)] each, 0 without readings.
    """

    n: NDArray[np.int64]
    mean: NDArray[np.float64]
    deviation: NDArray[np.float64]
    span: NDArray[np.int64]


def readings_of(blocks: Sequence[Block]) -> Readings:
    """What blocks of the same taxels say together."""
    n = np.sum([block.n for block in blocks], axis=0)
    sums = np.sum([block.sums for block in blocks], axis=0)
    known = np.maximum(n, 1)
    mean = sums[:, 0] / known
    deviation = np.sqrt(np.maximum(sums[:, 1] / known - mean**2, 0.0))
    low = np.min([block.ends[:, 0] for block in blocks], axis=0)
    high = np.max([block.ends[:, 1] for block in blocks], axis=0)
    return Readings(n, mean, deviation, np.where(n > 0, high - low, 0))


def noise_of(readings: Readings, still: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The noise of every taxel [counts]; where it has few readings, that of all `still` taxels together."""
    freedom = int(np.maximum(readings.n - 1, 0)[still].sum())
    together = np.sqrt((readings.n * readings.deviation**2)[still].sum() / max(freedom, 1))
    return np.where(readings.n < LEAST_READINGS, together, readings.deviation)
