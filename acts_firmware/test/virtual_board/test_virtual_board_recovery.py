# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A virtual board that recovers and classifies by itself: upload, images, objects, and the time they take."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median

import numpy as np
import pytest
from board_client import BoardClient
from board_process import BoardProcess
from pressed_frames import press

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame
from acts_core.wire import BoardImage, BoardObject, BoardSettings, object_library, patch_dictionary
from acts_core.wire.commands import HeldModel
from acts_recon.objects import Classifier, ClassifierConfig, ObjectLibrary, build_object_library
from acts_recon.objects.classification import BOARD_COLUMNS
from acts_recon.sparse import Dictionary, Reconstructor, ReconstructorConfig, load_dictionary, shipped_dictionary_path

pytestmark = pytest.mark.slow


@pytest.fixture
def board(tmp_path: Path) -> BoardProcess:
    """A ball that rolls over the skin, played for ever."""
    frames = np.array([press(6 + i, 10 + i / 2, 2.5) for i in range(20)])
    np.save(tmp_path / "rolling.npy", frames)
    options = ("--recording", tmp_path / "rolling.npy", "--recording-rate-hz", 20, "--loop", "--rate-hz", 100_000)
    return BoardProcess(tmp_path, "--m", 50, *options)


@pytest.fixture(scope="module")
def small_dictionary() -> Dictionary:
    return Dictionary(load_dictionary(shipped_dictionary_path()).atoms[:, ::20], 8)


@pytest.fixture(scope="module")
def objects() -> ObjectLibrary:
    places = [("high", 8.0), ("low", 22.0)] * 30
    return build_object_library(
        [press(row, 8 + i / 5, 2 + i / 30) for i, (_, row) in enumerate(places)], [name for name, _ in places]
    )


def with_samples(
    messages: Sequence[BoardImage | BoardObject], frames: Sequence[SampleFrame]
) -> Iterator[tuple[BoardImage | BoardObject, SampleFrame]]:
    """Messages with the frames they were made of, whose clocks agree; the board drops what nobody reads in time."""
    by_sequence = {frame.sequence: frame for frame in frames}
    for message in messages:
        frame = by_sequence.get(message.sequence)
        if frame is not None:
            assert frame.board_us == message.board_us
            yield message, frame


def period_us(messages: Sequence[BoardImage | BoardObject | SampleFrame]) -> float:
    """Usual time from one to the next; a board that gets no processor time for a while starts one late."""
    return median((two.board_us - one.board_us) / (two.sequence - one.sequence) for one, two in pairwise(messages))


def test_images_are_those_of_acts_recon(board: BoardProcess, small_dictionary: Dictionary) -> None:
    model = patch_dictionary(small_dictionary.atoms)
    with board:
        client = BoardClient(board)
        client.upload(model)
        reply = client.configure(BoardSettings(m=50, output="image", touch_counts=40, frame_period_us=0))
        assert reply.state.model == HeldModel.of(model)
        assert not reply.state.samples_only
        images = [image for image in client.read_until_messages(BoardImage, 300) if isinstance(image, BoardImage)]
    reconstructor = Reconstructor(ArrayGeometry(), small_dictionary, ReconstructorConfig(touch_counts=40))
    touched = ties = 0
    for image, frame in with_samples(images, client.frames):
        assert isinstance(image, BoardImage)
        reconstructor.recover(frame.indices, frame.counts)
        touched += bool(reconstructor.image.any())
        difference = np.abs(image.counts - reconstructor.image)
        assert difference.ravel()[frame.indices].max() <= 0.505  # rounded to whole counts
        # Where two atoms explain the samples alike, rounding decides what lies between them: 1 of 14,000 images.
        ties += difference.max() > 0.505
        assert abs(image.duration_us - 491) <= 1  # as published for 50 atoms, M = 50
    assert touched > 100
    assert ties <= 1
    # One after the other: 884 us of sampling, then recovery.
    assert period_us(images) == pytest.approx(884 + 491, abs=0.5)


def test_objects_are_those_of_acts_recon(board: BoardProcess, objects: ObjectLibrary) -> None:
    with board:
        client = BoardClient(board)
        client.upload(object_library(objects.columns, objects.classes))
        client.configure(BoardSettings(m=50, output="object", frame_period_us=0))
        results = [result for result in client.read_until_messages(BoardObject, 800) if isinstance(result, BoardObject)]
    classifier = Classifier(objects, ClassifierConfig(max_columns=BOARD_COLUMNS))
    seen = set()
    ties = 0
    for result, frame in with_samples(results, client.frames):
        assert isinstance(result, BoardObject)
        expected = classifier.step(frame.indices, frame.counts)
        assert abs(result.duration_us - 343) <= 1
        if not np.allclose(result.residuals, expected.residuals, rtol=0, atol=1e-4):
            # Where two columns explain the samples alike, rounding decides which is chosen: 1 of 300,000 random frames.
            ties += 1
            continue
        assert result.number == (expected.best if expected.touched else None) or expected.confidence < 1e-4
        seen.add(result.number)
    assert ties <= 1
    assert seen >= {0, 1}
    assert period_us(results) == pytest.approx(884 + 343, abs=0.5)


def test_a_model_that_does_not_fit_leaves_the_samples_alone(
    board: BoardProcess, small_dictionary: Dictionary, objects: ObjectLibrary
) -> None:
    with board:
        client = BoardClient(board)
        assert client.configure(BoardSettings(m=50, output="image", frame_period_us=0)).state.samples_only
        assert client.upload(object_library(objects.columns, objects.classes)).state.samples_only
        assert not client.upload(patch_dictionary(small_dictionary.atoms)).state.samples_only
        client.read_until_messages(BoardImage, 3)
        assert client.configure(BoardSettings(rows=7, m=50, output="image", frame_period_us=0)).state.samples_only
        so_far = len(client.messages)
        frames = len(client.frames)
        while len(client.frames) < frames + 50:
            client.read()
        assert not any(isinstance(message, BoardImage) for message in client.messages[so_far:])
        assert period_us(client.frames[-30:]) == pytest.approx(884, abs=0.5)


def test_the_time_of_recovery_can_be_set(tmp_path: Path, small_dictionary: Dictionary) -> None:
    with BoardProcess(tmp_path, "--m", 50, "--rate-hz", 100_000, "--sample-us", 4, "--recovery-us", 300) as board:
        client = BoardClient(board)
        client.upload(patch_dictionary(small_dictionary.atoms))
        client.configure(BoardSettings(m=50, output="image", frame_period_us=0))
        images = [image for image in client.read_until_messages(BoardImage, 50) if isinstance(image, BoardImage)]
    assert {image.duration_us for image in images} == {300}
    assert period_us(images) == pytest.approx(500)
