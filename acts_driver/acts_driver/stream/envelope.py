# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Lower envelope: the closest line under all points of a window.

The closest line under a set of points holds the edge of their lower convex hull at their mean (Moon, Skelly and
Towsley, INFOCOM 1999, doi:10.1109/INFCOM.1999.749287).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from itertools import pairwise

Point = tuple[int, int]

_BINS = 20


class LowerEnvelope:
    """Follows the lower envelope of points whose x ascends, in constant time and memory.

    Only the lowest point of each twentieth of the window is kept. The line is computed anew when a twentieth is full;
    in between, a point below the line lowers it.

    Parameters
    ----------
    window : int
        Range of x that counts.
    slope_from : int
        Range of x from which on a slope is estimated; below, the line is level.
    slope_max : float
        Largest slope, either way.
    first : tuple of int
        The first point.
    """

    def __init__(self, window: int, slope_from: int, slope_max: float, first: Point) -> None:
        self._bin_width = window // _BINS
        self._slope_from = slope_from
        self._slope_max = slope_max
        self._x, self._y = first
        self._bins: deque[Point] = deque(maxlen=_BINS)
        self._bin_start = first[0]
        self._lowest: Point | None = first
        self.slope = 0.0

    def at(self, x: int) -> int:
        """y of the line."""
        return self._y + int(self.slope * (x - self._x))

    def observe(self, x: int, y: int) -> int:
        """Update by a point; its height above the line as it was before."""
        height = y - self.at(x)
        if height < 0:
            self._y += height
        if self._lowest is None or y - self._lowest[1] < self.slope * (x - self._lowest[0]):
            self._lowest = (x, y)
        if x - self._bin_start >= self._bin_width:
            self._bins.append(self._lowest)
            self._bin_start = x
            self._lowest = None
            self._fit()
        return height

    def _fit(self) -> None:
        newest_x = self._bins[-1][0]
        while newest_x - self._bins[0][0] > self._bin_width * (_BINS + 1):
            self._bins.popleft()
        self.slope = 0.0
        if newest_x - self._bins[0][0] >= self._slope_from:
            self.slope = min(max(hull_slope(self._bins), -self._slope_max), self._slope_max)
        self._x, self._y = min(self._bins, key=lambda point: point[1] - self.slope * (point[0] - newest_x))


def hull_slope(points: Sequence[Point]) -> float:
    """Slope of the closest line under points of ascending x; 0 for a single one."""
    hull: list[Point] = []
    for point in points:
        while len(hull) >= 2 and _turn(hull[-2], hull[-1], point) <= 0:
            hull.pop()
        hull.append(point)
    mean_x = sum(x for x, _ in points) / len(points)
    for start, end in pairwise(hull):
        if end[0] >= mean_x:
            return (end[1] - start[1]) / (end[0] - start[0])
    return 0.0


def _turn(a: Point, b: Point, c: Point) -> int:
    """Positive where the way from a over b to c turns to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
