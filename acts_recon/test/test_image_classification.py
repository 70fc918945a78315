"""Classification of images: the plain version on images whose object is known, the kernel against the plain version."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.force import ForceResponse
from acts_recon.classification import Classifier
from acts_recon.image_classification import (
    ImageClassifier,
    ImageClassifierConfig,
    classify_image,
    known_samples,
    less_deep,
    src_config,
)
from acts_recon.object_library import ObjectLibrary, build_object_library
from acts_recon.unrest import Unrest

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
    patterns, norms_counts, classes = less_deep(objects)
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


def test_kernel_equals_twin_on_random_images() -> None:
    rng = np.random.default_rng(0)
    frames = rng.integers(0, 1024, (60, 12, 11)) * (rng.random((60, 12, 11)) < 0.4)
    library = build_object_library(frames, [f"object {i % 9}" for i in range(60)], touch_counts=15)
    config = ImageClassifierConfig(memory_s=0.0)
    classifier = ImageClassifier(library, config)
    for number in range(20):
        image = (frames[number] * rng.random() + 60 * rng.random((12, 11))).astype(np.float32)
        sigma = (50 * rng.random((12, 11))).astype(np.float32)
        expected = classify_image(library, image, sigma, config)
        classifier.reset()
        # Nothing was measured in this frame, so nothing is known to change.
        result = classifier.step(image, sigma, np.full_like(sigma, 0.5), 0.001)
        np.testing.assert_allclose(result.residuals, expected.residuals, atol=5e-3)
        assert result.best == expected.best or expected.confidence < 0.01
        assert result.confidence == pytest.approx(expected.confidence, abs=0.01)


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


def test_old_values_are_doubted_while_others_change() -> None:
    unrest = Unrest(2, 2, touch_counts=15)
    age_s = np.array([[0.0, 0.05], [0.05, np.inf]], dtype=np.float32)
    quiet = unrest.step(np.zeros((2, 2), np.float32), age_s, 0.001)
    assert not quiet.any()
    image = np.array([[100, 0], [0, 0]], dtype=np.float32)
    doubt = unrest.step(image, np.array([[0.0, 0.051], [0.051, np.inf]], np.float32), 0.001)
    assert doubt[0, 0] == 0
    # 100 counts in 1 ms, of which a frame takes over a part.
    assert doubt[0, 1] == pytest.approx(0.4 * 100 / 0.001 * 0.051, rel=1e-3)
    assert doubt[1, 1] > 10 * doubt[0, 1]
    for _ in range(30):
        doubt = unrest.step(image, age_s, 0.001)
    assert doubt.max() < 1
    unrest.reset()
    assert unrest.rate_counts_per_s == 0


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
    src = Classifier(objects, src_config(config)).step(*known_samples(image, CERTAIN)).residuals
    np.testing.assert_allclose(resting, (alone * src**2) ** (1 / 3), rtol=1e-3)


def test_src_gets_only_what_is_known() -> None:
    image = np.array([[10.4, 2000.0], [-3.0, 500.0]], dtype=np.float32)
    indices, counts = known_samples(image, np.array([[0.0, 49.0], [1.0, np.inf]]))
    assert indices.tolist() == [0, 1, 2]
    assert counts.tolist() == [10, 1023, 0]
    assert indices.dtype == counts.dtype == np.uint16
