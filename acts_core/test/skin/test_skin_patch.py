# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the taxels of a patch lie, flat and bent."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.skin import SkinPatch
from acts_core.transforms import Transform

TURNED = Transform.from_rpy((0.1, -0.2, 0.3), (0.0, np.pi / 2, 0.0))


def patch(radius_m: float = 0.0, row_radius_m: float = 0.0, pose: Transform = TURNED) -> SkinPatch:
    return SkinPatch("tip", 4, 12, 8, 13, "distal", 0.003, 0.002, pose, radius_m, row_radius_m)


def test_a_flat_patch_lies_where_its_pose_says() -> None:
    points_m, normals = patch().points_m(), patch().normals()
    assert points_m.shape == normals.shape == (8, 5, 3)
    assert points_m.mean(axis=(0, 1)) == pytest.approx([0.1, -0.2, 0.3])
    # Turned about y: the skin's x points to -z of the link, its z to x.
    assert points_m[3, 4] - points_m[3, 3] == pytest.approx([0, 0, -0.003])
    assert points_m[2, 1] - points_m[3, 1] == pytest.approx([0, 0.002, 0])
    assert normals.reshape(-1, 3) == pytest.approx(np.tile([1.0, 0, 0], (40, 1)))
    assert patch().rotation[:, 2] == pytest.approx([1, 0, 0])
    assert patch().geometry.taxel_area_m2 == pytest.approx(6e-6)


@pytest.mark.parametrize("radii", [(0.01, 0.0), (0.0, 0.01), (0.01, 0.02), (-0.01, 0.0), (0.01, 0.01)])
def test_a_bent_patch_keeps_its_middle_and_its_normals_point_out(radii: tuple[float, float]) -> None:
    bent = patch(*radii, pose=Transform())
    points_m, normals = bent.points_m(), bent.normals()
    assert np.linalg.norm(normals, axis=-1) == pytest.approx(np.ones((8, 5)))
    # The normal is at right angles to what leads to the taxels beside it.
    along, across = np.diff(points_m, axis=1), np.diff(points_m, axis=0)
    middle = (normals[:, 1:] + normals[:, :-1]) / 2
    assert np.einsum("ijk,ijk->ij", along, middle) == pytest.approx(0, abs=1e-12)
    middle = (normals[1:] + normals[:-1]) / 2
    assert np.einsum("ijk,ijk->ij", across, middle) == pytest.approx(0, abs=1e-12)
    assert abs(points_m[3:5, 2].mean(axis=0)) == pytest.approx(0, abs=1e-4)
    edge = points_m[0, 0, 2]
    assert edge < 0 if max(radii) > 0 else edge > 0


@given(st.floats(0.02, 1.0))
def test_a_dome_of_equal_radii_is_a_sphere(radius_m: float) -> None:
    points_m = patch(radius_m, radius_m, Transform()).points_m()
    assert np.linalg.norm(points_m - [0, 0, -radius_m], axis=-1) == pytest.approx(np.full((8, 5), radius_m))
