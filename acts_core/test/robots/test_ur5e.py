# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kinematics against the product of Denavit-Hartenberg matrices, and tilts there and back."""

from math import pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.robots import ur5e

ANGLE = st.floats(-pi, pi)
TILT = st.floats(-0.3, 0.3)
G = 9.81


def denavit_hartenberg(theta: float, a: float, d: float, alpha: float) -> NDArray[np.float64]:
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])


def chain(q: list[float]) -> list[NDArray[np.float64]]:
    """Frames 0 to 6 in the base."""
    frames = [np.eye(4)]
    for theta, a, d, alpha in zip(q, ur5e.DH_A_M, ur5e.DH_D_M, ur5e.DH_ALPHA_RAD, strict=True):
        frames.append(frames[-1] @ denavit_hartenberg(theta, a, d, alpha))
    return frames


def rotation_vector(x: float, y: float) -> NDArray[np.float64]:
    angle = np.hypot(x, y)
    if angle == 0:
        return np.eye(3)
    k = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]]) / angle
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def skin(q: list[float], yaw: float = 0.0) -> NDArray[np.float64]:
    """Axes of the skin in the base."""
    c, s = np.cos(yaw), np.sin(yaw)
    return ur5e.forward_kinematics(q)[:3, :3] @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def tilted(level: list[float], x: float, y: float, yaw: float = 0.0) -> list[float]:
    q4, q5 = ur5e.wrist_angles_for_tilt(level, x, y, yaw)
    return [*level[:3], q4, q5, level[5]]


@given(st.lists(ANGLE, min_size=6, max_size=6))
def test_the_written_out_form_equals_the_product_of_matrices(q: list[float]) -> None:
    np.testing.assert_allclose(ur5e.forward_kinematics(q), chain(q)[-1], atol=1e-12)
    np.testing.assert_allclose(ur5e.forward_kinematics(np.array(q)), chain(q)[-1], atol=1e-12)


def test_stretched_out_it_is_as_long_as_its_links() -> None:
    # All joints at zero: the arm lies along -x, the flange faces -y.
    pose = ur5e.forward_kinematics([0.0] * 6)
    np.testing.assert_allclose(pose[:3, 3], [-0.425 - 0.3922, -0.1333 - 0.0996, 0.1625 - 0.0997], atol=1e-12)
    np.testing.assert_allclose(pose[:3, 2], [0, -1, 0], atol=1e-12)


def test_the_level_pose_faces_up_with_both_wrist_axes_level_and_perpendicular() -> None:
    frames = chain(list(ur5e.LEVEL_Q_RAD))
    np.testing.assert_allclose(frames[6][:3, 2], [0, 0, 1], atol=1e-12)
    wrist_1, wrist_2 = frames[ur5e.WRIST_1][:3, 2], frames[ur5e.WRIST_2][:3, 2]
    np.testing.assert_allclose([wrist_1[2], wrist_2[2], wrist_1 @ wrist_2], 0, atol=1e-12)
    assert frames[6][2, 3] > 0.5
    assert ur5e.tilt_of(ur5e.LEVEL_Q_RAD) == pytest.approx((0, 0), abs=1e-12)


@given(TILT, TILT, ANGLE, ANGLE, ANGLE)
def test_a_commanded_tilt_is_the_tilt_of_the_pose(x: float, y: float, base: float, yaw: float, q6: float) -> None:
    level = [base, *ur5e.LEVEL_Q_RAD[1:5], q6]
    q = tilted(level, x, y, yaw)
    np.testing.assert_allclose(ur5e.tilt_of(q, yaw), [x, y], atol=1e-9)
    # The vertical seen from the skin is that of a plate turned about the rotation vector.
    np.testing.assert_allclose(skin(q, yaw).T @ [0, 0, 1], rotation_vector(x, y).T @ [0, 0, 1], atol=1e-9)


@pytest.mark.parametrize(
    "level",
    [
        [0.3, -1.2, 1.0, -pi / 2 + 0.2, pi / 2, 0.7],
        [0.3, -1.2, 1.0, pi / 2 + 0.2, -pi / 2, 0.7],
        [0.3, -1.2, 1.0, 2 * pi - pi / 2 + 0.2, pi / 2 - 2 * pi, 0.7],
    ],
)
def test_every_level_pose_keeps_its_branch(level: list[float]) -> None:
    np.testing.assert_allclose(ur5e.wrist_angles_for_tilt(level, 0, 0), level[3:5], atol=1e-9)
    q = tilted(level, 0.1, -0.05)
    assert np.max(np.abs(np.subtract(q, level))) < 0.2
    np.testing.assert_allclose(ur5e.tilt_of(q), [0.1, -0.05], atol=1e-9)


def test_tilt_about_one_axis_accelerates_along_the_other() -> None:
    level = list(ur5e.LEVEL_Q_RAD)
    for x, y in ((0.1, 0.0), (0.0, 0.1)):
        gravity = skin(tilted(level, x, y)).T @ [0, 0, -G]
        np.testing.assert_allclose(gravity[:2], [G * sin(y), -G * sin(x)], atol=1e-9)


def test_the_twist_about_the_normal_is_small() -> None:
    level = list(ur5e.LEVEL_Q_RAD)
    limit = np.deg2rad(6)
    for direction in np.linspace(0, 2 * pi, 16):
        x, y = limit * np.cos(direction), limit * np.sin(direction)
        twist = rotation_vector(x, y).T @ skin(level).T @ skin(tilted(level, x, y))
        assert abs(np.arctan2(twist[1, 0], twist[0, 0])) < np.deg2rad(0.32)


@pytest.mark.parametrize("tilt", [(float("nan"), 0.0), (0.0, float("inf")), (0.8, 0.0)])
def test_a_tilt_that_cannot_be_is_refused(tilt: tuple[float, float]) -> None:
    with pytest.raises(ArrayError, match="tilt"):
        ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, *tilt)


def test_a_wrong_number_of_joints_is_refused() -> None:
    for function in (ur5e.forward_kinematics, ur5e.tilt_of):
        with pytest.raises(ArrayError, match="5 joint angles"):
            function([0.0] * 5)
