# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Classification of images: the reference implementation on known images, the kernel against it."""

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from classification_reference import classify_image, proposed_columns, src_residuals
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.skin import ForceResponse
from acts_core.wire import confidence_of
from acts_recon.objects import ImageClassifier, ImageClassifierConfig, ObjectLibrary, build_object_library
from acts_recon.objects.classification_kernels import decide
from acts_recon.objects.image_classification import LEVELS, shallower_patterns

pytestmark = pytest.mark.slow

Image = NDArray[np.float32]
GEOMETRY = ArrayGeometry()
CERTAIN = np.zeros((32, 32), dtype=np.float32)


@pytest.fixture(scope="module")
def objects() -> ObjectLibrary:
    """Three widths at one place, two presses of each."""
    frames, labels = [], []
    for name, width in (("narrow", 2.0), ("middle", 3.5), ("wide", 6.0)):
        for col in (15.7, 16.3):
            frames.append(bump(GEOMETRY, 15, col, width=width, peak=700))
            labels.append(name)
    return build_object_library(frames, labels, touch_counts=15)


def image_of(width: float, peak: float = 700.0) -> Image:
    return bump(GEOMETRY, 15, 16, width=width, peak=peak).astype(np.float32)


@pytest.mark.parametrize(("name", "width"), [("narrow", 2.0), ("middle", 3.5), ("wide", 6.0)])
def test_a_press_between_the_known_ones_is_told(objects: ObjectLibrary, name: str, width: float) -> None:
    for result in (
        classify_image(objects, image_of(width), CERTAIN),
        ImageClassifier(objects).step(image_of(width), CERTAIN, CERTAIN, 0.001),
    ):
        assert result.touched
        assert objects.names[result.best] == name
        assert result.residuals[result.best] < 0.1
        assert result.confidence > 0.5


