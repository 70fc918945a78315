# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recovery of skins whose matrix is not their picture."""

import numpy as np
import pytest
from contact_reference import find_contact
from recon_samples import bump, sample

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_core.sampling.basis import division_order
from acts_core.skin import ForceResponse, layout
from acts_recon.methods import PerFrame, PerFrameConfig, Recovery, SkinSetup
from acts_recon.sparse import Dictionary, Reconstructor


@pytest.mark.parametrize("name", ["insole", "glove"])
def test_the_samples_of_the_matrix_are_recovered_in_the_picture(dictionary: Dictionary, name: str) -> None:
    shape = layout(name)
    geometry = shape.geometry()
    # In the middle of the insole, of the glove's palm.
    row, col = (31.7, 9.2) if name == "insole" else (23.7, 20.2)
    picture = bump(geometry, row, col, width=2.0)
    indices = np.random.default_rng(3).permutation(1024)[:600].astype(np.uint16)
    counts = shape.matrix(picture).ravel()[indices].astype(np.uint16)

    arranged = Reconstructor(geometry, dictionary, layout=shape)
    arranged.recover(indices, counts)
    contact = find_contact(arranged.image, geometry, ForceResponse())
    if len(shape.patches) == 1:
        # The same as if the board had given places of the picture.
        plain = Reconstructor(geometry, dictionary)
        assert np.array_equal(arranged.image, plain.recover(shape.places[indices], counts))

    truth = np.where(picture > 60, picture, 0)
    assert np.linalg.norm(arranged.image - truth) < 0.2 * np.linalg.norm(truth)
    assert contact.x_m == pytest.approx(float(geometry.x_m(col)), abs=0.1 * geometry.pitch_m)
    assert contact.y_m == pytest.approx(float(geometry.y_m(row)), abs=0.1 * geometry.pitch_y_m)


def test_patches_over_the_matrix_would_not_do(dictionary: Dictionary) -> None:
    # A sole's round contact is torn apart in the matrix.
    shape = layout("insole")
    picture = bump(shape.geometry(), 20, 8, width=2.0)
    truth = np.where(picture > 60, picture, 0).astype(float)
    indices = np.random.default_rng(3).permutation(1024)[:300].astype(np.uint16)
    counts = shape.matrix(picture).ravel()[indices].astype(np.uint16)
    arranged = Reconstructor(shape.geometry(), dictionary, layout=shape)
    arranged.recover(indices, counts)
    torn = Reconstructor(ArrayGeometry(), dictionary)
    torn.recover(indices, counts)
    error = np.linalg.norm(arranged.image - truth)
    assert error < 0.5 * np.linalg.norm(shape.picture(torn.image) - truth)


def test_contacts_where_rows_and_columns_have_different_pitches(dictionary: Dictionary) -> None:
    geometry = layout("insole").geometry()
    assert geometry.pitch_m != geometry.pitch_y_m
    skin = SkinSetup(geometry)
    recovery = Recovery(PerFrame(skin, PerFrameConfig(), dictionary), skin)
    contact = recovery.step(*sample(bump(geometry, 30, 6, width=2.5), 1024), 0.0, 0.001)
    expected = find_contact(recovery.image, geometry, ForceResponse())
    for name in ("x_m", "y_m", "force_n", "peak_counts", "area_m2", "spread_m"):
        assert getattr(contact, name) == pytest.approx(getattr(expected, name), rel=1e-4, abs=1e-7)


@pytest.mark.parametrize(
    ("name", "scheme"),
    [("insole", "tracking"), ("insole", "hybrid"), ("glove", "adaptive"), ("glove", "tracking"), ("glove", "hybrid")],
)
def test_schemes_that_walk_the_matrix_find_a_contact_of_the_picture(
    dictionary: Dictionary, name: str, scheme: str
) -> None:
    shape = layout(name)
    geometry = shape.geometry()
    row, col = 20, 9
    picture = bump(geometry, row, col, width=2.0)
    sampler = Sampler(SamplingConfig(scheme, m=200, threshold_counts=60))
    reconstructor = Reconstructor(geometry, dictionary, layout=shape)
    for _ in range(30):
        reconstructor.recover(*sampler.frame(measure_in(shape.matrix(picture))))
    contact = find_contact(reconstructor.image, geometry, ForceResponse())
    assert contact.in_contact
    assert abs(contact.x_m - geometry.x_m(col)) < geometry.pitch_m
    assert abs(contact.y_m - geometry.y_m(row)) < geometry.pitch_y_m


def test_adaptive_sampling_walks_half_an_insole_before_the_other() -> None:
    # Two neighbouring wires make a column of the sole; the coarse search takes one of each two.
    order = division_order(32, 32)
    rows = layout("insole").places[order] // 16
    assert int(np.argmax(rows < 32)) == 255
    rows = layout("glove").places[order] // 16
    assert int(np.argmax(rows < 32)) < 10


def test_a_bad_frame_is_told_in_matrix_indices(dictionary: Dictionary) -> None:
    shape = layout("insole")
    reconstructor = Reconstructor(shape.geometry(), dictionary, layout=shape)
    counts = np.array([1, 2, 3], dtype=np.uint16)
    with pytest.raises(ArrayError, match="index 5 occurs twice"):
        reconstructor.recover(np.array([5, 7, 5], dtype=np.uint16), counts)
    for index in (1024, 65535):
        with pytest.raises(ArrayError, match=f"index {index}: an array of 32 x 32 has 0 to 1023"):
            reconstructor.recover(np.array([5, index, 6], dtype=np.uint16), counts)


def test_a_geometry_that_is_not_the_layouts_is_refused(dictionary: Dictionary) -> None:
    with pytest.raises(ArrayError, match="geometry of 32 x 32: the layout insole is 64 x 16"):
        Reconstructor(ArrayGeometry(), dictionary, layout=layout("insole"))
