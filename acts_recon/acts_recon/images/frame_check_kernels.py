# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether a frame fits the array, in numba: one of four codes, which `frame_check.why_refused` puts into words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel

OK = 0
INDEX_OUT_OF_RANGE = 1
INDEX_TWICE = 2
COUNT_OUT_OF_RANGE = 3


@kernel
def check_frame(
    indices: NDArray[np.uint16], counts: NDArray[np.uint16], seen: NDArray[np.bool_], may_repeat: bool
) -> int:
    """Return the code of a frame.

    Parameters
    ----------
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
    seen : np.ndarray [shape=(n_taxels,), dtype=bool]
        All False, before and after.
    may_repeat : bool
        Whether an index may be there several times.
    """
    code = OK
    checked = 0
    for k in range(indices.shape[0]):
        if indices[k] >= seen.shape[0]:
            code = INDEX_OUT_OF_RANGE
        elif counts[k] > COUNT_MAX:
            code = COUNT_OUT_OF_RANGE
        elif seen[indices[k]] and not may_repeat:
            code = INDEX_TWICE
        if code != OK:
            break
        seen[indices[k]] = True
        checked += 1
    for k in range(checked):
        seen[indices[k]] = False
    return code
