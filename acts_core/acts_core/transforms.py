# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Rigid transforms between frames: a rotation and a translation."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError

_LENGTH_TOLERANCE = 0.01

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Transform:
    """Where a frame lies in another: a point p of the frame is at ``rotation(p) + position_m`` there.

    Attributes
    ----------
    position_m : tuple of float
        The frame's origin: x, y, z [m].
    quaternion : tuple of float
        Its orientation: x, y, z, w, of length 1.
    """

    position_m: Vector = (0.0, 0.0, 0.0)
    quaternion: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        if not all(math.isfinite(number) for number in (*self.position_m, *self.quaternion)):
            raise SettingsError(f"position {self.position_m}, quaternion {self.quaternion}: allowed are finite numbers")
        length = math.hypot(*self.quaternion)
        if abs(length - 1.0) > _LENGTH_TOLERANCE:
            raise SettingsError(f"quaternion_xyzw = {list(self.quaternion)}: its length is {length:.4g}, needed is 1")
        object.__setattr__(self, "quaternion", tuple(number / length for number in self.quaternion))

    @classmethod
    def from_rpy(cls, position_m: Vector, rpy_rad: Vector) -> Transform:
        """By roll, pitch and yaw [rad] about the fixed x, y and z axes, in this order, as in URDF."""
        (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle / 2), math.sin(angle / 2)) for angle in rpy_rad)
        quaternion = (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )
        return cls(position_m, quaternion)

    def rotation(self) -> NDArray[np.float64]:
        """The rotation as a matrix; np.ndarray [shape=(3, 3), dtype=float64], columns the frame's axes."""
        x, y, z, w = self.quaternion
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )

    def points(self, points_m: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points of the frame in the other one; both np.ndarray [shape=(n, 3), dtype=float64] [m]."""
        return points_m @ self.rotation().T + np.asarray(self.position_m)

    def __matmul__(self, inner: Transform) -> Transform:
        """First `inner`, then this one: the transform from the innermost frame to the outermost."""
        ax, ay, az, aw = self.quaternion
        bx, by, bz, bw = inner.quaternion
        x, y, z = self.points(np.array([inner.position_m]))[0]
        return Transform(
            (float(x), float(y), float(z)),
            (
                aw * bx + ax * bw + ay * bz - az * by,
                aw * by - ax * bz + ay * bw + az * bx,
                aw * bz + ax * by - ay * bx + az * bw,
                aw * bw - ax * bx - ay * by - az * bz,
            ),
        )

    def inverse(self) -> Transform:
        """Where the other frame lies in this one."""
        x, y, z, w = self.quaternion
        px, py, pz = -(self.rotation().T @ np.asarray(self.position_m))
        return Transform((float(px), float(py), float(pz)), (-x, -y, -z, w))
