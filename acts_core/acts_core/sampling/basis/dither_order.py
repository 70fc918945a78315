# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An order of the taxels in which every stretch is spread over the whole array."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

SPACING = 4
"""Rows and columns between the taxels of one lattice."""

_QUARTERS = ((0, 0), (2, 2), (0, 2), (2, 0))
_SHIFTS = ((0, 0), (1, 1), (0, 1), (1, 0))


@lru_cache(maxsize=32)
def dither_order(rows: int, cols: int) -> NDArray[np.uint16]:
    """Every taxel once: 16 lattices of every fourth row and column, one after the other, each row by row.

    The lattices follow one another as the ranks of a 4 x 4 matrix of ordered dithering (B. E. Bayer, 1973), so that
    four that begin at a multiple of four make a lattice of every second row and column. On 32 x 32, walking round and
    round, any 73 taxels in a row touch every block of 4 x 4, any 448 every block of 2 x 2.

    Returns
    -------
    np.ndarray [shape=(rows * cols,), dtype=uint16, read-only]
        Row-major taxel indices.
    """
    taxels = np.arange(rows * cols, dtype=np.uint16).reshape(rows, cols)
    lattices = [
        taxels[shift[0] + quarter[0] :: SPACING, shift[1] + quarter[1] :: SPACING].ravel()
        for shift in _SHIFTS
        for quarter in _QUARTERS
    ]
    order = np.concatenate(lattices)
    order.flags.writeable = False
    return order
