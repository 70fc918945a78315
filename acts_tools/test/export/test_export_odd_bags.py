# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags that nobody meant to export: topics without messages, stamps, names or numbers, and others than of one skin."""

from __future__ import annotations

import csv
import json
import math
import re
from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, JointState
from test_export import contact, contacts, header, image, joints, pressed, rows_of, samples, write_bag

from acts_core.errors import RecordingError
from acts_core.skin import layout
from acts_msgs.msg import Baseline, RegionContact, RegionContacts
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter
from acts_tools.cli import main
from acts_tools.export.recording import open_recording
from acts_tools.export.topics import Choice


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


def test_samples_that_were_recorded_twice_are_one_frame(tmp_path: Path) -> None:
    parts = []
    for number in range(3):
        part = samples(number, pressed(0))
        part.indices, part.counts = part.indices[number::3], part.counts[number::3]
        parts.append(("/plate/samples", part))
    once = write_bag(tmp_path / "once", *parts)
    twice = write_bag(tmp_path / "twice", *parts[:2], *parts[1:])
    images, others = ([row.image.tolist() for row in rows_of(path)[0]] for path in (once, twice))
    assert images == others


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


def test_a_bag_that_was_cut_off_before_its_first_topic_is_said_to_be(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "b", ("/plate/image_raw", image(10, pressed(0))))
    (path / "metadata.yaml").unlink()
    (file,) = path.glob("*.mcap")
    file.write_bytes(file.read_bytes()[:100])
    with pytest.raises(RecordingError, match=r"has no skin: .*it has none; the bag '.*' was never closed"):
        rows_of(path)


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
        ([("/plate/image_raw", Image(height=1, encoding="mono16", step=2, data=[0, 0]))], "image 0 x 1, .* one pixel"),
        (
            [("/plate/baseline", Baseline(rows=4, cols=4)), ("/plate/samples", samples(1, pressed(0)))],
            r"/plate/baseline in '.*b': a baseline of 4 x 4 taxels, the array has 32 x 32",
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


@pytest.mark.parametrize("topic", ["image_raw", "samples"])
def test_a_skin_in_the_root_namespace(topic: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make = image if topic == "image_raw" else samples
    path = write_bag(
        tmp_path / "b",
        (f"/{topic}", make(1, pressed(0))),
        (f"/plate/{topic}", make(1, pressed(0))),
        ("/contact", contact(1, 2.0)),
    )
    with pytest.raises(RecordingError, match="has the skins /, /plate: choose one with --skin"):
        rows_of(path)
    with pytest.raises(RecordingError, match="has no skin /foot; it has /, /plate"):
        rows_of(path, skin="foot")
    assert main(["export", str(path), "--skin", "/", "--to", "csv", "-o", str(tmp_path / "out")]) == 0
    assert "1 row of /\n" in capsys.readouterr().out
    with (tmp_path / "out/frames.csv").open() as file:
        assert [row["contact.force_n"] for row in csv.DictReader(file)] == ["2"]


def efforts(time_ms: int, **efforts_nm: float) -> JointState:
    """Joints at rest whose efforts are told."""
    count = len(efforts_nm)
    return JointState(header=header(time_ms), name=list(efforts_nm), position=[0.5] * count, effort=efforts_nm.values())


@pytest.fixture
def bag_without_all_efforts(tmp_path: Path) -> Path:
    """Images at 0 to 40 ms; the hip has no effort, the knee has one now and then, as of drivers that tell NaN."""
    nan = math.nan
    return write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (0, 10, 20, 30, 40)),
        *(("/joint_states", efforts(t, hip=nan, knee=one)) for t, one in ((0, nan), (10, 1.5), (20, nan), (30, 2.5))),
    )


def test_in_a_lerobot_dataset_all_joint_values_are_numbers(
    bag_without_all_efforts: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="./acts run python3 -m pip install pyarrow")
    out = tmp_path / "out"
    assert main(["export", str(bag_without_all_efforts), "--to", "lerobot", "--rate", "100", "-o", str(out)]) == 0
    states = parquet.read_table(out / "data/chunk-000/file-000.parquet")["observation.state"].to_pylist()
    assert states == [[0.5, 0.5, 1.5], [0.5, 0.5, 1.5], [0.5, 0.5, 2.5], [0.5, 0.5, 2.5]]
    info = json.loads((out / "meta/info.json").read_text())
    assert info["features"]["observation.state"]["names"] == ["hip.position", "knee.position", "knee.effort"]
    statistics = json.loads((out / "meta/stats.json").read_text(), parse_constant=pytest.fail)
    assert statistics["observation.state"]["max"] == [0.5, 0.5, 2.5]
    told = capsys.readouterr().err
    for sentence in (
        "hip.effort left out: no number of it was published",
        "2 values of joints are no numbers, and those before them stay: knee.effort",
    ):
        assert sentence in told
        assert sentence in (out / "notes.txt").read_text()


