# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference implementation of `acts_driver.baseline.baseline_kernels` in NumPy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


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
    """Update by one frame; parameters as of the kernel.

    The order of the samples matters, as in the kernel: a sample can freeze taxels that come after it in the frame.
    """
    values = counts.astype(np.int64)
    block_n[indices] += 1
    block_sums[indices] += np.column_stack([values, values**2])
    block_ends[indices, 0] = np.minimum(block_ends[indices, 0], values)
    block_ends[indices, 1] = np.maximum(block_ends[indices, 1], values)
    since_ns = time_ns - measured_ns[indices]
    measured_ns[indices] = time_ns
    if not is_tracking:
        return
    for taxel, value, since in zip(indices.tolist(), values.tolist(), since_ns.tolist(), strict=True):
        if freeze_counts[taxel] < 0:
            continue
        difference = value - float(baseline[taxel])
        if abs(difference) > freeze_counts[taxel]:
            around = neighbours[taxel]
            frozen_until_ns[[taxel, *around[around >= 0]]] = time_ns + hold_ns
        elif time_ns >= frozen_until_ns[taxel]:
            baseline[taxel] += np.clip(since / tau_ns, 0.0, largest_step) * difference
