# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kinematics of the Universal Robots UR5e, and the wrist angles that tilt a plate carried on its flange.

The plate is mounted rigidly on the flange, the skin facing away from it. The skin's x, y and z axes are the flange's,
turned by a constant yaw about z. Lengths are in metres, angles in radians, joints in the order base, shoulder, elbow,
wrist 1, wrist 2, wrist 3. The robot's base is taken to stand level.

The *tilt* ``(tilt_x, tilt_y)`` of a plate is the rotation vector about the skin's x and y axes that took it away from
level. Two joints choose two of the three components of an attitude; the third, a twist about the plate's normal, is
left out: about 0.3 degrees at 6 degrees of tilt, and gravity in the plane of the skin does not depend on it. A solid
ball rolls with ``a_x = 5/7 g sin(tilt_y)`` and ``a_y = -5/7 g sin(tilt_x)``; where both are tilted, ``sin(tilt)`` is
the component times ``sin(angle) / angle``.

References
----------
.. [1] Universal Robots, "DH Parameters for calculations of kinematics and dynamics", article 45257, table UR5e
   (nominal values, without the calibration of an individual robot).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, atan2, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError

JOINTS = 6
"""Number of joints."""

DH_A_M = (0.0, -0.425, -0.3922, 0.0, 0.0, 0.0)
"""Denavit-Hartenberg link lengths [1]_."""

DH_D_M = (0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996)
"""Denavit-Hartenberg link offsets [1]_."""

DH_ALPHA_RAD = (pi / 2, 0.0, 0.0, pi / 2, -pi / 2, 0.0)
"""Denavit-Hartenberg link twists [1]_."""

LEVEL_Q_RAD = (0.0, -pi / 2, pi / 2, -pi / 2, pi / 2, 0.0)
"""Upper arm upright, forearm level, flange facing up; the axes of wrist 1 and wrist 2 are level and perpendicular."""

WRIST_1 = 3
WRIST_2 = 4
"""Where the two tilting joints stand in a vector of joint angles."""

# Steeper than this the two wrist joints do not reach every attitude near a level pose, and nothing here tilts so far.
_MAX_TILT_RAD = pi / 4


