# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames to learn from, out of bags."""

from __future__ import annotations

from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image

from acts_core.errors import RecordingError
from acts_msgs.msg import Baseline, Contact, TactileSamples
from acts_recon.sparse import load_dictionary
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter
from acts_tools.cli import Parser
from acts_tools.training import command
from acts_tools.training.bag_frames import bag_frames
from acts_tools.training.frames import recorded_frames

Frames = NDArray[np.uint16]


def write_bag(path: Path, *messages: tuple[str, Any]) -> Path:
    bag = BagWriter(path)
    definitions = Definitions()
    handles: dict[str, Any] = {}
    for topic, message in messages:
        if topic not in handles:
            package, kind = type(message).__module__.split(".")[0], type(message).__name__
            name = f"{package}/msg/{kind}"
            handles[topic] = bag.add_topic(topic, name, *definitions.describe(name), [])
        bag.write(handles[topic], serialize_message(message))
    bag.close()
    return path


def raster(frame: Frames, m: int | None = None) -> TactileSamples:
    indices = np.random.default_rng(0).permutation(frame.size).astype(np.uint16)[:m]
    counts = frame.ravel()[indices]
    return TactileSamples(
        scheme=TactileSamples.SCHEME_RASTER,
        rows=frame.shape[0],
        cols=frame.shape[1],
        indices=array("H", indices.tobytes()),
        counts=array("H", counts.tobytes()),
    )


def image(frame: Frames, *, big: bool = False, padding: int = 0, encoding: str = "mono16") -> Image:
    rows = frame.astype(">u2" if big else "<u2")
    data = b"".join(row.tobytes() + bytes(padding) for row in rows)
    rows_n, cols_n = frame.shape
    step = 2 * cols_n + padding
    return Image(
        height=rows_n, width=cols_n, encoding=encoding, is_bigendian=int(big), step=step, data=array("B", data)
    )


@pytest.fixture
def frames() -> Frames:
    row, col = np.indices((12, 10))
    bumps = [900 * np.exp(-((row - r) ** 2 + (col - c) ** 2) / 9) for r in range(0, 12) for c in range(0, 10)]
    return np.array(bumps).astype(np.uint16)


@pytest.mark.parametrize("form", [{}, {"big": True}, {"padding": 3}])
def test_images_in_counts(form: dict[str, Any], frames: Frames, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "bag", *(("/plate/image_raw", image(frame, **form)) for frame in frames[:5]))
    read, topic = bag_frames(bag)
    assert topic == "/plate/image_raw"
    assert np.array_equal(read, frames[:5])


@pytest.mark.parametrize("before", [0, 2])
def test_raster_samples_less_the_baseline_beside_them(before: int, frames: Frames, tmp_path: Path) -> None:
    raised = frames + np.uint16(30)
    baseline = Baseline(
        rows=12, cols=10, baseline=array("f", np.full(120, 30.0)), noise=array("f", np.ones(120)), valid=[True] * 120
    )
    baseline.valid[7] = False
    messages: list[tuple[str, Any]] = [("/plate/samples", raster(frame)) for frame in raised[:4]]
    # As a recorder that begins later hears it, which it may after the first samples.
    messages.insert(before, ("/plate/baseline", baseline))
    bag = write_bag(tmp_path / "bag", ("/plate/contact", Contact()), *messages)
    read, topic = bag_frames(bag)
    assert topic == "/plate/samples"
    expected = frames[:4].copy()
    expected[:, 0, 7] += 30
    assert np.array_equal(read, expected)


def test_a_dictionary_from_a_bag_and_an_npz_file(frames: Frames, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "touch", *(("/plate/samples", raster(frame)) for frame in frames[::2]))
    np.savez(tmp_path / "f.npz", frames=frames[1::2])
    words = ["train", "-o", str(tmp_path / "d.npz"), "--frames", str(bag), str(tmp_path / "f.npz")]
    words += ["--patch-size", "6", "--patches", "400", "--atoms", "50", "--sparsity", "4", "--iterations", "2"]
    parser = Parser()
    command.add_parser(parser.add_subparsers())
    assert command.run(parser.parse_args(words)) == 0
    provenance = load_dictionary(tmp_path / "d.npz", patch_size=6).provenance
    assert "60 frames of /plate/samples in touch (sha256 " in provenance
    assert "60 frames of f.npz (sha256 " in provenance