def test_in_a_lerobot_dataset_all_values_of_contacts_and_joints_are_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], recwarn: pytest.WarningsRecorder
) -> None:
    """Messages of contacts without are left out; numbers beyond single precision are none there."""
    parquet = pytest.importorskip("pyarrow.parquet", reason="./acts run python3 -m pip install pyarrow")
    several = contacts(10, 1, 2)
    several.contacts[1].position.x = math.inf
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (0, 10, 20, 30)),
        *(("/plate/contact", contact(t, force_n)) for t, force_n in ((0, 1.0), (10, math.nan), (20, 3.0))),
        *(("/plate/contacts", one) for one in (contacts(0, 1), several)),
        *(("/joint_states", joints(t, knee=angle)) for t, angle in ((0, 0.5), (10, 1e300))),
    )
    out = tmp_path / "out"
    assert main(["export", str(path), "--to", "lerobot", "--rate", "100", "-o", str(out)]) == 0
    table = parquet.read_table(out / "data/chunk-000/file-000.parquet")
    assert [one[3] for one in table["observation.contact.plate"].to_pylist()] == [1.0, 1.0, 3.0, 3.0]
    assert [one[0] for one in table["observation.contacts.plate"].to_pylist()] == [1.0] * 4
    assert table["observation.state"].to_pylist() == [0.5] * 4
    json.loads((out / "meta/stats.json").read_text(), parse_constant=pytest.fail)
    assert [str(one.message) for one in recwarn if one.category is RuntimeWarning] == []
    told = capsys.readouterr().err
    for topic in ("/plate/contact", "/plate/contacts"):
        assert f"1 message of {topic} left out, with values that are no numbers\n" in told
    assert "1 value of a joint is no number, and the one before it stays: knee.position" in told


def test_a_contact_of_endless_area_does_not_tell_the_size_of_the_taxels(
    tmp_path: Path, recwarn: pytest.WarningsRecorder
) -> None:
    endless = contact(10, 1.0)
    endless.area = math.inf
    path = write_bag(tmp_path / "b", ("/plate/samples", samples(10, pressed(0))), ("/plate/contact", endless))
    with open_recording(path, Choice()) as recording:
        assert [row.contacts is not None and len(row.contacts) for row in recording.rows()] == [1]
        assert recording.notes() == []
    assert [str(one.message) for one in recwarn if one.category is RuntimeWarning] == []


def test_in_other_formats_joint_values_are_what_was_published(bag_without_all_efforts: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.npz"
    assert main(["export", str(bag_without_all_efforts), "--to", "npz", "-o", str(out)]) == 0
    with np.load(out) as arrays:
        np.testing.assert_equal(arrays["knee.effort"], [math.nan, 1.5, math.nan, 2.5, 2.5])
        assert np.isnan(arrays["hip.effort"]).all()


def test_contacts_and_joint_states_that_go_back_in_time_are_left_out_and_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20, 30)),
        *(("/plate/contact", contact(t, float(t))) for t in (10, 20, 5, 20)),
        *(("/plate/contacts", contacts(t, 1)) for t in (10, 9)),
        *(("/joint_states", joints(t, knee=float(t))) for t in (10, 20, 15, 16, 17)),
    )
    sentences = [
        f"{count} of {topic} left out, not newer than one before: was a clock set?"
        for count, topic in (
            ("2 messages", "/plate/contact"),
            ("1 message", "/plate/contacts"),
            ("3 messages", "/joint_states"),
        )
    ]
    rows, _ = rows_of(path)
    assert [row.joints.tolist() for row in rows if row.joints is not None] == [[10.0], [20.0], [20.0]]
    assert main(["export", str(path), "--to", "csv", "-o", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().err
    assert main(["export", str(path), "--to", "npz", "-o", str(tmp_path / "out.npz")]) == 0
    with np.load(tmp_path / "out.npz") as arrays:
        in_npz = arrays["notes"].tolist()
    assert [line.removeprefix(f"{path}: ") for line in told.splitlines()] == sentences
    assert in_npz == sentences
    assert (tmp_path / "out/notes.txt").read_text().splitlines() == [f"b: {one}" for one in sentences]


def test_of_a_bag_without_fault_nothing_is_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_bag(tmp_path / "b", *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20)))
    assert main(["export", str(path), "--to", "csv", "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().err == ""
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["contacts.csv", "frames.csv"]


def test_joint_states_of_publishers_whose_messages_overtake_one_another(tmp_path: Path) -> None:
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20, 30)),
        *(("/joint_states", joints(t, **told)) for t, told in ((10, {"knee": 1.0}), (9, {"hip": 1.0}))),
        *(("/joint_states", joints(t, **told)) for t, told in ((20, {"knee": 2.0}), (20, {"hip": 2.0}))),
    )
    rows, _ = rows_of(path)
    assert [row.joints.tolist() for row in rows if row.joints is not None] == [[1.0, 1.0], [2.0, 2.0], [2.0, 2.0]]
    with open_recording(path, Choice()) as recording:
        assert len(list(recording.rows())) == 3
        assert recording.notes() == []


