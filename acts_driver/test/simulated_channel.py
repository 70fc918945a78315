# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated way from a board to the host, with known truth."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

EPOCH_NS = 1_700_000_000_000_000_000


@dataclass(frozen=True)
class Channel:
    """Frames of a board whose clock is off and drifts, on a way with jitter, stalls and bundling.

    Attributes
    ----------
    board_us : np.ndarray [shape=(n,), dtype=int64]
        The board's clock at each measurement.
    measured_ns, arrival_ns : np.ndarray [shape=(n,), dtype=int64]
        Host time of each measurement and arrival; arrivals do not decrease.
    shortest_ns : int
        Shortest time on the way, which nobody can tell from the offset.
    """

    board_us: NDArray[np.int64]
    measured_ns: NDArray[np.int64]
    arrival_ns: NDArray[np.int64]
    shortest_ns: int

    def batches(self) -> list[tuple[list[int], int, slice]]:
        """Board times, arrival and place of frames that arrive together."""
        edges = [0, *(np.flatnonzero(np.diff(self.arrival_ns)) + 1).tolist(), len(self.arrival_ns)]
        return [
            (self.board_us[start:end].tolist(), int(self.arrival_ns[start]), slice(start, end))
            for start, end in pairwise(edges)
        ]


def simulate(
    seconds: float, drift_ppm: float, *, seed: int = 1, rate_hz: float = 1000.0, jitter_us: float = 150.0
) -> Channel:
    """Exponential jitter over a floor of 120 us, a stall of 5 to 50 ms once a second, reads that bundle frames."""
    random = np.random.default_rng(seed)
    n = int(seconds * rate_hz)
    measured_ns = EPOCH_NS + np.round(np.arange(n) * 1e9 / rate_hz + random.uniform(0, 2e4, n)).astype(np.int64)
    board_us = 5_000_000 + ((measured_ns - EPOCH_NS) * (1 - drift_ppm * 1e-6) / 1000).astype(np.int64)
    shortest_ns = 120_000
    arrival_ns = measured_ns + shortest_ns + random.exponential(jitter_us * 1000, n).astype(np.int64)
    for start_s in np.arange(1.0, seconds, 1.0):
        begin = EPOCH_NS + int(1e9 * (start_s + random.uniform(0, 0.5)))
        end = begin + int(random.uniform(5e6, 5e7))
        arrival_ns[(arrival_ns >= begin) & (arrival_ns < end)] = end
    return Channel(board_us, measured_ns, np.maximum.accumulate(arrival_ns), shortest_ns)