def forward_kinematics(q_rad: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Pose of the flange in the base frame.

    Parameters
    ----------
    q_rad : sequence [shape=(6,)]
        Joint angles [rad].

    Returns
    -------
    np.ndarray [shape=(4, 4), dtype=float64]
        Homogeneous transform base <- flange [m].

    Raises
    ------
    ArrayError
        When there are not six angles.
    """
    q1, q2, q3, q4, q5, q6 = _six(q_rad)
    _, a2, a3, _, _, _ = DH_A_M
    d1, _, _, d4, d5, d6 = DH_D_M
    c1, s1 = cos(q1), sin(q1)
    arm = q2 + q3
    wrist = arm + q4
    cw, sw = cos(wrist), sin(wrist)
    c5, s5 = cos(q5), sin(q5)
    c6, s6 = cos(q6), sin(q6)
    # Written out in the frame that turns with the base joint: x and z span the arm's plane, y is across.
    x = a2 * cos(q2) + a3 * cos(arm) + d5 * sw - d6 * s5 * cw
    y = -d4 - d6 * c5
    z = d1 + a2 * sin(q2) + a3 * sin(arm) - d5 * cw - d6 * s5 * sw
    xx, xy, xz = c6 * c5 * cw - s6 * sw, -c6 * s5, c6 * c5 * sw + s6 * cw
    yx, yy, yz = -s6 * c5 * cw - c6 * sw, s6 * s5, -s6 * c5 * sw + c6 * cw
    zx, zy, zz = -s5 * cw, -c5, -s5 * sw
    return np.array(
        [
            [c1 * xx - s1 * xy, c1 * yx - s1 * yy, c1 * zx - s1 * zy, c1 * x - s1 * y],
            [s1 * xx + c1 * xy, s1 * yx + c1 * yy, s1 * zx + c1 * zy, s1 * x + c1 * y],
            [xz, yz, zz, z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def wrist_angles_for_tilt(
    level_q_rad: Sequence[float] | NDArray[np.float64],
    tilt_x_rad: float,
    tilt_y_rad: float,
    mount_yaw_rad: float = 0.0,
) -> tuple[float, float]:
    """Angles of wrist 1 and wrist 2 that tilt the plate by exactly this much; the other joints stay as they are.

    Parameters
    ----------
    level_q_rad : sequence [shape=(6,)]
        A pose in which the plate is level (wrist 1 and wrist 2 need only be near it: they choose the branch).
    tilt_x_rad, tilt_y_rad : float
        Rotation vector about the skin's x and y axes, at most 45 degrees long [rad].
    mount_yaw_rad : float
        How far the skin is turned on the flange about z [rad].

    Returns
    -------
    q4_rad, q5_rad : float
        Angles of wrist 1 and wrist 2 [rad].

    Raises
    ------
    ArrayError
        When there are not six angles, or the tilt is not finite or is larger than 45 degrees.
    """
    _, q2, q3, q4, q5, q6 = _six(level_q_rad)
    angle = hypot(tilt_x_rad, tilt_y_rad)
    if not angle <= _MAX_TILT_RAD:  # also when it is NaN
        raise ArrayError(f"tilt = ({tilt_x_rad}, {tilt_y_rad}) rad: at most {_MAX_TILT_RAD:.3f} rad can be commanded")
    scale = sin(angle) / angle if angle > 0.0 else 1.0
    # The vertical seen from the skin, then turned into the axes of wrist 2's link.
    up_x, up_y, up_z = -scale * tilt_y_rad, scale * tilt_x_rad, cos(angle)
    turn = q6 + mount_yaw_rad
    link_x = cos(turn) * up_x - sin(turn) * up_y
    link_y = sin(turn) * up_x + cos(turn) * up_y
    # There the vertical is (cos q5 sin w, cos w, -sin q5 sin w) with w = q2 + q3 + q4; level has w = -90 or 90 degrees.
    level_wrist = q2 + q3 + q4
    side = 1.0 if sin(level_wrist) >= 0.0 else -1.0
    wrist = side * acos(link_y)
    return _near(wrist, level_wrist) - q2 - q3, _near(atan2(-up_z * side, link_x * side), q5)


def tilt_of(q_rad: Sequence[float] | NDArray[np.float64], mount_yaw_rad: float = 0.0) -> tuple[float, float]:
    """Tilt of the plate in a pose; the inverse of `wrist_angles_for_tilt`.

    Parameters
    ----------
    q_rad : sequence [shape=(6,)]
        Joint angles [rad].
    mount_yaw_rad : float
        How far the skin is turned on the flange about z [rad].

    Returns
    -------
    tilt_x_rad, tilt_y_rad : float
        Rotation vector about the skin's x and y axes [rad]; 0 to 180 degrees long.
    """
    _, q2, q3, q4, q5, q6 = _six(q_rad)
    wrist = q2 + q3 + q4
    link_x, link_y, up_z = cos(q5) * sin(wrist), cos(wrist), -sin(q5) * sin(wrist)
    turn = q6 + mount_yaw_rad
    up_x = cos(turn) * link_x + sin(turn) * link_y
    up_y = -sin(turn) * link_x + cos(turn) * link_y
    slope = hypot(up_x, up_y)
    scale = atan2(slope, up_z) / slope if slope > 0.0 else 1.0
    return scale * up_y, -scale * up_x


def _six(q_rad: Sequence[float] | NDArray[np.float64]) -> Sequence[float]:
    # Python floats: indexing and arithmetic on NumPy scalars costs several times as much.
    q: Sequence[float] = q_rad.tolist() if isinstance(q_rad, np.ndarray) else q_rad
    if len(q) != JOINTS:
        raise ArrayError(f"{len(q)} joint angles given; a UR5e has {JOINTS}")
    return q


def _near(angle_rad: float, near_rad: float) -> float:
    return angle_rad + 2 * pi * round((near_rad - angle_rad) / (2 * pi))