def test_contacts_beside_recorded_images_are_found_in_the_samples(tmp_path: Path) -> None:
    recorded = np.zeros_like(pressed(0))
    both = [
        message
        for n in range(3)
        for message in (("/plate/samples", samples(n, pressed(n))), ("/plate/image_raw", image(n, recorded)))
    ]
    alone = write_bag(tmp_path / "samples", *(one for one in both if one[0] == "/plate/samples"))
    expected, _ = rows_of(alone)
    assert [row.contacts is not None and len(row.contacts) for row in expected] == [1, 1, 1]
    found, _ = rows_of(write_bag(tmp_path / "both", *both))
    assert all(np.array_equal(row.image, recorded) for row in found)
    for row, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(row.contact, other.contact)
        np.testing.assert_array_equal(row.contacts, other.contacts)
    # What was recorded goes first.
    rows, _ = rows_of(write_bag(tmp_path / "all", *both, ("/plate/contact", contact(0, 7.0))))
    assert [row.contact[3] for row in rows if row.contact is not None] == [7.0, 7.0, 7.0]
    assert [row.contacts is not None and len(row.contacts) for row in rows] == [1, 1, 1]


def test_a_bag_that_begins_in_a_touch_keeps_its_contacts(tmp_path: Path) -> None:
    """The first frames do not measure what the images show already; the touch fades, so the first image has most."""
    messages: list[tuple[str, Any]] = []
    for n, peak in enumerate((600, 550, 300, 200)):
        counts = np.zeros((32, 32), np.uint16)
        counts[20:23, 10:13] = peak
        frame = samples(n, counts)
        if n == 0:
            frame.indices, frame.counts = frame.indices[:512], frame.counts[:512]
        messages += [("/plate/samples", frame), ("/plate/image_raw", image(n, counts))]
    with open_recording(write_bag(tmp_path / "b", *messages), Choice()) as recording:
        assert [row.contacts is not None and len(row.contacts) for row in recording.rows()] == [0, 1, 1, 1]
        assert recording.notes() == []


@pytest.mark.parametrize("name", ["insole", "glove"])
def test_contacts_of_another_layout_than_that_of_the_images_are_left_out_and_told(name: str, tmp_path: Path) -> None:
    skin = layout(name, 32, 32)
    patch = skin.patches[-1]
    row, col = (patch.first_row + patch.end_row) // 2, (patch.first_col + patch.end_col) // 2
    picture = np.zeros((skin.rows, skin.cols), np.uint16)
    picture[row - 1 : row + 2, col - 1 : col + 2] = 600
    matrix = picture.ravel()[skin.places].reshape(32, 32)
    path = write_bag(
        tmp_path / "b",
        *(
            message
            for n in range(3)
            for message in (("/plate/samples", samples(n, matrix)), ("/plate/image_raw", image(n, picture)))
        ),
    )
    with open_recording(path, Choice(layout=name)) as recording:
        assert [row.contacts is not None and len(row.contacts) for row in recording.rows()] == [1, 1, 1]
        assert recording.notes() == []
    with open_recording(path, Choice()) as recording:
        assert [row.contact is None and row.contacts is None for row in recording.rows()] == [True] * 3
        (note,) = recording.notes()
    assert "with the layout square /plate/samples does not give the images of /plate/image_raw" in note


@pytest.mark.parametrize("has_images", [False, True])
def test_contacts_on_taxels_of_another_size_are_left_out_and_told(has_images: bool, tmp_path: Path) -> None:
    """As of a skin with a pitch of its own, whose layout is not given."""
    file = tmp_path / "fine.yaml"
    file.write_text("pitch_m: 0.003\npatches: {pad: {wires: {down: rows, across: cols}}}\n")
    messages: list[tuple[str, Any]] = []
    for n in range(3):
        pressing = contact(n, 2.0)
        pressing.area = float(np.float32((n + 9) * 0.003**2))
        messages += [("/plate/samples", samples(n, pressed(0))), ("/plate/contact", pressing)]
        messages += [("/plate/image_raw", image(n, pressed(0)))] if has_images else []
    path = write_bag(tmp_path / "b", *messages)
    with open_recording(path, Choice(layout=str(file))) as recording:
        assert [row.contacts is not None and len(row.contacts) for row in recording.rows()] == [1, 1, 1]
        assert recording.notes() == []
    with open_recording(path, Choice()) as recording:
        assert [row.contacts is None for row in recording.rows()] == [True] * 3
        (note,) = recording.notes()
    assert "not of taxels of 4.375 x 4.375 mm, those of the layout square; export it with --layout NAME" in note
