# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Regional contact maps: compared with NumPy, with the layout, and on any image."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import ForceResponse, Layout, RegionContact, SkinPatch, layout
from acts_recon.images import DeadTaxels
from acts_recon.regions import Regions
from acts_recon.settings import ReconstructionSettings

pytestmark = pytest.mark.slow

HAND = layout("leap_right")
RESPONSE = ForceResponse()


@cache
def hand_regions() -> Regions:
    """Made at its first use: numba compiles then, where no cache is."""
    return Regions(HAND, RESPONSE)


def press(patch: SkinPatch, row: float, col: float, counts: float = 600.0, width: float = 1.3) -> NDArray[np.float32]:
    """A round contact on a patch, as a picture of the hand; row and column are of the patch."""
    picture = np.zeros((HAND.rows, HAND.cols), dtype=np.float32)
    rows, cols = np.indices((patch.rows, patch.cols))
    patch.of(picture)[:] = counts * np.exp(-((rows - row) ** 2 + (cols - col) ** 2) / (2 * width**2))
    return picture


def by_numpy(image: NDArray[np.float32], skin: Layout, touch_counts: float = 60.0) -> list[RegionContact]:
    """The same contact maps, plainly; motion and slip left out."""
    found = []
    for patch in skin.patches:
        counts = np.asarray(patch.of(image), dtype=np.float64)
        pressed = counts > touch_counts
        if not pressed.any():
            found.append(RegionContact(patch.name, patch.link))
            continue
        force_n = RESPONSE.force_n(np.minimum(counts[pressed], 1023.0))
        row, col = (np.average(index, weights=force_n) for index in np.nonzero(pressed))
        # The skin between its taxels is as it was laid out: the patch, evaluated at a place between them.
        centre_m, normal = (bilinear(field, row, col) for field in (patch.points_m(), patch.normals()))
        away_m = np.linalg.norm(patch.points_m()[pressed] - centre_m, axis=-1)
        found.append(
            RegionContact(
                patch.name,
                patch.link,
                int(pressed.sum()),
                float(force_n.sum()),
                tuple(centre_m),
                tuple(normal / np.linalg.norm(normal)),
                pressed.sum() * patch.pitch_m * patch.row_pitch_m,
                float(force_n.max()),
                math.sqrt(np.average(away_m**2, weights=force_n)),
                float(force_n.max() / force_n.sum()),
            )
        )
    return found


def bilinear(field: NDArray[np.float64], row: float, col: float) -> NDArray[np.float64]:
    top, left = min(int(row), len(field) - 2), min(int(col), len(field[0]) - 2)
    down, right = row - top, col - left
    corners = field[top : top + 2, left : left + 2]
    return np.asarray((1 - down) * ((1 - right) * corners[0, 0] + right * corners[0, 1])) + down * (
        (1 - right) * corners[1, 0] + right * corners[1, 1]
    )


