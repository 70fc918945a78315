# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Layouts are permutations; insole and glove are those of the authors' analysis."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import LAYOUTS, layout


@pytest.mark.parametrize("name", LAYOUTS)
def test_every_taxel_has_one_place_and_back(name: str) -> None:
    shape = layout(name)
    assert sorted(shape.taxels.ravel().tolist()) == list(range(1024))
    assert shape.places[shape.taxels.ravel()].tolist() == list(range(1024))
    values = np.random.default_rng(1).integers(0, 1024, (32, 32))
    assert np.array_equal(shape.matrix(shape.picture(values)), values)
    assert shape.picture(values).shape == (shape.rows, shape.cols)


@pytest.mark.parametrize("name", LAYOUTS)
def test_neighbours_are_those_on_the_skin_and_on_one_patch(name: str) -> None:
    shape = layout(name)
    assert shape.neighbours.shape == (1024, 8)
    for row in range(shape.rows):
        for col in range(shape.cols):
            expected = {
                int(shape.taxels[r, c])
                for r in range(max(row - 1, 0), min(row + 2, shape.rows))
                for c in range(max(col - 1, 0), min(col + 2, shape.cols))
                if (r, c) != (row, col) and shape.patch_of[r, c] == shape.patch_of[row, col]
            }
            found = shape.neighbours[shape.taxels[row, col]]
            assert set(found[found >= 0].tolist()) == expected
            assert (found >= 0).sum() == len(expected)


@given(st.integers(1, 64), st.integers(1, 64))
def test_square_is_the_matrix_of_any_size(rows: int, cols: int) -> None:
    shape = layout("square", rows, cols)
    assert np.array_equal(shape.taxels, np.arange(rows * cols).reshape(rows, cols))
    assert shape.geometry() == ArrayGeometry(rows, cols, row_pitch_m=ArrayGeometry().pitch_m)


def test_of_the_shipped_skins_one_is_stood_on_and_of_a_square_pad_it_is_not_known() -> None:
    assert {name for name in LAYOUTS if layout(name).stood_on} == {"insole"}
    assert {name for name in LAYOUTS if layout(name).stood_on is None} == {"square"}


def test_insole_as_published() -> None:
    # Loops instead of array operations: column first into 64 x 16, upper half flipped, turned by 180 degrees.
    expected = np.zeros((64, 16), dtype=int)
    for index in range(1024):
        row, col = index % 64, index // 64
        if row < 32:
            row = 31 - row
        expected[63 - row, 15 - col] = index
    assert np.array_equal(layout("insole").taxels, expected)


def test_two_wires_of_the_insole_run_from_its_middle_to_its_ends() -> None:
    shape = layout("insole")
    column = [divmod(int(index), 32) for index in shape.taxels[:, 15]]
    assert column == [(1, col) for col in range(31, -1, -1)] + [(0, col) for col in range(32)]


def test_glove_as_published() -> None:
    shape = layout("glove")
    for row in range(32):
        for col in range(32):
            # Turned counter-clockwise: the last column becomes the first row.
            assert shape.taxels[row, col] == 32 * col + 31 - row


def test_patches_of_the_glove() -> None:
    shape = layout("glove")
    sizes = {patch.name: patch.of(shape.taxels).shape for patch in shape.patches}
    assert sizes == {
        "palm": (16, 24),
        "thumb": (16, 8),
        "index": (16, 8),
        "middle": (16, 8),
        "ring": (16, 8),
        "little": (16, 8),
    }
    places = {"thumb": (31, 0), "palm": (16, 8), "index": (0, 7), "middle": (15, 8), "ring": (3, 23), "little": (0, 31)}
    assert {shape.patch(*place).name for place in places.values()} == set(sizes)
    for name, place in places.items():
        assert shape.patch(*place).name == name


@pytest.mark.parametrize("name", LAYOUTS)
def test_patches_cover_the_picture_once(name: str) -> None:
    shape = layout(name)
    covered = np.zeros((shape.rows, shape.cols), dtype=int)
    for index, patch in enumerate(shape.patches):
        patch.of(covered)[...] += 1
        assert (patch.of(shape.patch_of) == index).all()
    assert (covered == 1).all()
    assert np.array_equal(shape.picture(shape.patch_of_taxel), shape.patch_of)
    assert shape.is_matrix == (name not in ("insole", "glove", "leap_right"))


def test_patches_of_the_leap_hand() -> None:
    shape = layout("leap_right")
    fingers = ("index", "middle", "ring", "thumb")
    segments = [f"{finger}_{segment}" for finger in fingers for segment in ("proximal", "medial", "distal")]
    assert [patch.name for patch in shape.patches] == ["palm", *segments]
    assert [patch.of(shape.taxels).shape for patch in shape.patches] == [(16, 16)] + 12 * [(8, 8)]
    assert shape.patches[0].link == "palm_lower"
    assert {patch.link.split("_")[0] for patch in shape.patches[1:]} == set(fingers)
    assert [patch.link for patch in shape.patches[2::3]] == [f"{finger}_medial" for finger in fingers]
    assert [patch.link for patch in shape.patches[3::3]] == [f"{finger}_distal" for finger in fingers]
    # Out of the palm is -z of its link; the sense in which the fingers close.
    assert shape.patches[0].normals()[8, 8] == pytest.approx([0, 0, -1], abs=1e-6)


