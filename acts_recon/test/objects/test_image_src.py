# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""SRC among the classes that a comparison proposes: which columns are asked, and what they leave."""

import numpy as np
import pytest
from classification_reference import proposed_columns, src_residuals
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_recon.objects import ObjectLibrary, build_object_library, image_src_kernels
from acts_recon.objects.image_src_kernels import KNOWN_COUNTS, PROPOSED_CLASSES, PROPOSED_COLUMNS

pytestmark = pytest.mark.slow

GEOMETRY = ArrayGeometry()
CERTAIN = np.zeros(1024)


@pytest.fixture(scope="module")
def objects() -> ObjectLibrary:
    """Eight places, each pressed at 15 widths."""
    frames = [bump(GEOMETRY, 16, 2 + 4 * place, width=1.5 + 0.1 * k) for place in range(8) for k in range(15)]
    return build_object_library(frames, [f"place {place}" for place in range(8) for _ in range(15)])


def test_the_best_columns_of_the_best_classes_are_proposed(objects: ObjectLibrary) -> None:
    residuals = np.array([0.8, 0.1, 0.9, 0.3, 0.2, 0.7, 0.3, 0.95])
    explained = np.arange(120.0) % 15
    proposed = proposed_columns(objects, residuals, explained)
    assert sorted(set(objects.classes[proposed].tolist())) == [1, 3, 4, 5, 6]
    assert len(proposed) == len(set(proposed.tolist())) == PROPOSED_CLASSES * PROPOSED_COLUMNS
    assert explained[proposed].min() == 15 - PROPOSED_COLUMNS


def test_a_class_that_explains_the_image_leaves_nothing_of_it(objects: ObjectLibrary) -> None:
    first, second = np.flatnonzero(objects.classes == 2)[:2]
    image = 300.0 * objects.columns[:, first] + 500.0 * objects.columns[:, second]
    residuals = src_residuals(objects, np.array([first, second, 80]), image, CERTAIN)
    assert residuals is not None
    assert residuals[2] == pytest.approx(0, abs=1e-3)
    assert residuals[objects.classes[80]] == pytest.approx(1, abs=1e-2)
    # Not proposed.
    assert residuals[0] == 1


def test_what_is_not_known_is_no_sample(objects: ObjectLibrary) -> None:
    image, sigma = objects.columns[:, 0] * 1000.0, np.zeros(1024)
    image[500:] = 400.0
    sigma[500:] = KNOWN_COUNTS + 1
    image[:500] = objects.columns[:500, 0] * 1000
    residuals = src_residuals(objects, np.array([0, 40]), image, sigma)
    assert residuals is not None
    assert residuals[0] == pytest.approx(0, abs=1e-3)
    assert src_residuals(objects, np.array([0, 40]), image, np.full(1024, np.inf)) is None


@pytest.mark.parametrize("unknown", [0.0, 0.5, 0.95])
@pytest.mark.parametrize("n_classes", [1, 3, 30])
def test_kernel_equals_reference_on_random_images(n_classes: int, unknown: float) -> None:
    rng = np.random.default_rng(n_classes)
    frames = rng.integers(0, 1024, (90, 12, 11)) * (rng.random((90, 12, 11)) < 0.4)
    library = build_object_library(frames, [f"object {i % n_classes}" for i in range(90)], touch_counts=15)
    workspace = image_src_kernels.Workspace.empty(132, n_classes)
    for number in range(10):
        image = (frames[number].ravel() * rng.random() + 60 * rng.random(132)).astype(np.float32)
        sigma = (400 * (rng.random(132) < unknown)).astype(np.float32)
        compared = rng.random(n_classes).astype(np.float32)
        explained = rng.integers(0, 20, 90).astype(np.float32)
        found = image_src_kernels.class_residuals(
            image_src_kernels.Model.of(library), image, sigma, compared, explained, 15.0, workspace
        )
        pressed = np.where(image > 15, image, 0)
        expected = src_residuals(library, proposed_columns(library, compared, explained), pressed, sigma)
        assert found == (expected is not None)
        if expected is not None:
            np.testing.assert_allclose(workspace.residuals, expected, atol=1e-3)
