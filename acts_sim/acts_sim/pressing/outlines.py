# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines and undersides of objects: functions of a grid's points in an object's frame [m]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Field = NDArray[np.float64]
"""A number for every point of a grid."""

_EDGE_SLOPE = 4.0
"""Rise over run of the rounded edge of a printed or cut shape."""


# Signed distances from the edge of flat outlines [m], negative inside.


def disc(x: Field, y: Field, radius_m: float) -> Field:
    """Disc around the origin."""
    return np.hypot(x, y) - radius_m


def box(x: Field, y: Field, width_m: float, height_m: float) -> Field:
    """Rectangle around the origin."""
    dx, dy = np.abs(x) - width_m / 2, np.abs(y) - height_m / 2
    return np.hypot(np.maximum(dx, 0), np.maximum(dy, 0)) + np.minimum(np.maximum(dx, dy), 0)


def rounded_box(x: Field, y: Field, width_m: float, height_m: float, corner_m: float) -> Field:
    """Rectangle around the origin; `corner_m` is the radius of its corners."""
    return box(x, y, width_m - 2 * corner_m, height_m - 2 * corner_m) - corner_m


def ring(x: Field, y: Field, radius_m: float, width_m: float) -> Field:
    """Ring around the origin; `radius_m` is to the middle of its band."""
    return np.abs(np.hypot(x, y) - radius_m) - width_m / 2


def convex_polygon(x: Field, y: Field, corners: int, radius_m: float) -> Field:
    """Regular polygon around the origin; `radius_m` is to its corners, the first of which is at the top."""
    angles = np.pi / 2 + np.pi / corners + 2 * np.pi * np.arange(corners) / corners
    apothem = radius_m * np.cos(np.pi / corners)
    sides = np.stack([x * np.cos(a) + y * np.sin(a) for a in angles])
    return np.max(sides, axis=0) - apothem


def bar(x: Field, y: Field, length_m: float, width_m: float, angle_rad: float) -> Field:
    """Bar around the origin, turned by `angle_rad`."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return box(c * x + s * y, -s * x + c * y, length_m, width_m)


def without(distance: Field, *holes: Field) -> Field:
    """An outline minus others."""
    return np.maximum.reduce([distance, *(-hole for hole in holes)])


def union(*distances: Field) -> Field:
    """Union of outlines."""
    return np.minimum.reduce(distances)


# Gaps [m].


def prism(distance: Field) -> Field:
    """Gap of a flat underside with an outline and a steep, rounded edge."""
    return np.maximum(distance, 0.0) * _EDGE_SLOPE


def ellipsoid(x: Field, y: Field, radius_x_m: float, radius_y_m: float, radius_z_m: float) -> Field:
    """Gap of an ellipsoid resting on its lowest point."""
    square = (x / radius_x_m) ** 2 + (y / radius_y_m) ** 2
    return radius_z_m * np.where(square < 1, 1 - np.sqrt(np.maximum(1 - square, 0.0)), 1 + (square - 1))


def lying_cylinder(x: Field, y: Field, length_m: float, radius_m: float) -> Field:
    """Gap of a cylinder that lies along x."""
    round_side = (
        radius_m - np.sqrt(np.maximum(radius_m**2 - y**2, 0.0)) + np.maximum(np.abs(y) - radius_m, 0.0) * _EDGE_SLOPE
    )
    return np.maximum(round_side, prism(np.abs(x) - length_m / 2))
