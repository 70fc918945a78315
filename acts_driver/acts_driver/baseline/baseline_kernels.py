# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Update of statistics and baseline by one frame, in numba, without allocation.

`baseline_reference` in the tests is the reference implementation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel


@kernel
def observe(
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    time_ns: int,
    neighbours: NDArray[np.int32],
    block_n: NDArray[np.int64],
    block_sums: NDArray[np.float64],
    block_ends: NDArray[np.int64],
    baseline: NDArray[np.float64],
    freeze_counts: NDArray[np.float32],
    measured_ns: NDArray[np.int64],
    frozen_until_ns: NDArray[np.int64],
    is_tracking: bool,
    tau_ns: float,
    hold_ns: int,
    largest_step: float,
) -> None:
    """Update by one frame.

    Parameters
    ----------
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
        The samples; indices lie in the array.
    time_ns : int
        When the frame was measured [ns].
    neighbours : np.ndarray [shape=(n, 8), dtype=int32]
        The taxels around each, -1 for none; n is the number of taxels.
    block_n : np.ndarray [shape=(n,), dtype=int64]
        Readings in the present block; raised.
    block_sums : np.ndarray [shape=(n, 2), dtype=float64]
        Their sum and the sum of their squares; raised.
    block_ends : np.ndarray [shape=(n, 2), dtype=int64]
        The smallest and the largest of them; widened.
    baseline : np.ndarray [shape=(n,), dtype=float64]
        Followed where it is not frozen [counts]. The steps of a taxel that is measured often are too small for float32.
    freeze_counts : np.ndarray [shape=(n,), dtype=float32]
        A reading farther from the baseline than this freezes it there and at the taxels around [counts]; negative
        where there is no baseline.
    measured_ns, frozen_until_ns : np.ndarray [shape=(n,), dtype=int64]
        When the taxel was measured last; until when its baseline stays. Both updated.
    is_tracking : bool
        Whether the baseline follows at all.
    tau_ns : float
        Time constant of following [ns].
    hold_ns : int
        How long a baseline stays frozen after what froze it [ns].
    largest_step : float
        Largest gain: share of a reading's difference from the baseline that the baseline follows at once.
    """
    for i in range(indices.shape[0]):
        taxel = indices[i]
        count = np.int64(counts[i])
        block_n[taxel] += 1
        block_sums[taxel, 0] += count
        block_sums[taxel, 1] += count * count
        block_ends[taxel, 0] = min(block_ends[taxel, 0], count)
        block_ends[taxel, 1] = max(block_ends[taxel, 1], count)
        since_ns = time_ns - measured_ns[taxel]
        measured_ns[taxel] = time_ns
        if not is_tracking or freeze_counts[taxel] < 0:
            continue
        difference = count - baseline[taxel]
        if abs(difference) > freeze_counts[taxel]:
            frozen_until_ns[taxel] = time_ns + hold_ns
            for neighbour in neighbours[taxel]:
                if neighbour >= 0:
                    frozen_until_ns[neighbour] = time_ns + hold_ns
        elif time_ns >= frozen_until_ns[taxel]:
            share = min(max(since_ns / tau_ns, 0.0), largest_step)
            baseline[taxel] += share * difference
