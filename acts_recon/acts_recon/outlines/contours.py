# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Closed contours of a field on a grid: marching squares."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_Edge = tuple[int, int, int]
"""Row and column of its first corner, and 0 where it runs along the row, 1 along the column."""


def contours(field: Array, level: float) -> list[Array]:
    """Where a field crosses a level, interpolated linearly between the points of its grid.

    Around the field everything is taken for 0, so each contour is closed. What is above lies to the same side of all.

    Parameters
    ----------
    field : np.ndarray [shape=(rows, cols), dtype=float64]
        Finite.
    level : float
        Above 0.

    Returns
    -------
    list of np.ndarray [shape=(n, 2), dtype=float64]
        Row and column of the corners of each, in fractions of the grid; the last is joined to the first. Those around
        what is above have a positive `area`, those around a hole a negative one.
    """
    padded = np.pad(field, 1)
    above = padded > level
    mixed = above[:-1, :-1].astype(int) + above[:-1, 1:] + above[1:, 1:] + above[1:, :-1]
    after: dict[_Edge, _Edge] = {}
    for row, col in np.argwhere((mixed > 0) & (mixed < 4)).tolist():
        after.update(_segments(padded, above, level, row, col))
    found = []
    while after:
        first, edge = after.popitem()
        loop = [first]
        while edge != first:
            loop.append(edge)
            edge = after.pop(edge)
        found.append(np.array([_crossing(padded, level, one) for one in loop]) - 1.0)
    return found


def area(corners: Array) -> float:
    """Signed area of a polygon of rows and columns, in squares of the grid (Gauss' formula)."""
    row, col = corners.T
    return float(np.sum(row * np.roll(col, -1) - np.roll(row, -1) * col)) / 2


def _segments(padded: Array, above: NDArray[np.bool_], level: float, row: int, col: int) -> dict[_Edge, _Edge]:
    """Pieces of contours in the square between four points, from edge to edge; what is above is to the right."""
    corners = ((row, col), (row, col + 1), (row + 1, col + 1), (row + 1, col))
    edges = ((row, col, 0), (row, col + 1, 1), (row + 1, col, 0), (row, col, 1))
    inside = [bool(above[corner]) for corner in corners]
    into = [edges[k] for k in range(4) if inside[(k + 1) % 4] and not inside[k]]
    out = [edges[k] for k in range(4) if inside[k] and not inside[(k + 1) % 4]]
    if len(into) == 1:
        return {into[0]: out[0]}
    # A saddle: two opposite corners are above. They are joined where the middle is, too.
    is_joined = sum(float(padded[corner]) for corner in corners) / 4 > level
    pairs = {}
    for edge in into:
        k = edges.index(edge)
        pairs[edge] = edges[(k - 1) % 4] if is_joined else edges[(k + 1) % 4]
    return pairs


def _crossing(padded: Array, level: float, edge: _Edge) -> tuple[float, float]:
    row, col, along = edge
    first, last = float(padded[row, col]), float(padded[row + along, col + 1 - along])
    share = (level - first) / (last - first)
    return row + along * share, col + (1 - along) * share
