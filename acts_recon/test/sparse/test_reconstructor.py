# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from contact_reference import find_contact
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from recon_samples import bump, sample

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.skin import ForceResponse
from acts_recon.contacts import Contact
from acts_recon.contacts.contact import NO_CONTACT
from acts_recon.methods import PerFrame, PerFrameConfig, Recovery, SkinSetup
from acts_recon.sparse import Dictionary, Reconstructor, ReconstructorConfig


@pytest.fixture(scope="module")
def reconstructor(dictionary: Dictionary) -> Reconstructor:
    return Reconstructor(ArrayGeometry(), dictionary)


def contact_in(reconstructor: Reconstructor) -> Contact:
    return find_contact(reconstructor.image, reconstructor.geometry, ForceResponse())


def row(*values: int) -> NDArray[np.uint16]:
    return np.array(values, dtype=np.uint16)


def test_a_round_contact_is_recovered_from_55_samples(reconstructor: Reconstructor) -> None:
    frame = bump(ArrayGeometry(), 16.3, 15.6)
    reconstructor.recover(*sample(frame, 55))
    contact = contact_in(reconstructor)
    truth = np.where(frame > 60, frame, 0)
    assert np.linalg.norm(reconstructor.image - truth) < 0.1 * np.linalg.norm(truth)
    assert contact.x_m == pytest.approx(float(ArrayGeometry().x_m(15.6)), abs=2e-4)
    assert contact.y_m == pytest.approx(float(ArrayGeometry().y_m(16.3)), abs=2e-4)


def test_the_contact_is_that_of_the_image(dictionary: Dictionary) -> None:
    skin = SkinSetup(ArrayGeometry())
    recovery = Recovery(PerFrame(skin, PerFrameConfig(), dictionary), skin)
    contact = recovery.step(*sample(bump(ArrayGeometry(), 8, 20, width=3), 200), 0.0, 0.001)
    expected = find_contact(recovery.image, ArrayGeometry(), ForceResponse())
    assert contact.active_taxels == expected.active_taxels
    for name in ("x_m", "y_m", "force_n", "peak_counts", "area_m2", "spread_m"):
        assert getattr(contact, name) == pytest.approx(getattr(expected, name), rel=1e-5, abs=1e-7)


def test_no_contact_after_a_contact(reconstructor: Reconstructor) -> None:
    reconstructor.recover(row(500), row(900))
    assert reconstructor.image.any()
    reconstructor.recover(row(500), row(10))
    assert contact_in(reconstructor) == NO_CONTACT
    assert not reconstructor.image.any()


@pytest.mark.parametrize(
    ("indices", "counts", "word"),
    [
        (row(), row(), "0 indices and 0 counts"),
        (row(1, 2), row(1), "2 indices and 1 counts"),
        (row(1, 1024), row(1, 2), "index 1024: an array of 32 x 32 has 0 to 1023"),
        (row(1, 65535), row(1, 2), "index 65535"),
        (row(1, 2), row(1, 1024), "count 1024"),
        (row(5, 7, 5), row(1, 2, 3), "index 5 occurs twice"),
        (np.array([1, 2]), row(1, 2), "int64"),
        (row(1, 2)[None], row(1, 2), r"shape \(1, 2\)"),
    ],
)
def test_a_bad_frame_is_refused_and_changes_nothing(
    reconstructor: Reconstructor, indices: NDArray, counts: NDArray, word: str
) -> None:
    frame = sample(bump(ArrayGeometry(), 10, 10), 55)
    image = reconstructor.recover(*frame).copy()
    with pytest.raises(ArrayError, match=word):
        reconstructor.recover(indices, counts)
    assert np.array_equal(reconstructor.image, image)
    reconstructor.recover(*frame)
    assert np.array_equal(reconstructor.image, image)


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_frame_gives_finite_numbers(reconstructor: Reconstructor, data: st.DataObject) -> None:
    indices = data.draw(st.lists(st.integers(0, 1023), min_size=1, max_size=80, unique=True))
    extremes = st.sampled_from([0, 60, 61, 1023]) | st.integers(0, 1023)
    counts = data.draw(st.lists(extremes, min_size=len(indices), max_size=len(indices)))
    reconstructor.recover(row(*indices), row(*counts))
    contact = contact_in(reconstructor)
    assert np.isfinite(reconstructor.image).all()
    assert 0 <= reconstructor.image.min() <= reconstructor.image.max() <= 1023
    assert contact.in_contact == any(count > 60 for count in counts)
    assert np.isfinite([contact.x_m, contact.y_m, contact.force_n, contact.area_m2, contact.spread_m]).all()


@pytest.mark.parametrize(("rows", "cols"), [(33, 15), (8, 8), (64, 16)])
def test_other_arrays(dictionary: Dictionary, rows: int, cols: int) -> None:
    geometry = ArrayGeometry(rows, cols, 0.004)
    reconstructor = Reconstructor(geometry, dictionary)
    frame = bump(geometry, rows - 2, cols - 2)
    reconstructor.recover(*sample(frame, frame.size))
    contact = contact_in(reconstructor)
    assert np.array_equal(reconstructor.image, np.where(frame > 60, frame, 0))
    # Cut off by the edge, so inside of the middle of the bump.
    assert geometry.x_m(cols - 4) < contact.x_m < geometry.x_m(cols - 2)
    assert geometry.y_m(rows - 2) < contact.y_m < geometry.y_m(rows - 4)


def test_measured_taxels_may_be_smoothed(dictionary: Dictionary) -> None:
    reconstructor = Reconstructor(ArrayGeometry(), dictionary, ReconstructorConfig(keep_measured=False))
    indices, counts = sample(bump(ArrayGeometry(), 16, 16), 55)
    reconstructor.recover(indices, counts)
    assert not np.array_equal(reconstructor.image.ravel()[indices], np.where(counts > 60, counts, 0))


def test_a_dictionary_that_does_not_fit_and_wrong_settings_are_refused(dictionary: Dictionary) -> None:
    with pytest.raises(ArrayError, match="8 x 8 taxels do not fit a side of 7"):
        Reconstructor(ArrayGeometry(7, 40), dictionary)
    with pytest.raises(ArrayError, match="patch step 9"):
        Reconstructor(ArrayGeometry(), dictionary, ReconstructorConfig(patch_step=9))
    with pytest.raises(SettingsError, match="touch_counts = 2000"):
        ReconstructorConfig(touch_counts=2000)