def test_a_library_knows_its_objects_less_deep(objects: ObjectLibrary) -> None:
    patterns, norms_counts, classes = shallower_patterns(objects)
    response = ForceResponse()
    forces_n = response.force_n(objects.columns[:, 0] * objects.norms_counts[0])
    expected = response.counts(np.maximum(forces_n - 0.4 * forces_n.max(), 0))
    np.testing.assert_allclose(patterns[2] * norms_counts[2], expected, atol=0.01)
    np.testing.assert_allclose(patterns[0], objects.columns[:, 0], rtol=1e-5)
    assert classes.tolist() == np.repeat(objects.classes, len(patterns) // objects.n_columns).tolist()
    light = expected.reshape(32, 32).astype(np.float32)
    assert classify_image(objects, light, CERTAIN).best == objects.classes[0]


def test_what_is_uncertain_does_not_count(objects: ObjectLibrary) -> None:
    image = image_of(6.0)
    sigma = CERTAIN.copy()
    image[:, :15] = 0
    sigma[:, :15] = 500
    assert objects.names[classify_image(objects, image, sigma).best] == "wide"
    assert classify_image(objects, image, sigma).residuals.min() < 0.1
    assert classify_image(objects, image, CERTAIN).residuals.min() > 0.3


@pytest.mark.parametrize("unknown", [0.0, 0.3])
@pytest.mark.parametrize("n_classes", [1, 3, 9, 20])
def test_kernel_equals_reference_on_random_images(n_classes: int, unknown: float) -> None:
    rng = np.random.default_rng(n_classes)
    frames = rng.integers(0, 1024, (60, 12, 11)) * (rng.random((60, 12, 11)) < 0.4)
    library = build_object_library(frames, [f"object {i % n_classes}" for i in range(60)], touch_counts=15)
    config = ImageClassifierConfig(memory_s=0.0)
    classifier = ImageClassifier(library, config)
    for number in range(10):
        image = (frames[number] * rng.random() + 60 * rng.random((12, 11))).astype(np.float32)
        sigma = (50 * rng.random((12, 11)) + 300 * (rng.random((12, 11)) < unknown)).astype(np.float32)
        expected = classify_image(library, image, sigma, config)
        classifier.reset()
        # Nothing was measured in this frame, so nothing is known to change.
        result = classifier.step(image, sigma, np.full_like(sigma, 0.5), 0.001)
        np.testing.assert_allclose(result.residuals, expected.residuals, atol=5e-3)
        assert result.best == expected.best or expected.confidence < 0.01
        assert result.confidence == pytest.approx(expected.confidence, abs=0.01)
        assert result.confidence == pytest.approx(confidence_of(result.residuals), abs=1e-6)


def test_the_response_of_the_skin_tells_how_objects_look_less_deep(objects: ObjectLibrary) -> None:
    response = ForceResponse(full_scale_counts=1000.0, dead_n=0.02, half_n=1.0)
    forces_n = response.force_n(objects.columns[:, 5] * objects.norms_counts[5])
    light = response.counts(np.maximum(forces_n - 0.5 * forces_n.max(), 0)).reshape(32, 32).astype(np.float32)
    config = ImageClassifierConfig(memory_s=0.0)
    expected = classify_image(objects, light, CERTAIN, config, response)
    result = ImageClassifier(objects, config, response).step(light, CERTAIN, np.full_like(light, 0.5), 0.001)
    np.testing.assert_allclose(result.residuals, expected.residuals, atol=5e-3)
    assert not np.allclose(result.residuals, classify_image(objects, light, CERTAIN, config).residuals, atol=5e-3)


def test_faint_frames_of_which_nothing_is_left_less_deep_do_no_harm() -> None:
    faint = [bump(GEOMETRY, 15, 10, width=2.0, peak=70), bump(GEOMETRY, 15, 20, width=2.0, peak=70)]
    library = build_object_library(faint, ["left", "right"], touch_counts=15)
    patterns, norms_counts, _ = shallower_patterns(library)
    assert np.isfinite(patterns).all()
    assert (norms_counts > 0).all()
    assert not patterns[len(LEVELS) - 1].any()
    image = faint[1].astype(np.float32)
    for result in (
        classify_image(library, image, CERTAIN),
        ImageClassifier(library).step(image, CERTAIN, np.full_like(image, 0.5), 0.001),
    ):
        assert library.names[result.best] == "right"
        assert np.isfinite(result.residuals).all()


def test_a_library_of_one_object_always_finds_it() -> None:
    library = build_object_library([bump(GEOMETRY, 15, 16, width=4.0)], ["only"])
    result = ImageClassifier(library).step(image_of(4.0), CERTAIN, np.full_like(CERTAIN, 0.5), 0.001)
    assert (result.touched, result.best, result.confidence) == (True, 0, 0.0)
    assert result.residuals[0] < 0.2


def test_frames_are_classified_without_allocating(objects: ObjectLibrary) -> None:
    classifier = ImageClassifier(objects)
    image, old = image_of(3.0), np.full_like(CERTAIN, 0.5)
    peaks = []
    for _ in range(40):
        tracemalloc.start()
        try:
            for _ in range(50):
                classifier.step(image, CERTAIN, old, 0.001)
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    # Views and numbers; a single copy of the image would be 4096 bytes. At first, and whenever CPython has emptied its
    # cache of attributes, the names that numba looks up are kept there, too.
    assert sorted(peaks)[len(peaks) // 2] < 3500


@given(st.lists(st.floats(0, 2, width=32), min_size=1, max_size=40))
def test_decision_and_confidence_are_those_of_the_residuals(values: list[float]) -> None:
    residuals = np.array(values, dtype=np.float32)
    best, confidence = decide(residuals)
    assert best == np.argmin(residuals)
    assert confidence == pytest.approx(confidence_of(residuals), abs=1e-6)


def test_frames_before_count_on_and_fade(objects: ObjectLibrary) -> None:
    classifier = ImageClassifier(objects, ImageClassifierConfig(memory_s=0.01, src_weight=0.0))
    old = np.full_like(CERTAIN, 0.5)
    for _ in range(5):
        classifier.step(image_of(6.0), CERTAIN, old, 0.001)
    assert objects.names[classifier.step(image_of(3.5), CERTAIN, old, 0.001).best] == "wide"
    assert objects.names[classifier.step(image_of(3.5), CERTAIN, old, 0.1).best] == "middle"


def test_without_touch_there_is_no_object(objects: ObjectLibrary) -> None:
    faint = np.full((32, 32), 15, dtype=np.float32)
    for result in (
        classify_image(objects, faint, CERTAIN),
        ImageClassifier(objects).step(faint, CERTAIN, CERTAIN, 0.001),
    ):
        assert (result.touched, result.best, result.confidence) == (False, 0, 0.0)
        assert np.array_equal(result.residuals, np.ones(3))


def test_impossible_images_are_refused(objects: ObjectLibrary) -> None:
    classifier = ImageClassifier(objects)
    cases: tuple[tuple[NDArray[Any], NDArray[Any], str], ...] = (
        (CERTAIN[:16], CERTAIN, "image .16, 32., float32: needed is a C-contiguous float32 array of 32 x 32"),
        (CERTAIN, CERTAIN.astype(np.float64), "sigma .32, 32., float64"),
        (CERTAIN.T[::-1], CERTAIN, "image"),
    )
    for image, sigma, word in cases:
        with pytest.raises(ArrayError, match=word):
            classifier.step(image, sigma, CERTAIN, 0.001)
    for field, value in ((0, np.nan), (0, np.inf), (1, np.nan), (1, np.inf), (1, -1.0), (2, np.nan), (2, -1.0)):
        fields = [image_of(3.0), CERTAIN.copy(), CERTAIN.copy()]
        fields[field][3, 4] = value
        with pytest.raises(ArrayError, match="NaN, infinite counts or sigma, or negative sigma or age_s"):
            classifier.step(fields[0], fields[1], fields[2], 0.001)
    for period_s in (-0.001, math.nan, math.inf):
        with pytest.raises(ArrayError, match="needed is a finite time"):
            classifier.step(CERTAIN, CERTAIN, CERTAIN, period_s)
    # None of them left a trace.
    fresh = ImageClassifier(objects).step(image_of(3.0), CERTAIN, CERTAIN, 0.001)
    np.testing.assert_array_equal(classifier.step(image_of(3.0), CERTAIN, CERTAIN, 0.001).residuals, fresh.residuals)
    with pytest.raises(SettingsError, match="memory_s = -1"):
        ImageClassifierConfig(memory_s=-1.0)


def test_src_has_its_say_once_the_skin_rests(objects: ObjectLibrary) -> None:
    config, without = ImageClassifierConfig(memory_s=0.0), ImageClassifierConfig(memory_s=0.0, src_weight=0.0)
    classifier, plain = ImageClassifier(objects, config), ImageClassifier(objects, without)
    image = image_of(3.0)
    fresh, old = CERTAIN, np.full_like(CERTAIN, 0.5)
    # Everything has changed within a millisecond: SRC is not asked.
    classifier.step(CERTAIN, CERTAIN, fresh, 0.001)
    plain.step(CERTAIN, CERTAIN, fresh, 0.001)
    rising = classifier.step(image, CERTAIN, fresh, 0.001).residuals.copy()
    np.testing.assert_array_equal(rising, plain.step(image, CERTAIN, fresh, 0.001).residuals)
    for _ in range(40):
        resting = classifier.step(image, CERTAIN, old, 0.001).residuals
        alone = plain.step(image, CERTAIN, old, 0.001).residuals
    flat = image.ravel()
    proposed = proposed_columns(objects, alone, np.ones(objects.n_columns))
    src = src_residuals(objects, proposed, np.where(flat > config.touch_counts, flat, 0), CERTAIN.ravel())
    assert src is not None
    np.testing.assert_allclose(resting, (alone * src**2) ** (1 / 3), rtol=1e-3)