def test_the_patch_of_a_pad_lies_as_its_picture() -> None:
    shape = layout("square", 20, 12)
    (pad,) = shape.patches
    points_m = pad.points_m()
    assert points_m[..., 0] == pytest.approx(np.tile(shape.geometry().x_m(np.arange(12)), (20, 1)))
    assert points_m[..., 1] == pytest.approx(np.tile(shape.geometry().y_m(np.arange(20)), (12, 1)).T)
    thumb = layout("glove").patches[1]
    assert thumb.origin_m == pytest.approx([-12 * 0.005625, -8 * 0.0071875, 0])


@pytest.mark.parametrize(
    ("name", "width_m", "height_m"),
    [
        ("square", 0.140, 0.140),
        ("insole", 0.085, 0.280),
        ("glove", 0.180, 0.230),
        ("arm", 0.140, 0.140),
        ("chest", 0.140, 0.140),
        ("end_effector", 0.064, 0.064),
        ("helmet", 0.140, 0.140),
        ("leg", 0.140, 0.140),
    ],
)
def test_sizes_of_the_papers_skins(name: str, width_m: float, height_m: float) -> None:
    geometry = layout(name).geometry()
    assert geometry.cols * geometry.pitch_m == pytest.approx(width_m)
    assert geometry.rows * geometry.pitch_y_m == pytest.approx(height_m)
    assert geometry.size * geometry.taxel_area_m2 == pytest.approx(width_m * height_m)


@pytest.mark.parametrize(("name", "radius_m"), [("arm", 0.050), ("helmet", 0.115), ("leg", 0.080)])
def test_bent_skins_stand_out_in_the_middle(name: str, radius_m: float) -> None:
    shape = layout(name)
    (patch,) = shape.patches
    middle, edge = patch.points_m()[16, [16, 0]]
    angle = 15.5 * shape.pitch_m / radius_m
    assert edge[0] == pytest.approx(-radius_m * np.sin(angle))
    assert middle[2] - edge[2] == pytest.approx(radius_m * (1 - np.cos(angle)), rel=0.01)
    corner = patch.normals()[0, 0]
    assert (abs(corner[1]) > 0.1) == (name == "helmet")


def test_a_pitch_of_ones_own() -> None:
    insole = layout("insole")
    assert insole.geometry(0.002) == ArrayGeometry(64, 16, 0.002, 0.002)
    assert insole.geometry(0.002, 0.003) == ArrayGeometry(64, 16, 0.002, 0.003)
    assert insole.geometry(row_pitch_m=0.003) == ArrayGeometry(64, 16, insole.pitch_m, 0.003)


def test_patches_that_lie_as_in_the_picture_have_its_pitch() -> None:
    glove = layout("glove")
    assert glove.spaced().patches == glove.patches
    larger = glove.spaced(0.008, 0.010)
    geometry = glove.geometry(0.008, 0.010)
    assert larger.geometry() == geometry
    for patch in larger.patches:
        rows, cols = np.arange(patch.first_row, patch.end_row), np.arange(patch.first_col, patch.end_col)
        x_m, y_m = np.meshgrid(geometry.x_m(cols), geometry.y_m(rows))
        assert patch.points_m() == pytest.approx(np.stack((x_m, y_m, np.zeros_like(x_m)), axis=-1))
        assert patch.geometry.taxel_area_m2 == pytest.approx(0.008 * 0.010)


def test_patches_on_links_keep_the_size_that_the_layout_gives() -> None:
    hand = layout("leap_right")
    assert hand.spaced(0.008).patches == hand.patches


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("sock",), "'sock'.*square, arm, .*, leap_right, leg, or the path"),
        (("insole", 64, 16), "64 x 16.*use another layout"),
        (("glove", 16, 32), "16 x 32"),
        (("square", 65, 1), "rows = 65"),
    ],
)
def test_what_there_is_not_is_refused(arguments: tuple, words: str) -> None:
    with pytest.raises(ArrayError, match=words):
        layout(*arguments)


def test_wrong_shapes_and_places_are_refused() -> None:
    insole = layout("insole")
    with pytest.raises(ArrayError, match=r"matrix of shape \(64, 16\)"):
        insole.picture(np.zeros((64, 16)))
    with pytest.raises(ArrayError, match=r"picture of shape \(32, 32\)"):
        insole.matrix(np.zeros((32, 32)))
    with pytest.raises(ArrayError, match=r"place \(64, 0\)"):
        insole.patch(64, 0)
