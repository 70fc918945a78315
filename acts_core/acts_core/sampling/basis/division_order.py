# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The order in which adaptive sampling searches: from coarse to fine."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray


@lru_cache(maxsize=32)
def division_order(rows: int, cols: int) -> NDArray[np.uint16]:
    """Every taxel once, from coarse to fine: the centres of ever smaller halves of the array.

    Centres are kept doubled (the first is ``(rows, cols)``) and halved, rounding down, when listed. Each round splits
    every cell across its longer side, the columns where both are equal: the step along that side is halved, rounding
    up, and each centre yields the two at that step before and behind it. Centres outside of the array are split on but
    not listed. The rounds end when both steps are 1: by then no taxel is missing. On 32 x 32 these are the ten rounds
    of the published firmware; other sizes, also non-square, are a generalisation.

    Returns
    -------
    np.ndarray [shape=(rows * cols,), dtype=uint16, read-only]
        Row-major taxel indices.
    """
    listed = np.zeros((rows, cols), dtype=bool)
    order: list[int] = []

    def put(row2: int, col2: int) -> None:
        row, col = row2 >> 1, col2 >> 1
        if 0 <= row < rows and 0 <= col < cols and not listed[row, col]:
            listed[row, col] = True
            order.append(row * cols + col)

    centres = [(rows, cols)]
    put(rows, cols)
    row_step, col_step = rows, cols
    while row_step > 1 or col_step > 1:
        if col_step >= row_step:
            col_step = (col_step + 1) // 2
            step = (0, col_step)
        else:
            row_step = (row_step + 1) // 2
            step = (row_step, 0)
        centres = [(row + sign * step[0], col + sign * step[1]) for row, col in centres for sign in (-1, 1)]
        for row, col in centres:
            put(row, col)
    result = np.array(order, dtype=np.uint16)
    result.flags.writeable = False
    return result
