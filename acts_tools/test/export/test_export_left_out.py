# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch of a bag as tables: what is left out is told, and what nobody can mean is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from test_export import SIDE, contact, contacts, header, image, joints, pressed, rows_of, samples, write_bag

from acts_core.errors import ArrayError, RecordingError
from acts_core.skin import layout
from acts_tools.cli import main
from acts_tools.export.recording import open_recording
from acts_tools.export.topics import Choice

MAKE: dict[str, Callable[..., Any]] = {"image_raw": image, "samples": samples}


def test_frames_that_do_not_fit_are_left_out_and_told(tmp_path: Path) -> None:
    """The node reconstruction leaves them out, too."""
    beyond, small = samples(20, pressed(2)), samples(30, np.zeros((8, 8), np.uint16))
    beyond.indices[5] = 2000
    path = write_bag(
        tmp_path / "b",
        *(("/plate/samples", one) for one in (samples(10, pressed(1)), beyond, small, samples(40, pressed(4)))),
    )
    with open_recording(path, Choice()) as recording:
        assert [round(row.time_s * 1e3) for row in recording.rows()] == [0, 30]
        (note,) = recording.notes()
    assert note.startswith("2 frames left out, of which the first is message 1 of /plate/samples in ")
    assert "2000" in note


def test_joint_states_that_name_a_joint_twice_are_told(tmp_path: Path) -> None:
    twice = JointState(header=header(5), name=["knee", "hip", "knee"], position=[0.5, 1.0, 2.0])
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20)),
        ("/joint_states", twice),
        ("/joint_states", joints(15, knee=3.0)),
    )
    with open_recording(path, Choice()) as recording:
        assert [row.joints is not None and row.joints.tolist() for row in recording.rows()] == [[2.0, 1.0], [3.0, 1.0]]
        (note,) = recording.notes()
    assert note == "/joint_states: 1 joint state names a joint twice; what is said of it last is exported"


def test_joint_states_that_do_not_fit_their_names_are_told(tmp_path: Path) -> None:
    unfit = JointState(header=header(5), name=["knee", "hip"], position=[0.5])
    half = JointState(header=header(6), name=["knee"], position=[0.5], effort=[1.0, 2.0])
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20)),
        ("/arm", unfit),
        ("/leg", unfit),
        ("/leg", half),
        ("/still", joints(7, knee=0.5)),
    )
    with open_recording(path, Choice(joints="/leg")) as recording:
        assert [row.joints is not None and row.joints.tolist() for row in recording.rows()] == [[0.5], [0.5]]
        assert recording.joint_columns == ("knee.position",)
        (note,) = recording.notes()
    assert note == "/leg: 2 joint states have not as many numbers as names; such numbers are left out"
    with open_recording(path, Choice(joints="/still")) as recording:
        assert recording.notes() == []
    with pytest.raises(RecordingError, match="has no joint states to export on /arm: /arm: 1 joint state has not"):
        rows_of(path, joints="/arm")


@pytest.mark.parametrize("name", ["arm/joint_states", "/arm/joint_states", "/arm/joint_states/"])
def test_a_topic_of_joint_states_is_known_with_and_without_a_slash(name: str, tmp_path: Path) -> None:
    path = write_bag(
        tmp_path / "b",
        ("/plate/image_raw", image(10, pressed(0))),
        *((f"/{who}/joint_states", joints(5, **{who: 0.5})) for who in ("arm", "leg")),
    )
    with open_recording(path, Choice(joints=name)) as recording:
        assert recording.joint_columns == ("arm.position",)
    with pytest.raises(RecordingError, match="has no joint states on /hip; it has /arm/joint_states, /leg"):
        rows_of(path, joints="hip")


def test_joint_states_that_nobody_asked_for_are_told_when_they_are_left_out(tmp_path: Path) -> None:
    path = write_bag(
        tmp_path / "b",
        ("/plate/image_raw", image(10, pressed(0))),
        ("/arm", JointState(header=header(5), name=["knee", "hip"], position=[0.5])),
    )
    with open_recording(path, Choice()) as recording:
        assert [row.joints for row in recording.rows()] == [None]
        assert recording.notes() == ["/arm: 1 joint state has not as many numbers as names; such numbers are left out"]


def recorded(path: Path, *, contacts_too: bool) -> Path:
    """Images and samples of three frames, and perhaps their contacts."""
    messages = [(f"/plate/{name}", make(n, pressed(n))) for n in range(3) for name, make in MAKE.items()]
    if contacts_too:
        messages += [("/plate/contact", contact(0, 1.0)), ("/plate/contacts", contacts(0, 1))]
    return write_bag(path, *messages)


def test_a_layout_that_is_of_no_use_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, others = recorded(tmp_path / "b", contacts_too=True), recorded(tmp_path / "c", contacts_too=False)
    words = ["export", str(path), "--to", "csv", "-o", str(tmp_path / "out"), "--layout"]
    assert main([*words, "arm"]) == 1
    assert "--layout arm is of no use: it is for what is recovered from samples" in capsys.readouterr().err
    assert main([*words, "square"]) == 0
    assert main(["export", str(others), *words[2:5], str(tmp_path / "more"), "--layout", "arm"]) == 0


