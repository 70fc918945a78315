# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects by the fused fields, without ROS: layouts, gaps, frames of which no answer is needed."""

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_core.skin import Layout, layout
from acts_recon.classifiers import FusedImageConfig, FusedImageRecogniser
from acts_recon.images import LONGEST_PAUSE_S
from acts_recon.methods import Method, SkinSetup
from acts_recon.objects import ImageClassifierConfig, ObjectLibrary, build_object_library

GEOMETRY = ArrayGeometry()
ONE = np.zeros(1, dtype=np.uint16)
Field = NDArray[np.float32]


@pytest.fixture(scope="module")
def library() -> ObjectLibrary:
    frames = [bump(GEOMETRY, 15, 16, width=width) for width in (2.0, 3.0, 4.5)]
    return build_object_library(frames, ["a", "b", "c"], touch_counts=15)


class Shown(Method):
    """A method that shows what the test puts there."""

    def __init__(self, image: Field, sigma: Field, age_s: Field) -> None:
        self.image, self.sigma, self.age_s = image, sigma, age_s

    def reset(self) -> None:
        raise AssertionError

    def step(self, indices: object, counts: object, end_s: float, duration_s: float) -> Field:
        raise AssertionError


def recogniser(
    library: ObjectLibrary,
    shown: tuple[Field, Field, Field],
    config: ImageClassifierConfig | None = None,
    arranged: Layout | None = None,
) -> FusedImageRecogniser:
    return FusedImageRecogniser(library, FusedImageConfig(), SkinSetup(GEOMETRY, arranged), Shown(*shown), config)


def fields() -> tuple[Field, Field, Field]:
    """Image, sigma and age of an untouched skin."""
    nothing = np.zeros((32, 32), dtype=np.float32)
    return nothing, nothing.copy(), np.full_like(nothing, 0.5)


def test_earlier_images_count_on_until_there_is_a_gap_or_the_clock_goes_back(library: ObjectLibrary) -> None:
    config = ImageClassifierConfig(memory_s=1.0, src_weight=0.0)
    image, sigma, age_s = fields()
    objects = recogniser(library, (image, sigma, age_s), config)
    image[:] = bump(GEOMETRY, 15, 16, width=4.5)
    alone = objects.step(ONE, ONE, 1.0, 0.001).residuals.copy()
    for end_s, forgets in ((1.001, False), (1.001 + 2 * LONGEST_PAUSE_S, True), (0.5, True), (0.501, False)):
        image[:] = bump(GEOMETRY, 15, 16, width=2.0)
        objects.step(ONE, ONE, end_s - 0.0005, 0.001) if not forgets else None
        image[:] = bump(GEOMETRY, 15, 16, width=4.5)
        residuals = objects.step(ONE, ONE, end_s, 0.001).residuals
        assert np.allclose(residuals, alone, atol=1e-5) == forgets


def test_a_frame_that_is_only_taken_tells_that_the_skin_moves(library: ObjectLibrary) -> None:
    results = []
    for moves in (False, True):
        image, sigma, age_s = fields()
        objects = recogniser(library, (image, sigma, age_s))
        age_s[:] = 0
        objects.update(ONE, ONE, 1.0, 0.001)
        image[:] = bump(GEOMETRY, 15, 16, width=2.5, peak=400)
        if moves:
            objects.update(ONE, ONE, 1.001, 0.001)
        age_s[:] = 0.002
        results.append(objects.step(ONE, ONE, 1.002, 0.001).residuals.copy())
    # SRC, which is only weighed in on a resting skin, sharpens the contrast.
    assert not np.allclose(results[0], results[1], atol=1e-2)


def test_the_picture_of_a_layout_is_turned_back_to_the_matrix() -> None:
    glove = layout("glove")
    picture = bump(glove.geometry(), 5.0, 20.0, width=3.0)
    frames = [np.asarray(glove.matrix(picture)), picture]
    library = build_object_library(frames, ["matrix", "picture"], touch_counts=15)
    image, sigma, age_s = fields()
    image[:] = picture
    turned = recogniser(library, (image, sigma, age_s), arranged=glove).step(ONE, ONE, 1.0, 0.001)
    assert library.names[turned.best] == "matrix"
    assert turned.residuals[turned.best] < 1e-2
    straight = recogniser(library, (image, sigma, age_s)).step(ONE, ONE, 1.0, 0.001)
    assert library.names[straight.best] == "picture"
