# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""SRC: the reference implementation on frames whose object is known, the kernel against it."""

import numpy as np
import pytest
from classification_reference import classify
from numpy.typing import NDArray
from recon_samples import bump, sample

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_recon.objects import Classification, Classifier, ClassifierConfig, ObjectLibrary, build_object_library

Frame = NDArray[np.uint16]
PLACES = {"corner": (6, 6), "middle": (16, 15), "edge": (28, 16)}


@pytest.fixture(scope="module")
def objects() -> ObjectLibrary:
    """Three places pressed wide and narrow: two columns each."""
    frames, labels = [], []
    for name, place in PLACES.items():
        for width in (2.0, 4.0):
            frames.append(bump(ArrayGeometry(), *place, width=width))
            labels.append(name)
    return build_object_library(frames, labels)


@pytest.mark.parametrize("max_columns", [0, 2])
@pytest.mark.parametrize("name", PLACES)
def test_a_press_between_the_known_ones_is_told_apart(objects: ObjectLibrary, name: str, max_columns: int) -> None:
    config = ClassifierConfig(max_columns=max_columns)
    frame = bump(ArrayGeometry(), *PLACES[name], width=3.0, peak=400)
    result = classify(objects, *sample(frame, 128), config)
    assert result.touched
    assert objects.names[result.best] == name
    assert result.residuals[result.best] < 0.2
    assert result.confidence > 0.7


def test_a_known_frame_leaves_nothing(objects: ObjectLibrary) -> None:
    everything = np.arange(1024, dtype=np.uint16)
    frame = bump(ArrayGeometry(), *PLACES["edge"], width=4.0).ravel()
    result = classify(objects, everything, frame, ClassifierConfig(max_columns=1))
    assert objects.names[result.best] == "edge"
    assert result.residuals[result.best] == pytest.approx(0, abs=1e-3)
    others = np.delete(result.residuals, result.best)
    assert np.array_equal(others, np.ones(2))  # none of their columns was chosen


def test_without_touch_there_is_no_object(objects: ObjectLibrary) -> None:
    indices = np.arange(50, dtype=np.uint16)
    for result in (
        classify(objects, indices, np.full(50, 60, np.uint16), ClassifierConfig()),
        Classifier(objects).step(indices, np.full(50, 60, np.uint16)),
    ):
        assert (result.touched, result.best, result.confidence) == (False, 0, 0.0)
        assert np.array_equal(result.residuals, np.ones(3))


def assert_alike(result: Classification, expected: Classification) -> None:
    np.testing.assert_allclose(result.residuals, expected.residuals, atol=1e-3)
    assert result.touched == expected.touched
    assert result.confidence == pytest.approx(expected.confidence, abs=2e-3)
    assert result.best == expected.best or expected.confidence < 2e-3


@pytest.mark.parametrize("max_columns", [0, 2])
def test_kernel_equals_reference_on_random_data(max_columns: int) -> None:
    rng = np.random.default_rng(max_columns)
    frames = rng.integers(61, 1024, (150, 12, 11))
    library = build_object_library(frames, [f"object {i % 9}" for i in range(150)])
    config = ClassifierConfig(max_columns=max_columns, touch_counts=300)
    classifier = Classifier(library, config)
    for m in (1, 2, 7, 40, 132):
        indices = rng.permutation(132)[:m].astype(np.uint16)
        counts = rng.integers(0, 1024, m).astype(np.uint16)
        assert_alike(classifier.step(indices, counts), classify(library, indices, counts, config))


def test_kernel_equals_reference_on_real_grasps(grasp_frames: Frame) -> None:
    library = build_object_library(grasp_frames, [f"object {i % 10}" for i in range(len(grasp_frames))])
    config = ClassifierConfig(max_columns=8)
    classifier = Classifier(library, config)
    for frame in grasp_frames:
        frame = np.roll(frame, 1, axis=1)  # none of the known ones
        assert_alike(classifier.step(*sample(frame, 55)), classify(library, *sample(frame, 55), config))


def test_impossible_frames_are_refused(objects: ObjectLibrary) -> None:
    classifier = Classifier(objects)
    good = np.array([1, 2], dtype=np.uint16)
    for indices, counts, word in (
        (good, good[:1], "2 indices and 1 counts"),
        (good[:0], good[:0], "0 indices and 0 counts"),
        (good.astype(np.int64), good, "int64"),
        (good[None], good, "shape|two rows"),
        (np.array([1, 1024], dtype=np.uint16), good, "index 1024: an array of 32 x 32 has 0 to 1023"),
        (np.zeros(1025, dtype=np.uint16), np.zeros(1025, dtype=np.uint16), "1 to 1024"),
    ):
        with pytest.raises(ArrayError, match=word):
            classifier.step(indices, counts)  # type: ignore[arg-type]


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(SettingsError, match="max_columns = -1"):
        ClassifierConfig(max_columns=-1)