def test_dead_taxels_are_estimated_in_what_is_recovered(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = pressed(2)
    broken[10] = 0
    path = write_bag(tmp_path / "b", *(("/plate/samples", samples(20 * n, broken)) for n in range(3)))
    assert [row.image[10, 10] for row in rows_of(path)[0]] == [0, 0, 0]
    for row in rows_of(path, dead_taxels="row=10")[0]:
        np.testing.assert_array_equal(np.delete(row.image, 10, axis=0), np.delete(broken, 10, axis=0))
        assert row.image[10, 10] == pytest.approx(pressed(2)[10, 10], rel=0.1)
    with pytest.raises(RecordingError, match="dead_taxels: 'row=99' is outside of an array"):
        rows_of(path, dead_taxels="row=99")
    whole = recorded(tmp_path / "c", contacts_too=True)
    words = ["export", str(whole), "--to", "csv", "-o", str(tmp_path / "out"), "--dead-taxels", "row=10 3,4"]
    assert main(words) == 1
    assert "--dead-taxels 'row=10 3,4' is of no use: it is for what is recovered" in capsys.readouterr().err


def test_with_dead_taxels_too_contacts_of_another_layout_are_left_out(tmp_path: Path) -> None:
    glove = layout("glove", SIDE, SIDE)
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(10 * n, glove.picture(pressed(n)).astype(np.uint16))) for n in range(3)),
        *(("/plate/samples", samples(10 * n, pressed(n))) for n in range(3)),
    )
    with open_recording(path, Choice(dead_taxels="row=10 3,4")) as recording:
        assert not any(row.contacts is not None and len(row.contacts) for row in recording.rows())
        (note,) = recording.notes()
    assert "with the layout square /plate/samples does not give the images of /plate/image_raw" in note
    with open_recording(path, Choice(dead_taxels="row=10 3,4", layout="glove")) as recording:
        assert all(row.contacts is not None and len(row.contacts) for row in recording.rows())
        assert recording.notes() == []


def test_a_layout_that_there_is_not_is_refused(tmp_path: Path) -> None:
    path = recorded(tmp_path / "b", contacts_too=True)
    with pytest.raises(ArrayError, match="layout 'sqare': allowed is one of"):
        rows_of(path, layout="sqare")


def test_a_refused_export_leaves_no_folders(tmp_path: Path) -> None:
    """Neither of a bag that there is not, nor of one that turns out to have nothing to export."""
    path = write_bag(tmp_path / "b", ("/plate/image_raw", image(0, pressed(0))), ("/joint_states", joints(9, knee=0.5)))
    (tmp_path / "kept").mkdir()
    for bag in (tmp_path / "nothing", path):
        for folder in ("new", "kept"):
            assert main(["export", str(bag), "--to", "csv", "-o", str(tmp_path / folder / "more/out")]) == 1
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["b", "kept"]
    assert not list((tmp_path / "kept").iterdir())
    words = ["export", str(path), "--to", "csv", "--joints", "none", "-o", str(tmp_path / "new/more/out")]
    assert main(words) == 0
    assert (tmp_path / "new/more/out/frames.csv").exists()


def test_a_bag_in_which_no_frame_fits_is_refused(tmp_path: Path) -> None:
    beyond = samples(20, pressed(2))
    beyond.indices[5] = 2000
    path = write_bag(tmp_path / "b", ("/plate/samples", beyond))
    with pytest.raises(RecordingError, match=r"message 0 of /plate/samples in .*2000"):
        rows_of(path)


@pytest.mark.parametrize("topic", sorted(MAKE))
def test_a_stamp_far_ahead_is_told_with_how_far_and_of_what(topic: str, tmp_path: Path) -> None:
    far_ms = 1000 * 40 * 86_400
    path = write_bag(
        tmp_path / "b",
        *((f"/plate/{topic}", MAKE[topic](t, pressed(0))) for t in (10, 20, far_ms, 30, 40)),
        *(("/plate/contact", contact(t, 1.0)) for t in (10, far_ms, 30)),
        *(("/joint_states", joints(t, knee=0.5)) for t in (10, far_ms, 20, 30, 40)),
    )
    with open_recording(path, Choice()) as recording:
        assert len(list(recording.rows())) == 3
        assert recording.notes()[:3] == [
            f"{which} left out, not newer than one before ({of}up to 3455999 s ahead): was a clock set?"
            for which, of in (
                ("2 frames", f"of /plate/{topic}, "),
                ("1 message of /plate/contact", ""),
                ("3 messages of /joint_states", ""),
            )
        ]


def test_frames_long_before_all_else_are_refused_with_how_long(tmp_path: Path) -> None:
    path = write_bag(
        tmp_path / "b",
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20)),
        ("/plate/contact", contact(90_020, 1.0)),
    )
    with pytest.raises(RecordingError, match=r"all 2 frames are from before the first .*, the last 90\.000 s before;"):
        rows_of(path)
