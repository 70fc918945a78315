# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the board recovers by itself, from the upload to the topics, with a real virtual board; ROS_DOMAIN_ID 46."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driver_rig import Rig
from sensor_msgs.msg import Image
from virtual_board import VirtualBoard

from acts_core.array import ArrayGeometry
from acts_msgs.msg import ObjectClass, TactileSamples
from acts_recon.objects import Classifier, ClassifierConfig, build_object_library, save_object_library
from acts_recon.objects.classification import BOARD_COLUMNS
from acts_recon.sparse import Dictionary, Reconstructor, load_dictionary, save_dictionary, shipped_dictionary_path
from acts_ros.qos import STREAM

pytestmark = pytest.mark.slow


def press(row: float, col: float, width: float = 2.5) -> np.ndarray:
    r, c = np.indices((32, 32))
    return np.rint(800 * np.exp(-((r - row) ** 2 + (c - col) ** 2) / (2 * width**2))).astype(np.uint16)


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(46)
    yield rig
    rig.close()


@pytest.fixture
def board(tmp_path: Path) -> Iterator[VirtualBoard]:
    """Pressed first high, then low, again and again."""
    frames = [press(8, 12)] * 20 + [press(24, 12)] * 20
    np.save(tmp_path / "presses.npy", np.array(frames))
    options = ("--recording", str(tmp_path / "presses.npy"), "--recording-rate-hz", "100", "--loop")
    with VirtualBoard(tmp_path / "board", *options) as board:
        yield board


def together(rig: Rig, results: list[Any], wanted: int) -> list[tuple[TactileSamples, Any]]:
    """Wait for results whose samples also came, by stamp."""

    def pairs() -> list[tuple[TactileSamples, Any]]:
        by_stamp = {(message.header.stamp.sec, message.header.stamp.nanosec): message for message in rig.samples}
        stamps = [(result.header.stamp.sec, result.header.stamp.nanosec) for result in results]
        return [(by_stamp[stamp], result) for stamp, result in zip(stamps, results, strict=True) if stamp in by_stamp]

    rig.spin_until(lambda: len(results) >= wanted and len(pairs()) >= wanted, f"{wanted} results with their samples")
    return pairs()


def test_images_of_the_board_are_those_of_acts_recon(board: VirtualBoard, rig: Rig, tmp_path: Path) -> None:
    shipped = load_dictionary(shipped_dictionary_path())
    dictionary = Dictionary(shipped.atoms[:, ::20], 8)
    save_dictionary(dictionary, tmp_path / "small.npz")
    images: list[Image] = []
    rig.listener.create_subscription(Image, "board_image", images.append, STREAM)
    rig.start_driver(port=board.link, model=tmp_path / "small.npz", output="image", m=50)
    pairs = together(rig, images, 200)

    reconstructor = Reconstructor(ArrayGeometry(), dictionary)
    touched = 0
    for samples, image in pairs:
        assert (image.header.frame_id, image.encoding, image.height, image.width) == ("plate", "mono16", 32, 32)
        reconstructor.recover(np.asarray(samples.indices, dtype=np.uint16), np.asarray(samples.counts, dtype=np.uint16))
        pixels = np.frombuffer(image.data, dtype="<u2").reshape(32, 32)
        assert np.abs(pixels - reconstructor.image).max() <= 0.505  # rounded to whole counts
        touched += bool(pixels.any())
    assert touched > 100
    status = rig.status_until(lambda status: int(status.get("board_results", "0")) > 200, "the report")
    assert int(status["board_results_dropped"]) <= int(status["lost"])


def test_objects_of_the_board_are_those_of_acts_recon(board: VirtualBoard, rig: Rig, tmp_path: Path) -> None:
    library = build_object_library([press(8, 12, 2.0), press(24, 12, 2.0)], ["high", "low"])
    save_object_library(library, tmp_path / "objects.npz")
    objects: list[ObjectClass] = []
    rig.listener.create_subscription(ObjectClass, "board_object", objects.append, STREAM)
    rig.start_driver(port=board.link, model=tmp_path / "objects.npz", output="object", m=50)
    pairs = together(rig, objects, 700)

    classifier = Classifier(library, ClassifierConfig(max_columns=BOARD_COLUMNS))
    seen = set()
    for samples, result in pairs:
        assert (result.header.frame_id, result.sequence, result.name) == ("plate", samples.sequence, "")
        expected = classifier.step(
            np.asarray(samples.indices, dtype=np.uint16), np.asarray(samples.counts, dtype=np.uint16)
        )
        np.testing.assert_allclose(result.residuals, expected.residuals, atol=1e-4)
        assert result.confidence == pytest.approx(expected.confidence, abs=1e-3)
        assert result.class_number == (expected.best if expected.touched else ObjectClass.NO_OBJECT)
        seen.add(result.class_number)
    assert {0, 1} <= seen
