# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Rigid transforms and trees of fixed frames."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.transforms import Transform
from acts_skins.frame_tree import FrameTree, Pose

LENGTHS = st.floats(-10.0, 10.0)
ANGLES = st.floats(-7.0, 7.0)
TRANSFORMS = st.builds(Transform.from_rpy, st.tuples(LENGTHS, LENGTHS, LENGTHS), st.tuples(ANGLES, ANGLES, ANGLES))
POINTS_M = np.array([[0.0, 0.0, 0.0], [0.1, -0.2, 0.3], [4.0, 5.0, -6.0]])


def axis_rotation(axis: int, angle_rad: float) -> np.ndarray:
    matrix = np.eye(3)
    a, b = (axis + 1) % 3, (axis + 2) % 3
    matrix[a, a] = matrix[b, b] = math.cos(angle_rad)
    matrix[b, a], matrix[a, b] = math.sin(angle_rad), -math.sin(angle_rad)
    return matrix


@given(ANGLES, ANGLES, ANGLES)
def test_roll_pitch_and_yaw_are_about_fixed_axes_in_this_order(roll: float, pitch: float, yaw: float) -> None:
    expected = axis_rotation(2, yaw) @ axis_rotation(1, pitch) @ axis_rotation(0, roll)
    np.testing.assert_allclose(Transform.from_rpy((0, 0, 0), (roll, pitch, yaw)).rotation(), expected, atol=1e-12)


@given(TRANSFORMS)
def test_a_rotation_keeps_lengths_and_hands(transform: Transform) -> None:
    matrix = transform.rotation()
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(matrix) == pytest.approx(1.0)
    assert math.hypot(*transform.quaternion) == pytest.approx(1.0)


@given(TRANSFORMS, TRANSFORMS)
def test_one_after_the_other_is_their_product(outer: Transform, inner: Transform) -> None:
    np.testing.assert_allclose((outer @ inner).points(POINTS_M), outer.points(inner.points(POINTS_M)), atol=1e-9)


@given(TRANSFORMS)
def test_the_inverse_leads_back(transform: Transform) -> None:
    np.testing.assert_allclose(transform.inverse().points(transform.points(POINTS_M)), POINTS_M, atol=1e-9)


@given(TRANSFORMS, TRANSFORMS, TRANSFORMS)
def test_the_way_between_frames_goes_over_their_common_root(arm: Transform, hand: Transform, foot: Transform) -> None:
    tree = FrameTree({"arm": Pose("torso", arm), "hand": Pose("arm", hand), "foot": Pose("torso", foot)})
    in_torso = arm.points(hand.points(POINTS_M))
    np.testing.assert_allclose(tree.between("torso", "hand").points(POINTS_M), in_torso, atol=1e-8)
    np.testing.assert_allclose(foot.points(tree.between("foot", "hand").points(POINTS_M)), in_torso, atol=1e-8)
    np.testing.assert_allclose(tree.between("hand", "hand").points(POINTS_M), POINTS_M, atol=1e-8)


def test_frames_that_nothing_connects_are_refused_with_both_roots() -> None:
    tree = FrameTree({"arm": Pose("torso", Transform()), "foot": Pose("floor", Transform())})
    with pytest.raises(SettingsError, match="foot is fixed to floor, and torso to torso"):
        tree.between("torso", "foot")


def test_frames_in_a_circle_are_refused() -> None:
    with pytest.raises(SettingsError, match="a in b in a"):
        FrameTree({"a": Pose("b", Transform()), "b": Pose("a", Transform())})


@pytest.mark.parametrize("quaternion", [(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.5, 0.5), (0.0, 0.0, 1.0, 1.0)])
def test_a_quaternion_of_another_length_is_refused(quaternion: tuple[float, float, float, float]) -> None:
    with pytest.raises(SettingsError, match="needed is 1"):
        Transform((0, 0, 0), quaternion)


def test_a_rounded_quaternion_is_made_exact() -> None:
    assert math.hypot(*Transform((0, 0, 0), (0.0, 0.0, 0.7071, 0.7071)).quaternion) == pytest.approx(1.0, abs=1e-15)


def test_numbers_that_are_none_are_refused() -> None:
    with pytest.raises(SettingsError, match="finite"):
        Transform((math.nan, 0, 0))
