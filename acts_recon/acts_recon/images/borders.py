# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Borders in a picture: the edges of its patches, over which no taxel has a neighbour."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.skin import NO_PATCH, Layout


class Borders(NamedTuple):
    """The rectangles into which borders divide a picture.

    Attributes
    ----------
    rectangles : np.ndarray [shape=(n, 4), dtype=int32]
        First row, row behind the last, first column, column behind the last of each.
    rectangle_of : np.ndarray [shape=(rows * cols,), dtype=uint16]
        Index of the rectangle that holds each taxel.
    """

    rectangles: NDArray[np.int32]
    rectangle_of: NDArray[np.uint16]

    def bounds(self) -> NDArray[np.int32]:
        """The rectangle around each taxel; np.ndarray [shape=(rows * cols, 4), dtype=int32]."""
        return np.ascontiguousarray(self.rectangles[self.rectangle_of])

    def labelled(self, pressed: NDArray[np.bool_]) -> tuple[NDArray[np.intp], int]:
        """Number the contacts of a picture: pressed taxels that have a side or a corner in common, in one rectangle.

        Parameters
        ----------
        pressed : np.ndarray [shape=(rows, cols), dtype=bool]

        Returns
        -------
        labels : np.ndarray [shape=(rows, cols), dtype=intp]
            The number of the contact of each taxel, from 1; 0: none.
        number : int
            How many there are.
        """
        # Imported here: it would delay each start of the node.
        from scipy import ndimage

        labels = np.zeros(pressed.shape, dtype=np.intp)
        number = 0
        for first_row, end_row, first_col, end_col in self.rectangles.tolist():
            there = np.s_[first_row:end_row, first_col:end_col]
            if pressed[there].any():
                own, count = ndimage.label(pressed[there], structure=np.ones((3, 3)))
                labels[there] = np.where(own > 0, own + number, 0)
                number += int(count)
        return labels, number


def borders_of(rows: int, cols: int, layout: Layout | None = None) -> Borders:
    """The borders of a picture: without a layout it is one rectangle.

    Parameters
    ----------
    rows, cols : int
        Of the picture.
    layout : Layout, optional
        Its patches are the rectangles. Where there is no skin, every taxel is one of its own.
    """
    if layout is None:
        return Borders(np.array([[0, rows, 0, cols]], dtype=np.int32), np.zeros(rows * cols, dtype=np.uint16))
    patches = [patch.bounds for patch in layout.patches]
    of = layout.patch_of.astype(np.uint16)
    bare = np.argwhere(layout.patch_of == NO_PATCH)
    of[layout.patch_of == NO_PATCH] = len(patches) + np.arange(len(bare))
    return Borders(np.array([*patches, *((r, r + 1, c, c + 1) for r, c in bare)], dtype=np.int32), of.ravel())
