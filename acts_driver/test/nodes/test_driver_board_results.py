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
from numpy.typing import NDArray
from pressed_frames import press
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from virtual_board import VirtualBoard

from acts_core.array import ArrayGeometry
from acts_msgs.msg import ObjectClass, TactileSamples
from acts_recon.objects import Classifier, ClassifierConfig, build_object_library, save_object_library
from acts_recon.objects.classification import BOARD_COLUMNS
from acts_recon.sparse import Dictionary, Reconstructor, load_dictionary, save_dictionary, shipped_dictionary_path

pytestmark = pytest.mark.slow

DEEP = QoSProfile(depth=20_000, reliability=ReliabilityPolicy.BEST_EFFORT)


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


def heard(rig: Rig, kind: type, topic: str) -> list[Any]:
    """Messages of a topic from now on, and all samples: none of either is lost where this machine listens late."""
    messages: list[Any] = []
    rig.listener.create_subscription(kind, topic, messages.append, DEEP)
    rig.listener.destroy_subscription(rig.subscription)
    rig.subscription = rig.listener.create_subscription(TactileSamples, "samples", rig.samples.append, DEEP)
    return messages


def together(rig: Rig, results: list[Any], wanted: int) -> list[tuple[TactileSamples, Any]]:
    """Wait for results whose samples also came, by stamp."""
    samples_at: dict[tuple[int, int], TactileSamples] = {}
    results_at: dict[tuple[int, int], Any] = {}
    known = 0, 0

    def are_enough() -> bool:
        # Only what is new: whoever looks at all of it after each message gets no message any more on a busy machine.
        nonlocal known
        samples_at.update((stamp_of(message), message) for message in rig.samples[known[0] :])
        results_at.update((stamp_of(message), message) for message in results[known[1] :])
        known = len(rig.samples), len(results)
        return len(results_at) >= wanted and len(samples_at.keys() & results_at.keys()) >= wanted

    rig.spin_until(are_enough, f"{wanted} results with their samples")
    return [(samples_at[stamp], result) for stamp, result in results_at.items() if stamp in samples_at]


def stamp_of(message: Any) -> tuple[int, int]:
    return message.header.stamp.sec, message.header.stamp.nanosec


def is_recovered_but_for_rounding(
    pixels: NDArray[np.uint16], dictionary: Dictionary, frame: tuple[NDArray[np.uint16], NDArray[np.uint16]]
) -> bool:
    """Whether acts_recon gives this image by atoms that differ in their last digits.

    Where two atoms fit alike, these decide which is chosen: in 5 of 200,000 noisy frames of the presses here.
    """
    rng = np.random.default_rng(1)
    for _ in range(40):
        atoms = dictionary.atoms * (1 + 1e-6 * rng.standard_normal(dictionary.atoms.shape))
        near = Reconstructor(ArrayGeometry(), Dictionary(atoms.astype(np.float32), dictionary.patch_size))
        if np.abs(pixels - near.recover(*frame)).max() <= 0.505:
            return True
    return False


def test_images_of_the_board_are_those_of_acts_recon(board: VirtualBoard, rig: Rig, tmp_path: Path) -> None:
    shipped = load_dictionary(shipped_dictionary_path())
    dictionary = Dictionary(shipped.atoms[:, ::20], 8)
    save_dictionary(dictionary, tmp_path / "small.npz")
    images = heard(rig, Image, "board_image")
    rig.start_driver(port=board.link, model=tmp_path / "small.npz", output="image", m=50)
    pairs = together(rig, images, 200)

    reconstructor = Reconstructor(ArrayGeometry(), dictionary)
    touched = 0
    for samples, image in pairs:
        assert (image.header.frame_id, image.encoding, image.height, image.width) == ("plate", "mono16", 32, 32)
        frame = np.asarray(samples.indices, dtype=np.uint16), np.asarray(samples.counts, dtype=np.uint16)
        reconstructor.recover(*frame)
        pixels = np.frombuffer(image.data, dtype="<u2").reshape(32, 32)
        # Rounded to whole counts.
        is_same = np.abs(pixels - reconstructor.image).max() <= 0.505
        assert is_same or is_recovered_but_for_rounding(pixels, dictionary, frame)
        touched += bool(pixels.any())
    assert touched > 100
    status = rig.status_until(lambda status: int(status.get("board_results", "0")) > 200, "the report")
    assert int(status["board_results_dropped"]) <= int(status["lost"])


def test_objects_of_the_board_are_those_of_acts_recon(board: VirtualBoard, rig: Rig, tmp_path: Path) -> None:
    library = build_object_library([press(8, 12, 2.0), press(24, 12, 2.0)], ["high", "low"])
    save_object_library(library, tmp_path / "objects.npz")
    objects = heard(rig, ObjectClass, "board_object")
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