def test_a_topic_is_named_as_in_other_commands(frames: Frames, tmp_path: Path) -> None:
    """Without its first slash, too."""
    bag = write_bag(
        tmp_path / "b", *((topic, raster(frame)) for frame in frames for topic in ("/a/samples", "/b/samples"))
    )
    words = ["train", "-o", str(tmp_path / "d.npz"), "--frames", str(bag), "--topic", "b/samples"]
    words += ["--patch-size", "6", "--patches", "400", "--atoms", "50", "--sparsity", "4", "--iterations", "1"]
    parser = Parser()
    command.add_parser(parser.add_subparsers())
    assert command.run(parser.parse_args(words)) == 0
    assert "frames of /b/samples in b" in load_dictionary(tmp_path / "d.npz", patch_size=6).provenance


def test_of_several_topics_one_is_chosen(frames: Frames, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "bag", ("/a/samples", raster(frames[0])), ("/a/image_raw", image(frames[1])))
    with pytest.raises(RecordingError, match=r"/a/image_raw, /a/samples: choose one with --topic"):
        bag_frames(bag)
    assert np.array_equal(bag_frames(bag, "/a/image_raw")[0], frames[1:2])
    with pytest.raises(RecordingError, match=r"no topic /b; needed is one of type .* It has /a/image_raw, /a/samples"):
        bag_frames(bag, "/b")


def test_what_holds_no_full_frames_is_refused(frames: Frames, tmp_path: Path) -> None:
    view = image(frames[0], encoding="rgb8")
    bag = write_bag(tmp_path / "bag", ("/p/samples", raster(frames[0], 55)), ("/p/image", view), ("/p/c", Contact()))
    with pytest.raises(RecordingError, match="no topic of full frames, only /p/c, /p/image, /p/samples; needed is"):
        bag_frames(bag)
    with pytest.raises(RecordingError, match=r"55 samples of 12 x 10 taxels: .*scheme raster"):
        bag_frames(bag, "/p/samples")
    with pytest.raises(RecordingError, match=r"image 10 x 12, rgb8.*needed is mono16"):
        bag_frames(bag, "/p/image")
    with pytest.raises(RecordingError, match="acts_msgs/msg/Contact on /p/c; needed is"):
        bag_frames(bag, "/p/c")


def test_impossible_messages_are_refused(frames: Frames, tmp_path: Path) -> None:
    high = raster(frames[0])
    high.counts[3] = 1024
    twice = raster(frames[0])
    twice.indices[3] = twice.indices[4]
    outside = raster(frames[0])
    outside.indices[3] = 999
    other_size = Baseline(rows=2, cols=2, baseline=array("f", [0] * 4), noise=array("f", [0] * 4), valid=[True] * 4)
    for number, (messages, word) in enumerate(
        [
            ([("/s", raster(frames[0])), ("/s", high)], "message 1 of /s .* holds 1024 counts"),
            ([("/s", raster(frames[0])), ("/s", twice)], "message 1 of /s .* every taxel must have been measured"),
            ([("/s", raster(frames[0])), ("/s", outside)], "index 999"),
            ([("/s", raster(frames[0])), ("/s", raster(frames[0][:8]))], "frames of different sizes on /s"),
            ([("/baseline", other_size), ("/s", raster(frames[0]))], "/baseline in .* does not fit /s"),
        ]
    ):
        with pytest.raises(RecordingError, match=word):
            bag_frames(write_bag(tmp_path / f"bag{number}", *messages))


def test_taxels_that_are_not_live_are_0(frames: Frames, tmp_path: Path) -> None:
    live = np.arange(120).reshape(12, 10) % 7 > 0
    np.savez(tmp_path / "some.npz", frames=frames, live=live)
    np.savez(tmp_path / "all.npz", frames=frames)
    assert frames[:, ~live].any()
    found = recorded_frames([tmp_path / "some.npz", tmp_path / "all.npz"]).frames
    assert found.dtype == np.uint16
    np.testing.assert_array_equal(found, np.concatenate([np.where(live, frames, 0), frames]))


def test_recordings_must_be_of_one_size(frames: Frames, tmp_path: Path) -> None:
    for name, part in (("a", frames), ("b", frames[:, :8])):
        np.savez(tmp_path / f"{name}.npz", frames=part)
    with pytest.raises(RecordingError, match=r"b.npz: frames of 8 x 10 taxels, those of .*a.npz are 12 x 10"):
        recorded_frames([tmp_path / "a.npz", tmp_path / "b.npz"])
    with pytest.raises(RecordingError, match="none of the recordings is a bag"):
        recorded_frames([tmp_path / "a.npz"], "/plate/samples")
    with pytest.raises(RecordingError, match="there is no bag"):
        recorded_frames([tmp_path / "none.mcap"])
