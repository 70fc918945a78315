# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Check of a frame's samples in numba; the tests compare it with `acts_core.wire.samples.sample_fault`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel

INDEX_RANGE = 1
INDEX_REPEATED = 2
COUNT_RANGE = 3


@kernel
def first_fault(
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    size: int,
    seen: NDArray[np.uint32],
    mark: int,
    may_repeat: bool,
) -> tuple[int, int]:
    """Find the first sample that cannot be right.

    Parameters
    ----------
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
        The samples.
    size : int
        Number of taxels of the array, at most `len(seen)`.
    seen : np.ndarray [shape=(n,), dtype=uint32]
        Scratch kept from call to call: the mark of the frame that saw a taxel last.
    mark : int
        Different in every call.
    may_repeat : bool
        Whether an index may be there several times.

    Returns
    -------
    fault : int
        0 for none, INDEX_RANGE, INDEX_REPEATED or COUNT_RANGE.
    position : int
        Which sample.
    """
    for position in range(len(indices)):
        index = indices[position]
        if index >= size:
            return INDEX_RANGE, position
        if seen[index] == mark and not may_repeat:
            return INDEX_REPEATED, position
        seen[index] = mark
        if counts[position] > COUNT_MAX:
            return COUNT_RANGE, position
    return 0, 0
