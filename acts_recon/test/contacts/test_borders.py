# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Borders of patches: no contact, no patch of the recovery and no number of a contact goes over one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from blob_track_reference import BlobTrackerReference
from contact_reference import find_contact
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy
from numpy.typing import NDArray
from recon_samples import layouts

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import NO_PATCH, ForceResponse, Layout, MeasuredForceResponse, force_table, layout
from acts_recon.contacts import BlobConfig, BlobTracker, ContactFinder
from acts_recon.fusion import FusionEstimator
from acts_recon.images import borders_of
from acts_recon.sparse import Dictionary, Reconstructor, patch_layout

GEOMETRY = ArrayGeometry(12, 9)
TABLE = force_table(ForceResponse())
BY_TABLE = MeasuredForceResponse(TABLE[:-1], np.arange(1024.0))
GLOVE = layout("glove")


def on_the_glove(*presses: tuple[int, int]) -> NDArray[np.float32]:
    image = np.zeros((32, 32), dtype=np.float32)
    for place in presses:
        image[place] = 500
    return image


@given(layouts(12, 9))
def test_rectangles_are_the_patches_and_every_taxel_without_skin(arranged: Layout | None) -> None:
    borders = borders_of(12, 9, arranged)
    bounds = borders.bounds().reshape(12, 9, 4)
    for row, col in np.ndindex(12, 9):
        first_row, end_row, first_col, end_col = bounds[row, col]
        assert first_row <= row < end_row
        assert first_col <= col < end_col
        if arranged is None:
            assert (end_row, end_col) == (12, 9)
        elif arranged.patch_of[row, col] == NO_PATCH:
            assert (end_row - first_row, end_col - first_col) == (1, 1)
        else:
            patch = arranged.patch(row, col)
            assert [first_row, end_row, first_col, end_col] == [
                patch.first_row,
                patch.end_row,
                patch.first_col,
                patch.end_col,
            ]


def test_contacts_of_a_picture_are_numbered_from_one_rectangle_to_the_next() -> None:
    first = GLOVE.patches[0].bounds
    pressed = np.zeros((32, 32), dtype=np.bool_)
    pressed[first[0], first[2]] = pressed[first[0] + 1, first[2] + 1] = True
    pressed[first[1] - 1, first[2]] = True
    for patch in GLOVE.patches[1:]:
        pressed[patch.bounds[0] : patch.bounds[1], patch.bounds[2] : patch.bounds[3]] = True
    labels, number = borders_of(32, 32, GLOVE).labelled(pressed)
    assert number == len(GLOVE.patches) + 1
    np.testing.assert_array_equal(labels > 0, pressed)
    assert labels[first[0], first[2]] == labels[first[0] + 1, first[2] + 1] == 1
    assert labels[first[1] - 1, first[2]] == 2
    for label, patch in enumerate(GLOVE.patches[1:], 3):
        assert (labels[patch.bounds[0] : patch.bounds[1], patch.bounds[2] : patch.bounds[3]] == label).all()


@settings(deadline=None)
@given(
    layouts(12, 9),
    st_numpy.arrays(np.float32, (12, 9), elements=st.floats(0, 1023, width=32), fill=st.just(0.0)),
    st_numpy.arrays(np.float32, (12, 9), elements=st.floats(0, 50, width=32)),
)
def test_the_contact_in_the_image_is_as_unsure_as_its_twin(
    arranged: Layout | None, image: NDArray[np.float32], sigma: NDArray[np.float32]
) -> None:
    borders = borders_of(12, 9, arranged)
    found = ContactFinder(GEOMETRY, BY_TABLE, 60.0, borders=borders).find(image.ravel(), sigma.ravel())
    expected = find_contact(image, GEOMETRY, BY_TABLE, sigma=sigma, borders=borders)
    for name in ("x_sd_m", "y_sd_m", "force_sd_n", "area_sd_m2"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-4, abs=1e-9)


