# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags that nobody meant to export: topics without messages, stamps or names, and others than those of one skin."""

from __future__ import annotations

import re
from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, JointState
from test_export import header, image, joints, pressed, rows_of, samples, write_bag

from acts_core.errors import RecordingError
from acts_msgs.msg import Baseline, RegionContact, RegionContacts
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter
from acts_tools.cli import main
from acts_tools.export.recording import Choice, open_recording


def test_images_that_cannot_be_exported_leave_the_samples(tmp_path: Path) -> None:
    """Of a topic that had a publisher and no message, and of one in colours."""
    definition = Definitions().describe("sensor_msgs/msg/Image")
    bag = BagWriter(tmp_path / "b")
    bag.add_topic("/plate/image_raw", "sensor_msgs/msg/Image", *definition, [])
    kind = "acts_msgs/msg/TactileSamples"
    topic = bag.add_topic("/plate/samples", kind, *Definitions().describe(kind), [])
    for number in range(3):
        bag.write(topic, serialize_message(samples(number, pressed(number))))
    bag.close()
    assert len(rows_of(tmp_path / "b")[0]) == 3
    coloured = Image(header=header(0), height=1, width=1, encoding="rgb8", step=3, data=array("B", bytes(3)))
    path = write_bag(
        tmp_path / "c", ("/plate/image_raw", coloured), *(("/plate/samples", samples(n, pressed(n))) for n in range(3))
    )
    assert len(rows_of(path)[0]) == 3


@pytest.mark.parametrize(
    ("others", "message"),
    [
        (
            [("/joint_states", JointState(name=["knee"], position=[0.5]))],
            "1 of 1 joint states on /joint_states have no",
        ),
        ([("/joint_states", joints(99, knee=0.5))], "all 2 frames are from before the first"),
        (
            [("/arm", joints(1, knee=0.5)), ("/leg", joints(1, knee=0.5))],
            "on /arm, /leg: choose one with --joints, or none",
        ),
    ],
)
def test_joint_states_that_do_not_fit_are_told_and_can_be_left_out(
    others: list[tuple[str, Any]], message: str, tmp_path: Path
) -> None:
    path = write_bag(tmp_path / "b", *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20)), *others)
    with pytest.raises(RecordingError, match=message):
        rows_of(path)
    assert [row.joints for row in rows_of(path, joints="none")[0]] == [None, None]


def test_joint_states_without_names_are_none(tmp_path: Path) -> None:
    """As on the topic `cmd_leap`."""
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20)),
        ("/cmd_leap", JointState(header=header(15), position=[0.5])),
    )
    with open_recording(path, Choice()) as recording:
        assert [row.joints for row in recording.rows()] == [None, None]
        assert recording.joint_columns == ()


@pytest.mark.parametrize(
    ("messages", "message"),
    [
        (
            [("/plate/image_raw", image(10 * n, np.zeros((8 + n, 8), np.uint16))) for n in range(2)],
            r"image of \(9, 8\)",
        ),
        ([("/plate/image_raw", Image(height=1, width=1, encoding="mono16", step=2, data=[0, 0]))], "have no stamp"),
        (
            [("/plate/baseline", Baseline(rows=4, cols=4)), ("/plate/samples", samples(1, pressed(0)))],
            r"/plate/baseline in '.*b': noise",
        ),
    ],
)
@pytest.mark.parametrize("kind", ["csv", "npz"])
def test_nothing_half_written_is_left(
    kind: str, messages: list[tuple[str, Any]], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_bag(tmp_path / "b", *messages)
    out = tmp_path / ("out.npz" if kind == "npz" else "out")
    assert main(["export", str(path), "--to", kind, "-o", str(out)]) == 1
    assert re.search(message, capsys.readouterr().err)
    assert [entry.name for entry in tmp_path.iterdir()] == ["b"]


def test_a_skin_of_several_patches_asks_for_its_layout(tmp_path: Path) -> None:
    regions = RegionContacts(header=header(1), regions=[RegionContact(name=name) for name in ("palm", "thumb")])
    path = write_bag(tmp_path / "b", ("/hand/samples", samples(1, pressed(0))), ("/hand/regions", regions))
    with open_recording(path, Choice()) as recording:
        assert recording.hint.startswith("/hand/regions has 2 patches: with --layout NAME")
    with open_recording(path, Choice(layout="leap_right")) as recording:
        assert recording.hint == ""
