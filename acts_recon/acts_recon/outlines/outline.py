# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The outline of one contact in one frame."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_DENSE_M = 2e-4


@dataclass(frozen=True)
class Outline:
    """A closed polygon around what touches; counter-clockwise seen from outside, the last corner joined to the first.

    Attributes
    ----------
    number : int
        Which contact; from 1, the same while it lasts.
    time_s : float
        The moment it is of: the middle of the frame's measurements [s].
    x_m, y_m : np.ndarray [shape=(n,), dtype=float64]
        The corners in the skin's frame [m].
    growth_m2_s : float
        How fast the area grows; below 0 where it shrinks; 0 in the first frame [m^2/s].
    """

    number: int
    time_s: float
    x_m: Array
    y_m: Array
    growth_m2_s: float = 0.0

    @property
    def area_m2(self) -> float:
        """Inside of it [m^2]."""
        return float(self.x_m @ np.roll(self.y_m, -1) - np.roll(self.x_m, -1) @ self.y_m) / 2

    @property
    def perimeter_m(self) -> float:
        """Length of the edge [m]."""
        return float(np.hypot(self.x_m - np.roll(self.x_m, -1), self.y_m - np.roll(self.y_m, -1)).sum())

    @property
    def centre_m(self) -> tuple[float, float]:
        """Centre of the area [m]."""
        first, (x, y), whole = self._moments()
        return first[0] + x / whole, first[1] + y / whole

    @property
    def orientation_rad(self) -> float:
        """Direction of the longest extent, from x towards y, above -pi/2 to pi/2; 0 where it has none [rad]."""
        centre_x, centre_y = self.centre_m
        x, y = self.x_m - centre_x, self.y_m - centre_y
        next_x, next_y = np.roll(x, -1), np.roll(y, -1)
        cross = x * next_y - next_x * y
        xx = float(cross @ (x * x + x * next_x + next_x * next_x)) / 12
        yy = float(cross @ (y * y + y * next_y + next_y * next_y)) / 12
        xy = float(cross @ (x * next_y + 2 * x * y + 2 * next_x * next_y + next_x * y)) / 24
        if math.hypot(xx - yy, 2 * xy) <= 1e-6 * (xx + yy):
            return 0.0
        angle = math.atan2(2 * xy, xx - yy) / 2
        return math.pi / 2 if angle <= -math.pi / 2 else angle

    def _moments(self) -> tuple[tuple[float, float], tuple[float, float], float]:
        """A corner, first moments of the area around it times its size, and the size [m, m^3, m^2]."""
        first = float(self.x_m[0]), float(self.y_m[0])
        x, y = self.x_m - first[0], self.y_m - first[1]
        cross = x * np.roll(y, -1) - np.roll(x, -1) * y
        whole = max(float(cross.sum()) / 2, 1e-12)
        return first, (float(cross @ (x + np.roll(x, -1))) / 6, float(cross @ (y + np.roll(y, -1))) / 6), whole


def mean_distance_m(one: Array, other: Array) -> float:
    """Mean distance of two closed polygons: from points all along each to the nearest of the other, both ways [m].

    Parameters
    ----------
    one, other : np.ndarray [shape=(n, 2), dtype=float64]
        Corners [m], the last joined to the first.
    """
    from scipy.spatial import cKDTree

    first, second = _dense(one), _dense(other)
    there, back = cKDTree(second).query(first)[0], cKDTree(first).query(second)[0]
    return float(there.mean() + back.mean()) / 2


def way_around(corners: Array) -> tuple[Array, Array]:
    """The way around a polygon.

    Parameters
    ----------
    corners : np.ndarray [shape=(n, 2), dtype=float64]
        The last is joined to the first [m].

    Returns
    -------
    closed : np.ndarray [shape=(n + 1, 2), dtype=float64]
        The corners, the first one again at the end [m].
    along_m : np.ndarray [shape=(n + 1,), dtype=float64]
        How far each is from the first, along the polygon [m].
    """
    closed = np.vstack((corners, corners[:1]))
    return closed, np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))))


def _dense(corners: Array) -> Array:
    closed, along = way_around(corners)
    at = np.linspace(0.0, along[-1], max(int(along[-1] / _DENSE_M), 8))
    return np.column_stack([np.interp(at, along, closed[:, k]) for k in (0, 1)])
