# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Conversion of poses of Universal Robots, x, y, z [m] and a rotation vector [rad], to transforms and back."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Pose = tuple[float, float, float, float, float, float]

Rows = list[list[float]]
"""Rows of a homogeneous transform as floats, for computations in every cycle."""

_TINY = 1e-12


def transform_from_pose(pose: Sequence[float]) -> NDArray[np.float64]:
    """Homogeneous transform, shape (4, 4), of a pose of six numbers (Rodrigues' formula)."""
    transform = np.eye(4)
    transform[:3, 3] = pose[:3]
    vector = np.asarray(pose[3:6], dtype=np.float64)
    angle = float(np.linalg.norm(vector))
    if angle > _TINY:
        x, y, z = vector / angle
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        transform[:3, :3] += math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)
    return transform


def pose_from_transform(transform: NDArray[np.float64]) -> Pose:
    """Pose of a homogeneous transform of shape (4, 4); the rotation vector is at most pi long."""
    return pose_from_rows(transform.tolist())


def pose_from_rows(rows: Rows) -> Pose:
    """Pose of a homogeneous transform given as its rows."""
    (r00, r01, r02, x), (r10, r11, r12, y), (r20, r21, r22, z) = rows[:3]
    # The axis times twice the sine; the angle from sine and cosine is accurate everywhere.
    ax, ay, az = r21 - r12, r02 - r20, r10 - r01
    twice_sine = math.sqrt(ax * ax + ay * ay + az * az)
    trace = r00 + r11 + r22
    angle = math.atan2(twice_sine, trace - 1.0)
    if twice_sine > 1e-6:
        factor = angle / twice_sine
        return x, y, z, factor * ax, factor * ay, factor * az
    if trace > 0.0:
        return x, y, z, 0.5 * ax, 0.5 * ay, 0.5 * az
    # Half a turn: R + I = 2 n n^T; the column of the largest component is the most accurate.
    columns = ((r00 + 1.0, r10, r20), (r01, r11 + 1.0, r21), (r02, r12, r22 + 1.0))
    largest = max(range(3), key=lambda index: columns[index][index])
    column = columns[largest]
    norm = math.sqrt(sum(value * value for value in column))
    nx, ny, nz = (value / norm for value in column)
    return x, y, z, angle * nx, angle * ny, angle * nz


def speed_between(before: Rows, after: Rows, dt_s: float) -> Pose:
    """Mean linear [m/s] and angular speed [rad/s] between two transforms `dt_s` apart, in the base frame."""
    (a0, a1, a2, ax), (b0, b1, b2, ay), (c0, c1, c2, az) = before[:3]
    (d0, d1, d2, dx), (e0, e1, e2, dy), (f0, f1, f2, dz) = after[:3]
    # The rotation between them is small: its vector is half the skew part of after * before transposed.
    wx = (f0 * b0 + f1 * b1 + f2 * b2) - (e0 * c0 + e1 * c1 + e2 * c2)
    wy = (d0 * c0 + d1 * c1 + d2 * c2) - (f0 * a0 + f1 * a1 + f2 * a2)
    wz = (e0 * a0 + e1 * a1 + e2 * a2) - (d0 * b0 + d1 * b1 + d2 * b2)
    twice = 2.0 * dt_s
    return (dx - ax) / dt_s, (dy - ay) / dt_s, (dz - az) / dt_s, wx / twice, wy / twice, wz / twice