def assert_alike(found: list[RegionContact], expected: list[RegionContact]) -> None:
    assert [region[:3] for region in found] == [region[:3] for region in expected]
    for one, other in zip(found, expected, strict=True):
        for name in ("force_n", "area_m2", "peak_n", "spread_m", "concentration"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-2, abs=1e-9), name
        assert one.centre_m == pytest.approx(other.centre_m, abs=2e-5)
        assert one.normal == pytest.approx(other.normal, abs=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_each_patch_is_what_numpy_makes_of_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    image = rng.uniform(0, 1023, (HAND.rows, HAND.cols)).astype(np.float32)
    # Between two counts the kernel interpolates the response, which is steep near its end.
    image[image > 900] = 900
    for patch in rng.permutation(len(HAND.patches))[:6]:
        HAND.patches[patch].of(image)[:] = 0
    assert_alike(hand_regions().step(1.0, image), by_numpy(image, HAND))


@pytest.mark.parametrize(
    "bent", [{"radius_m": 0.02}, {"row_radius_m": 0.015}, {"radius_m": 0.02, "row_radius_m": 0.05}]
)
def test_on_a_bent_patch_the_centre_lies_on_the_skin(bent: dict[str, float]) -> None:
    finger = HAND.patches[3]
    patch = SkinPatch("finger", 0, 8, 0, 8, "link", 0.0025, 0.003, finger.pose, **bent)
    skin = Layout(
        "finger",
        np.arange(64, dtype=np.uint16).reshape(8, 8),
        np.arange(64, dtype=np.uint16),
        8,
        8,
        0.0025,
        0.003,
        (patch,),
        np.zeros((8, 8), dtype=np.uint8),
    )
    rows, cols = np.indices((8, 8))
    image = (600 * np.exp(-((rows - 5.3) ** 2 + (cols - 1.8) ** 2) / 2)).astype(np.float32)
    regions = Regions(skin, RESPONSE)
    assert_alike(regions.step(1.0, image), by_numpy(image, skin))
    (one,) = Regions(skin, RESPONSE, touch_counts=500.0).step(0.0, np.where(image == image.max(), image, 0))
    assert one.centre_m == pytest.approx(tuple(patch.points_m()[5, 2]))
    assert one.normal == pytest.approx(tuple(patch.normals()[5, 2]))
    assert (one.active_taxels, one.concentration, one.spread_m) == (1, 1.0, 0.0)


def test_of_a_single_taxel_the_place_is_that_of_the_layout_on_every_patch() -> None:
    for index, patch in enumerate(HAND.patches):
        image = np.zeros((HAND.rows, HAND.cols), dtype=np.float32)
        patch.of(image)[2, 5] = 400
        regions = hand_regions().step(0.0, image)
        assert [region.in_contact for region in regions] == [p == index for p in range(len(HAND.patches))]
        assert (regions[index].name, regions[index].link) == (patch.name, patch.link)
        assert regions[index].centre_m == pytest.approx(tuple(patch.points_m()[2, 5]))
        assert regions[index].normal == pytest.approx(tuple(patch.normals()[2, 5]))
        assert regions[index].force_n == regions[index].peak_n == pytest.approx(float(RESPONSE.force_n(400.0)))


def test_where_the_pitch_is_given_regions_lie_where_contacts_do() -> None:
    given = ReconstructionSettings(layout="glove", pitch_m=0.008, row_pitch_m=0.010)
    recovery = given.recovery()
    found = given.regions(recovery)
    assert found is not None
    geometry = recovery.geometry
    image = np.zeros((geometry.rows, geometry.cols), dtype=np.float32)
    image[5, 29] = 400
    (region,) = (region for region in found.step(0.0, image) if region.in_contact)
    assert region.name == "little"
    assert region.centre_m == pytest.approx((float(geometry.x_m(29)), float(geometry.y_m(5)), 0.0))
    assert region.area_m2 == pytest.approx(geometry.taxel_area_m2)


IMAGES = stn.arrays(
    np.float32,
    (HAND.rows, HAND.cols),
    elements=st.sampled_from([0.0, 1.0, 60.0, 60.1, 1023.0]) | st.floats(0.0, float(np.float32(3e38)), width=32),
    fill=st.sampled_from([0.0, 1023.0]),
)


@settings(max_examples=20, deadline=None)
@given(st.lists(IMAGES, min_size=2, max_size=3))
def test_of_any_images_every_number_is_one(images: list[NDArray[np.float32]]) -> None:
    regions = Regions(HAND, RESPONSE, slip_rate_hz=0.0)
    for k, image in enumerate(images):
        for region, patch in zip(regions.step(0.1 * k, image), HAND.patches, strict=True):
            numbers = [*region[2:4], *region.centre_m, *region.normal, *region[6:10], *region.motion_m_s, region.slip_m]
            assert all(math.isfinite(number) for number in numbers)
            assert region.active_taxels == int((patch.of(image) > 60).sum())
            if not region.in_contact:
                assert region == RegionContact(patch.name, patch.link)
            else:
                assert 0 < region.peak_n <= region.force_n * (1 + 1e-9)
                assert np.linalg.norm(region.normal) == pytest.approx(1.0)
                low, high = (reach(patch.points_m(), axis=(0, 1)) for reach in (np.min, np.max))
                assert (low - 1e-9 <= region.centre_m).all()
                assert (region.centre_m <= high + 1e-9).all()


@pytest.mark.parametrize("index", [0, 3, 7, 12])
def test_motion_is_told_in_the_frame_of_the_link(index: int) -> None:
    patch = HAND.patches[index]
    regions = Regions(HAND, RESPONSE)
    speed_m_s, angle = 0.01, 0.6
    told = None
    for k in range(150):
        moved_m = max(k - 80, 0) * 1e-3 * speed_m_s
        row = (patch.rows - 1) / 2 - moved_m * math.sin(angle) / patch.row_pitch_m
        col = (patch.cols - 1) / 2 + moved_m * math.cos(angle) / patch.pitch_m
        told = regions.step(k * 1e-3, press(patch, row, col))[index]
        assert told.slipping <= (k > 80)
    assert told is not None
    assert told.slipping
    expected = speed_m_s * patch.rotation @ (math.cos(angle), math.sin(angle), 0.0)
    assert told.motion_m_s == pytest.approx(tuple(expected), abs=0.15 * speed_m_s)
    # Within the window, 50 ms and what is between two looks for slip.
    assert told.slip_m == pytest.approx(0.052 * speed_m_s, rel=0.15)
    others = [region for k, region in enumerate(regions.step(0.2, press(patch, 3, 3))) if k != index]
    assert not any(region.slipping or region.in_contact for region in others)


def test_patches_too_small_for_motion_have_their_contact_all_the_same() -> None:
    strip = SkinPatch("strip", 0, 1, 0, 8, "link", 0.003, 0.003)
    skin = Layout(
        "strip",
        np.arange(8, dtype=np.uint16).reshape(1, 8),
        np.arange(8, dtype=np.uint16),
        1,
        8,
        0.003,
        0.003,
        (strip,),
        np.zeros((1, 8), dtype=np.uint8),
    )
    image = np.array([[0, 0, 300, 300, 0, 0, 0, 0]], dtype=np.float32)
    (region,) = Regions(skin, RESPONSE).step(0.0, image)
    assert region.centre_m == pytest.approx((-0.003, 0.0, 0.0))
    assert region.active_taxels == 2


def test_a_patch_of_which_all_taxels_are_dead_is_left_out() -> None:
    names = [patch.name for patch in HAND.patches]
    for gone in (["index_distal", "palm"], names):
        in_picture = np.zeros((HAND.rows, HAND.cols), dtype=np.bool_)
        for patch in HAND.patches:
            patch.of(in_picture)[:] = patch.name in gone
        # One dead row leaves its patch in.
        thumb = next(patch for patch in HAND.patches if patch.name == "thumb_distal")
        thumb.of(in_picture)[3] = True
        in_matrix = np.asarray(HAND.matrix(in_picture), dtype=np.bool_)
        dead = DeadTaxels(in_matrix, ArrayGeometry(HAND.rows, HAND.cols), HAND)
        regions = Regions(HAND, RESPONSE, dead=dead, slip_rate_hz=0.0).step(0.0, press(thumb, 4.0, 4.0))
        assert [region.name for region in regions] == [name for name in names if name not in gone]
        assert [region.name for region in regions if region.in_contact] == ["thumb_distal"][: len(regions)]


def test_images_of_another_kind_are_refused() -> None:
    for wrong in (np.zeros((8, 8), np.float32), np.zeros((32, 32))):
        with pytest.raises(ArrayError, match=r"needed is \(32, 32\), float32"):
            hand_regions().step(0.0, wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize(("time_s", "count"), [(np.nan, 0.0), (np.inf, 0.0), (0.06, np.nan), (0.06, np.inf)])
def test_times_and_images_that_are_not_finite_are_refused_and_leave_no_trace(time_s: float, count: float) -> None:
    regions, undisturbed = (Regions(HAND, RESPONSE, slip_rate_hz=0.0) for _ in range(2))
    patch = HAND.patches[0]
    for number in range(90):
        image = press(patch, 1.5, 1.2 + 0.02 * number)
        if number == 60:
            wrong = image.copy()
            wrong[0, 0] += np.float32(count)
            with pytest.raises(ArrayError, match="needed are finite"):
                regions.step(time_s, wrong)
            for values, age_s in ((wrong, np.zeros_like(image)), (image, np.full_like(image, count))):
                if np.isnan(count):
                    with pytest.raises(ArrayError, match="needed"):
                        regions.step(time_s, image, values, age_s)
        assert list(regions.step(1e-3 * number, image)) == list(undisturbed.step(1e-3 * number, image))