@settings(max_examples=12, deadline=None)
@given(layouts(12, 9), st.integers(0, 2**32 - 1))
def test_contacts_are_followed_as_by_the_twin(arranged: Layout | None, seed: int) -> None:
    borders, config, rng = borders_of(12, 9, arranged), BlobConfig(), np.random.default_rng(seed)
    tracker = BlobTracker(GEOMETRY, BY_TABLE, config, borders)
    reference = BlobTrackerReference(GEOMETRY, BY_TABLE, config, borders)
    row, col = np.indices((12, 9))
    place = rng.uniform((0, 0), (12, 9), (2, 2))
    for frame in range(12):
        place += rng.normal(0, 0.8, (2, 2))
        image = sum(600 * np.exp(-((row - r) ** 2 + (col - c) ** 2) / 3) for r, c in place)
        image = np.asarray(image, dtype=np.float32)
        if arranged is not None:
            image[arranged.patch_of == NO_PATCH] = 0
        found = tracker.step(image, 0.002 * frame)
        expected = reference.step(image, 0.002 * frame, 0.002 if frame else 0.0)
        assert [(blob.number, blob.active_taxels) for blob in found] == [
            (blob.number, blob.active_taxels) for blob in expected
        ]


def test_fingers_side_by_side_are_two_contacts_with_numbers_of_their_own() -> None:
    borders = borders_of(32, 32, GLOVE)
    tracker = BlobTracker(GLOVE.geometry(), borders=borders)
    index_and_middle = on_the_glove((5, 7), (5, 8))
    assert len(tracker.step(index_and_middle, 0.0)) == 2
    assert len(BlobTracker(GLOVE.geometry()).step(index_and_middle, 0.0)) == 1
    tracker.step(np.zeros((32, 32), dtype=np.float32), 1.0)
    (index,) = tracker.step(on_the_glove((5, 7)), 1.1)
    (middle,) = tracker.step(on_the_glove((5, 8)), 1.101)
    assert middle.number != index.number
    (back,) = tracker.step(on_the_glove((5, 6)), 1.102)
    assert back.number == index.number


@pytest.mark.parametrize("name", ["glove", "leap_right", "insole"])
def test_no_patch_of_the_recovery_reaches_over_a_border(name: str) -> None:
    shape = layout(name)
    borders = borders_of(shape.rows, shape.cols, shape)
    patches = patch_layout(shape.rows, shape.cols, borders=borders)
    of = borders.rectangle_of[patches.taxels]
    assert (of == of[:, :1]).all()
    assert np.unique(of).size == len(shape.patches)
    assert np.array_equal(np.bincount(patches.taxels.ravel(), minlength=1024), patches.overlap)


def test_what_is_read_where_there_is_no_skin_counts_as_untouched(dictionary: Dictionary, tmp_path: Path) -> None:
    path = tmp_path / "half.yaml"
    path.write_text("picture: [32, 32]\npatches: {top: {wires: {down: rows 16 to 31, across: cols}}}\n")
    half = layout(str(path))
    indices, counts = np.arange(1024, dtype=np.uint16), np.full(1024, 700, dtype=np.uint16)
    fused, alone = (
        FusionEstimator(half.geometry(), layout=half),
        Reconstructor(half.geometry(), dictionary, layout=half),
    )
    fused.step(indices, counts, 1.0, 0.001)
    alone.recover(indices, counts)
    for image in (fused.image, alone.image):
        assert (image[:16] == 700).all()
        assert (image[16:] == 0).all()
    for step in (lambda: fused.step(indices, counts * 2, 1.1, 0.001), lambda: alone.recover(indices, counts * 2)):
        with pytest.raises(ArrayError, match="count 1400"):
            step()


def test_what_presses_a_finger_is_recovered_on_that_finger_alone(dictionary: Dictionary) -> None:
    recovery = Reconstructor(GLOVE.geometry(), dictionary, layout=GLOVE)
    row, col = np.indices((32, 32))
    picture = np.where(col < 8, 700 * np.exp(-((row - 6) ** 2 + (col - 7) ** 2) / 6), 0).astype(np.uint16)
    of_index = (GLOVE.patch_of == 2).ravel()[GLOVE.places]
    indices = np.flatnonzero(of_index)[::2].astype(np.uint16)
    recovery.recover(indices, GLOVE.matrix(picture).ravel()[indices].astype(np.uint16))
    assert recovery.image.max() > 60
    assert (recovery.image[GLOVE.patch_of != 2] == 0).all()
    whole = Reconstructor(GLOVE.geometry(), dictionary)
    whole.recover(GLOVE.places[indices], GLOVE.matrix(picture).ravel()[indices].astype(np.uint16))
    assert (whole.image[GLOVE.patch_of != 2] > 0).any()


def test_patches_too_small_for_the_dictionary_are_refused() -> None:
    with pytest.raises(ArrayError, match="patches of 20 x 20 taxels do not fit a side of 16"):
        patch_layout(32, 32, size=20, step=4, borders=borders_of(32, 32, GLOVE))
