# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The plate under the ball: its motion from the motion of the arm's joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.kernels import as_compiled
from acts_core.robots import ur5e
from acts_core.settings import setting, validate
from acts_sim.ball.ball_kernels import plate_motion

_DH = np.column_stack([ur5e.DH_A_M, ur5e.DH_D_M, ur5e.DH_ALPHA_RAD])

# Short relative to the arm's motion, long relative to rounding: 1e-16 m / (1 ms)^2 is 1e-10 m/s^2.
_DIFFERENCE_S = 0.001

# Joints of a UR5e turn by 2 pi to either side at up to pi rad/s; values far beyond that are errors.
_LARGEST_ANGLE_RAD = 100.0
_LARGEST_VELOCITY_RAD_S = 100.0
_LARGEST_ACCELERATION_RAD_S2 = 1e5


@dataclass(frozen=True)
class PlateConfig:
    """How the plate is mounted on the UR5e's flange."""

    mount_yaw_rad: float = setting(
        0.0, "angle of the skin relative to the flange about its z axis [rad]", minimum=-7.0, maximum=7.0
    )
    surface_height_m: float = setting(
        0.020, "distance of the skin's surface from the flange [m]", minimum=0.0, maximum=0.5
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class JointMotion:
    """State of the arm's joints at one time.

    Attributes
    ----------
    q_rad, qd_rad_s, qdd_rad_s2 : np.ndarray [shape=(6,), dtype=float64]
        Angles, velocities and accelerations, base to wrist 3.

    Raises
    ------
    ArrayError
        When one of them is of another kind or size.
    """

    q_rad: NDArray[np.float64]
    qd_rad_s: NDArray[np.float64]
    qdd_rad_s2: NDArray[np.float64]

    def __post_init__(self) -> None:
        for name, values in (("q_rad", self.q_rad), ("qd_rad_s", self.qd_rad_s), ("qdd_rad_s2", self.qdd_rad_s2)):
            # Lists come from callers without types.
            if not isinstance(values, np.ndarray):
                raise ArrayError(f"{name} is {type(values).__name__}: needed is an array of numpy, of 6 float64")
            if values.shape != (6,) or values.dtype != np.float64:
                raise ArrayError(f"{name} of shape {values.shape}, {values.dtype}: needed is (6,), float64")

    @classmethod
    def still(cls, q_rad: NDArray[np.float64]) -> JointMotion:
        """An arm at rest at angles [rad], shape (6,); raises as the class does."""
        return cls(np.asarray(q_rad, dtype=np.float64), np.zeros(6), np.zeros(6))

    def is_plausible(self) -> bool:
        """Whether every number is finite and possible for an arm."""
        # A comparison with NaN is false.
        return bool(
            np.abs(self.q_rad).max() <= _LARGEST_ANGLE_RAD
            and np.abs(self.qd_rad_s).max() <= _LARGEST_VELOCITY_RAD_S
            and np.abs(self.qdd_rad_s2).max() <= _LARGEST_ACCELERATION_RAD_S2
        )


@dataclass(frozen=True)
class PlateMotion:
    """Motion of the plate, in the skin's frame.

    Attributes
    ----------
    rows : np.ndarray [shape=(4, 3), dtype=float64]
        Gravity minus the acceleration of the surface's origin [m/s^2]; angular velocity [rad/s]; angular acceleration
        [rad/s^2]; upward vertical (unit vector).
    """

    rows: NDArray[np.float64]

    @property
    def slope(self) -> float:
        """Sine of the plate's tilt from horizontal; 2 where it is upside down."""
        x, y, z = self.rows[3].tolist()
        return float((x * x + y * y) ** 0.5) if z > 0 else 2.0

    @property
    def turn_rate_rad_s(self) -> float:
        """Angular speed of the plate [rad/s]."""
        x, y, z = self.rows[1].tolist()
        return float((x * x + y * y + z * z) ** 0.5)


def motion(config: PlateConfig, joints: JointMotion) -> PlateMotion:
    """Motion of the plate for a motion of the joints."""
    rows = plate_motion(
        as_compiled(joints.q_rad),
        as_compiled(joints.qd_rad_s),
        as_compiled(joints.qdd_rad_s2),
        _DH,
        config.mount_yaw_rad,
        config.surface_height_m,
        _DIFFERENCE_S,
    )
    return PlateMotion(rows)
