# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The core recovers and classifies as acts_recon does, to what single precision allows.

Both sum in single precision, in different orders. The bounds leave a factor of ten to the largest differences seen.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import recovery_library as core
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import measure_in
from acts_core.sampling.schemes.adaptive import adaptive
from acts_recon.objects import Classifier, ClassifierConfig, ObjectLibrary, build_object_library
from acts_recon.objects.classification import BOARD_COLUMNS
from acts_recon.sparse import Dictionary, Reconstructor, ReconstructorConfig, load_dictionary, shipped_dictionary_path

pytestmark = pytest.mark.slow

COUNTS_BOUND = 0.005
Frame = NDArray[np.uint16]


@pytest.fixture(scope="module")
def grasps(recording_path: Callable[[str], Path]) -> tuple[Frame, list[str]]:
    """The frame in the middle of each recorded grasp, and its object."""
    with np.load(recording_path("sdh_weiss/grasps_canvas.npz")) as archive:
        frames = archive["frames"][archive["start"] + archive["length"] // 2]
        touched = (frames > 60).any(axis=(1, 2))
        return frames[touched], archive["label"][touched].tolist()


def sample(frame: Frame, m: int) -> tuple[Frame, Frame]:
    rows, cols = frame.shape
    return adaptive(measure_in(frame), rows, cols, m, threshold_counts=60)


def random_dictionary(seed: int, atoms: int, side: int = 8) -> Dictionary:
    # In general position: no two atoms are nearly as good a choice, where rounding would decide.
    return Dictionary(np.random.default_rng(seed).standard_normal((side**2, atoms)).astype(np.float32), side)


def assert_same_image(reconstructor: Reconstructor, dictionary: Dictionary, indices: Frame, counts: Frame) -> None:
    config, geometry = reconstructor.config, reconstructor.geometry
    reconstructor.recover(indices, counts)
    image = core.recover(
        dictionary.atoms,
        dictionary.patch_size,
        config.patch_step,
        (geometry.rows, geometry.cols),
        indices,
        counts,
        touch_counts=config.touch_counts,
    )
    assert image is not None
    np.testing.assert_allclose(image, reconstructor.image, rtol=1e-5, atol=COUNTS_BOUND)


@pytest.mark.parametrize(
    ("shape", "side", "step", "atoms"),
    [
        ((32, 32), 8, 4, 130),
        ((32, 32), 8, 1, 50),
        ((33, 15), 8, 4, 61),  # last patches flush with the edge
        ((64, 64), 8, 4, 50),
        ((8, 8), 8, 4, 3),
        ((10, 64), 8, 3, 50),
        ((7, 9), 4, 4, 20),
        ((5, 5), 1, 1, 1),
    ],
)
def test_images_of_random_frames(shape: tuple[int, int], side: int, step: int, atoms: int) -> None:
    rng = np.random.default_rng(sum(shape) + step)
    dictionary = random_dictionary(step, atoms, side)
    config = ReconstructorConfig(patch_step=step, touch_counts=200)
    reconstructor = Reconstructor(ArrayGeometry(*shape), dictionary, config)
    taxels = shape[0] * shape[1]
    for m in (1, *rng.integers(1, taxels + 1, 12).tolist(), taxels):
        indices = rng.permutation(taxels)[:m].astype(np.uint16)
        assert_same_image(reconstructor, dictionary, indices, rng.integers(0, 1024, m).astype(np.uint16))


@pytest.mark.parametrize("atoms", [50, 1000])
@pytest.mark.parametrize("m", [50, 128, 256])
def test_images_of_real_grasps(grasps: tuple[Frame, list[str]], atoms: int, m: int) -> None:
    dictionary = Dictionary(load_dictionary(shipped_dictionary_path()).atoms[:, :atoms], 8)
    reconstructor = Reconstructor(ArrayGeometry(), dictionary)
    for frame in grasps[0][::10]:
        assert_same_image(reconstructor, dictionary, *sample(frame, m))


def test_measured_taxels_keep_their_value_and_no_touch_is_no_image() -> None:
    atoms = random_dictionary(3, 50).atoms
    indices = np.arange(0, 1024, 9, dtype=np.uint16)
    counts = np.linspace(0, 1023, indices.size).astype(np.uint16)
    image = core.recover(atoms, 8, 4, (32, 32), indices, counts)
    assert image is not None
    assert np.array_equal(image.ravel()[indices], np.where(counts > 60, counts, 0))
    assert image.min() >= 0
    assert image.max() <= 1023
    untouched = core.recover(atoms, 8, 4, (32, 32), indices, np.full_like(indices, 60))
    assert untouched is not None
    assert not untouched.any()


@pytest.mark.parametrize(
    ("shape", "side", "step"), [((7, 32), 8, 4), ((32, 7), 8, 4), ((32, 32), 9, 4), ((32, 32), 8, 0), ((32, 32), 8, 9)]
)
def test_patches_that_do_not_fit_are_refused(shape: tuple[int, int], side: int, step: int) -> None:
    atoms = random_dictionary(4, 5, side).atoms
    assert core.recover(atoms, side, step, shape, np.zeros(1, np.uint16), np.ones(1, np.uint16)) is None


def assert_same_class(classifier: Classifier, objects: ObjectLibrary, frame: tuple[Frame, Frame], bound: float) -> None:
    expected = classifier.step(*frame)
    columns = classifier.config.columns_for(frame[0].size, objects)
    assert columns <= core.atoms_limit(frame[0].size)
    result = core.classify(objects, *frame, max_columns=columns, touch_counts=classifier.config.touch_counts)
    np.testing.assert_allclose(result.residuals, expected.residuals, atol=bound)
    assert result.touched == expected.touched
    assert result.confidence == pytest.approx(expected.confidence, abs=2 * bound)
    # Where two classes explain a frame alike, rounding may decide between them.
    assert result.best == expected.best or expected.confidence < bound


@pytest.mark.parametrize(("max_columns", "ms", "bound"), [(BOARD_COLUMNS, (55, 256), 2e-5), (0, (20, 55, 64), 2e-4)])
def test_classes_of_real_grasps(
    grasps: tuple[Frame, list[str]], max_columns: int, ms: tuple[int, ...], bound: float
) -> None:
    frames, labels = grasps
    objects = build_object_library(frames[::7], labels[::7])
    classifier = Classifier(objects, ClassifierConfig(max_columns=max_columns))
    for m in ms:
        for frame in frames[::5]:
            assert_same_class(classifier, objects, sample(frame, m), bound)


@settings(max_examples=30)
@given(
    st.tuples(st.integers(2, 64), st.integers(2, 64)), st.integers(1, 12), st.integers(1, 3), st.integers(0, 2**32 - 1)
)
def test_classes_of_random_frames(shape: tuple[int, int], n_classes: int, of_each: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    frames = rng.integers(0, 1024, (n_classes * of_each, *shape))
    frames[:, 0, 0] = 1023
    objects = build_object_library(frames, [f"object {i % n_classes:02}" for i in range(len(frames))])
    classifier = Classifier(objects, ClassifierConfig(max_columns=BOARD_COLUMNS))
    taxels = shape[0] * shape[1]
    for m in {1, taxels, int(rng.integers(1, taxels + 1))}:
        indices = rng.permutation(taxels)[:m].astype(np.uint16)
        assert_same_class(classifier, objects, (indices, rng.integers(0, 1024, m).astype(np.uint16)), 1e-4)
    untouched = np.full(taxels, 60, dtype=np.uint16)
    assert_same_class(classifier, objects, (np.arange(taxels, dtype=np.uint16), untouched), 0.0)


def test_the_board_takes_two_columns_of_the_largest_frame_and_more_of_smaller_ones() -> None:
    assert [core.atoms_limit(m) for m in (1, 64, 512, 513, 1024, 4096)] == [16, 16, 16, 15, 8, 2]


def test_a_class_whose_residual_is_no_number_is_not_the_object() -> None:
    objects = build_object_library(np.full((2, 2, 2), 900), ["first", "second"])
    # A board takes any finite numbers; those of the first class overflow.
    object.__setattr__(objects, "columns", objects.columns * np.array([1e38, 1.0], dtype=np.float32))
    counts = np.full(4, 900, dtype=np.uint16)
    result = core.classify(objects, np.arange(4, dtype=np.uint16), counts, max_columns=BOARD_COLUMNS)
    assert np.isnan(result.residuals[0])
    assert (result.touched, result.best) == (True, 1)
    assert 0 <= result.confidence <= 1
