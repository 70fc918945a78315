# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings in place of a board: what comes out, and files that are none. ROS_DOMAIN_ID 34."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driver_rig import Rig
from pty_board import frame
from recorded import DEFINITION, write_bag
from rosbags.rosbag2 import StoragePlugin
from waiting import wait_for

from acts_core.errors import RecordingError, SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_core.skin import layout
from acts_driver.replay import ReplayOptions, ReplaySource, open_recording
from acts_driver.replay.recordings import RecordedSamples
from acts_driver.settings import DriverSettings

pytestmark = pytest.mark.slow

MS = 1_000_000
START_NS = 1_600_000_000 * 1_000_000_000


def write_samples(path: Path, frames: list[SampleFrame], **others: object) -> Path:
    content: dict[str, Any] = {
        "indices": np.array([one.indices for one in frames]),
        "counts": np.array([one.counts for one in frames]),
        "sequence": [one.sequence for one in frames],
        "stamp_ns": [START_NS + one.board_us * 1000 for one in frames],
        "scheme": "adaptive",
        "duration_us": frames[0].duration_us,
        **others,
    }
    np.savez(path, **{name: value for name, value in content.items() if value is not None})
    return path


def same(first: SampleFrame, second: SampleFrame) -> bool:
    alike = all(
        getattr(first, name) == getattr(second, name) for name in ("scheme", "rows", "cols", "duration_us", "sequence")
    )
    return alike and (first.indices == second.indices).all() and bool((first.counts == second.counts).all())


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(34)
    yield rig
    rig.close()


@pytest.mark.parametrize("kind", ["npz", "bag", "mcap", "db3"])
def test_recorded_samples_come_back_as_they_were(kind: str, tmp_path: Path) -> None:
    sent = [frame(k, m=7) for k in (0, 1, 2, 5, 6)]
    if kind == "npz":
        path = write_samples(tmp_path / "samples.npz", sent)
    else:
        stamped = [(one, START_NS + one.board_us * 1000) for one in sent]
        plugin = StoragePlugin.SQLITE3 if kind == "db3" else StoragePlugin.MCAP
        path = write_bag(tmp_path / "bag", {"/plate/samples": stamped}, plugin=plugin)
        if kind != "bag":
            (path,) = path.glob(f"*.{kind}")
    recording = open_recording(ReplayOptions(path))
    for _ in range(2):
        found = list(recording.frames())
        assert len(found) == len(sent)
        assert all(map(same, found, sent))
        assert np.diff([one.board_us for one in found]).tolist() == [1000, 1000, 3000, 1000]


def test_full_frames_are_sampled_as_the_board_would(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    frames = random.integers(0, 1024, (3, 8, 6)).astype(np.uint16)
    np.savez(tmp_path / "frames.npz", frames=frames, rate_hz=100.0)
    sampling = SamplingConfig(scheme="tracking", rows=8, cols=6, m=12, threshold_counts=500)
    parameters = DriverSettings(scheme="tracking", m=12, threshold_counts=500)
    found = list(open_recording(ReplayOptions(tmp_path / "frames.npz", sampling=parameters.sampling)).frames())
    # 30 ms at 1 kHz; the skin changes in a straight line from frame to frame and is held at the end.
    assert len(found) == 30
    sampler = Sampler(sampling)
    for number, one in enumerate(found):
        assert (one.sequence, one.scheme, one.rows, one.cols) == (number, Scheme.TRACKING, 8, 6)
        at = min((number * 1e-3 + 12 * 17.877e-6) * 100, 2)
        before = min(int(at), 1)
        skin = np.rint(frames[before] + (at - before) * (frames[before + 1].astype(float) - frames[before]))
        indices, counts = sampler.frame(measure_in(skin.astype(int)))
        np.testing.assert_array_equal(one.indices, indices)
        np.testing.assert_array_equal(one.counts, counts)
    assert {b.board_us - a.board_us for a, b in itertools.pairwise(found)} == {1000}


def test_full_frames_are_sampled_on_the_skin_that_they_are_of(tmp_path: Path) -> None:
    insole = layout("insole")
    picture = np.zeros((64, 16), np.uint16)
    picture[10:16, 4:10] = 700
    np.savez(tmp_path / "frames.npz", frames=insole.matrix(picture)[None].repeat(3, axis=0), rate_hz=100.0)
    parameters = DriverSettings(scheme="adaptive", m=120, threshold_counts=60, layout="insole")
    options = ReplayOptions(tmp_path / "frames.npz", sampling=parameters.sampling, skin_map=parameters.skin_map)
    first = next(open_recording(options).frames())
    # In the matrix the first 255 taxels of the search are all of the other half.
    assert set(np.flatnonzero(picture)) <= set(insole.places[first.indices].tolist())


def test_the_rate_of_full_frames_and_of_sampling_can_be_given(tmp_path: Path) -> None:
    np.savez(tmp_path / "frames.npz", frames=np.zeros((4, 8, 6), np.uint16))
    with pytest.raises(RecordingError, match=r"rate_hz is missing.*export the bag again with --rate 100; for a driver"):
        open_recording(ReplayOptions(tmp_path / "frames.npz"))
    slow = DriverSettings(scheme="raster").sampling
    found = list(open_recording(ReplayOptions(tmp_path / "frames.npz", "", 40.0, slow, 200.0)).frames())
    assert len(found) == 20
    assert all(len(one.indices) == 48 for one in found)
    # A frame takes the time of its measurements at least.
    whole = SamplingConfig(scheme="raster", rows=8, cols=6)
    fast = list(open_recording(ReplayOptions(tmp_path / "frames.npz", "", 40.0, lambda *_: whole, 1e6)).frames())
    assert fast[1].board_us - fast[0].board_us == pytest.approx(48 * 17.877, abs=1)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"counts": np.zeros((2, 3), int)}, "needed is"),
        ({"counts": np.full((2, 5), 1024)}, "between 0 and 1023"),
        ({"indices": np.zeros((2, 5), int)}, "none twice"),
        ({"indices": np.arange(10).reshape(2, 5) + 1020}, "taxels of 32 x 32"),
        ({"indices": np.zeros((2, 5))}, "whole numbers"),
        ({"rows": 65}, "rows = 65"),
        ({"scheme": "morse"}, "scheme morse"),
        ({"scheme": 99}, "scheme 99"),
        ({"scheme": ["raster", "raster"]}, r"scheme an array of shape \(2,\): needed"),
        ({"duration_us": np.full(2000, 5)}, r"duration_us = an array of shape \(2000,\): needed is a whole number"),
        ({"sequence": [1]}, "2 whole numbers"),
        ({"stamp_ns": [5, 4]}, "ascending"),
        ({"stamp_ns": None}, "stamp_ns .* or rate_hz"),
        ({"stamp_ns": None, "rate_hz": -1.0}, "stamp_ns .* or rate_hz"),
        ({"stamp_ns": None, "rate_hz": 5e-324}, r"allowed are 0\.001 to 1e\+06"),
        ({"indices": None}, "frames"),
    ],
)
def test_samples_that_do_not_fit_together(changes: dict[str, object], words: str, tmp_path: Path) -> None:
    path = write_samples(tmp_path / "samples.npz", [frame(0), frame(1)], **changes)
    with pytest.raises(RecordingError, match=words) as caught:
        open_recording(ReplayOptions(path))
    assert "samples.npz" in str(caught.value)


@pytest.mark.parametrize("first", [np.uint64(2**63), np.int64(-(2**63)), np.uint64(2**64 - 5_001), np.int16(-30000)])
def test_stamps_of_any_whole_type_are_taken(first: np.integer, tmp_path: Path) -> None:
    stamps = np.array([first, first + first.dtype.type(5_000)])
    path = write_samples(tmp_path / "samples.npz", [frame(0), frame(1)], stamp_ns=stamps)
    assert [one.board_us for one in open_recording(ReplayOptions(path)).frames()] == [0, 5]


def test_samples_of_one_taxel_are_replayed(tmp_path: Path) -> None:
    again = np.full((2, 5), 7)
    path = write_samples(tmp_path / "samples.npz", [frame(0), frame(1)], indices=again, scheme="fixed")
    found = list(open_recording(ReplayOptions(path)).frames())
    assert [one.indices.tolist() for one in found] == again.tolist()
    assert {one.scheme for one in found} == {Scheme.FIXED}


def test_a_closed_replay_holds_no_file(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "bag", {"/plate/samples": [(frame(k), START_NS + k * MS) for k in range(3)]})
    source = ReplaySource("bag", lambda: open_recording(ReplayOptions(path)))

    def held() -> list[str]:
        links = [link for link in Path("/proc/self/fd").iterdir() if link.is_symlink()]
        return [str(link.readlink()) for link in links if str(tmp_path) in str(link.readlink())]

    wait_for(lambda: is_open(source), "the bag to be read")
    assert held()
    source.close()
    assert held() == []


def test_what_is_wrong_with_a_bag_is_told_of_a_source_that_replays_it_all_the_same(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "bag", {"/plate/samples": [(frame(k), START_NS + k * MS) for k in range(3)]})
    source = ReplaySource("bag", lambda: open_recording(ReplayOptions(path)))
    wait_for(lambda: is_open(source), "the bag to be read")
    assert source.note == ""
    (path / "metadata.yaml").unlink()
    wait_for(lambda: is_open(source), "the bag to be read")
    assert "was never closed" in source.note
    source.close()


def test_a_recording_in_the_home_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    write_samples(tmp_path / "samples.npz", [frame(0), frame(1)])
    found = open_recording(ReplayOptions(Path("~/samples.npz"))).frames()
    assert [one.sequence for one in found] == [0, 1]
    with pytest.raises(RecordingError, match="~nobody-of-this-name"):
        open_recording(ReplayOptions(Path("~nobody-of-this-name/samples.npz")))


def test_files_that_are_no_recordings(tmp_path: Path) -> None:
    def refused(path: Path, words: str, topic: str = "") -> None:
        with pytest.raises(RecordingError, match=words):
            open_recording(ReplayOptions(path, topic))

    refused(tmp_path / "no.npz", "there is no recording .*no.npz")
    refused(tmp_path / ("a" * 300), "cannot be read .*too long")
    (tmp_path / "circle.npz").symlink_to("circle.npz")
    refused(tmp_path / "circle.npz", "circle.npz: cannot be read .*symbolic links")
    (tmp_path / "text.npz").write_text("nothing")
    refused(tmp_path / "text.npz", "not an npz file")
    (tmp_path / "text.txt").write_text("nothing")
    refused(tmp_path / "text.txt", r"needed is a bag \(folder, \.mcap or \.db3\), or an \.npz file")
    (tmp_path / "empty").mkdir()
    refused(tmp_path / "empty", "no bag that can be read")
    one = [(frame(0), START_NS)]
    two = write_bag(tmp_path / "two", {"/left/samples": one, "/right/samples": one})
    refused(two, "has /left/samples, /right/samples .*say which .*parameter replay_topic")
    refused(two, "has no topic /middle", topic="/middle")
    assert len(list(open_recording(ReplayOptions(two, "/right/samples")).frames())) == 1
    other = DEFINITION.replace("uint16[] indices", "uint32[] indices")
    refused(
        write_bag(tmp_path / "other", {"/plate/samples": one}, other),
        "the bag '.*other': .*recorded with another definition of",
    )
    refused(write_bag(tmp_path / "silent", {"/plate/samples": []}), "no messages on /plate/samples")
    np.savez(tmp_path / "big.npz", frames=np.zeros((1, 65, 2), np.uint16), rate_hz=1.0)
    refused(tmp_path / "big.npz", "65 x 2")
    np.savez(tmp_path / "slow.npz", frames=np.zeros((1, 8, 8), np.uint16), rate_hz=5e-324)
    refused(tmp_path / "slow.npz", r"e-324 frames per second; allowed are 0\.001 to 1e\+06")
    np.savez(tmp_path / "later.npz", frames=np.zeros((1, 8, 8), np.uint16), rate_hz=1.0)
    # The version of the zip format, in the list of contents, is one that nobody has yet.
    later = bytearray((tmp_path / "later.npz").read_bytes())
    later[later.index(b"PK\1\2") + 6] = 0xFF
    (tmp_path / "later.npz").write_bytes(later)
    refused(tmp_path / "later.npz", "later.npz: a damaged npz file")
    (tmp_path / "text.mcap").write_text("no bag")
    refused(tmp_path / "text.mcap", "text.mcap: not an MCAP file")
    np.savez(tmp_path / "small.npz", frames=np.zeros((1, 2, 2), np.uint16), rate_hz=1.0)
    with pytest.raises(SettingsError, match="m = 55"):
        open_recording(ReplayOptions(tmp_path / "small.npz"))


def test_nodes_cannot_tell(rig: Rig, tmp_path: Path) -> None:
    sent = [frame(k, m=55, board_us=1000 * k) for k in range(100)]
    path = write_samples(tmp_path / "samples.npz", sent)
    rig.start_driver(replay=path, replay_delay_s=0.0, replay_loop=False, autostart=False)
    rig.wait_for_match()
    assert rig.driver is not None
    rig.driver.trigger_configure()
    rig.driver.trigger_activate()
    rig.spin_until(lambda: len(rig.samples) == 100, "all messages")
    for message, one in zip(rig.samples, sent, strict=True):
        assert (message.sequence, message.scheme, message.header.frame_id) == (one.sequence, 3, "plate")
        np.testing.assert_array_equal(message.indices, one.indices)
        np.testing.assert_array_equal(message.counts, one.counts)
    status = rig.status_until(lambda status: "has ended" in status["message"], "the report of the end")
    assert (status["level"], status["frames"], status["lost"], status["malformed"]) == ("2", "100", "0", "0")
    assert status["port"] == f"recording {path}"


def test_a_missing_recording_is_reported_and_waited_for(rig: Rig, tmp_path: Path) -> None:
    path = tmp_path / "later.npz"
    rig.start_driver(replay=path, replay_delay_s=0.0, reconnect_s=0.05)
    status = rig.status_until(lambda status: status["level"] == "2", "the report")
    assert "there is no recording" in status["message"]
    write_samples(tmp_path / "new.npz", [frame(0), frame(1)]).rename(path)
    rig.spin_until(lambda: len(rig.samples) > 3, "messages")


def test_a_recording_of_another_size_is_told_with_the_size_to_set(
    rig: Rig, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = write_samples(tmp_path / "small.npz", [frame(k, rows=16, cols=24) for k in range(10)], rows=16, cols=24)
    rig.start_driver(replay=path, replay_delay_s=0.0)
    rig.status_until(lambda status: int(status.get("wrong_size", "0")) > 0, "the counts")
    log = capfd.readouterr().err
    assert f"recording {path} has frames of 16 x 24 taxels, expected are 32 x 32; they are dropped: set" in log
    assert "set the parameters rows and cols to 16 and 24 (of a launch: rows:=16 cols:=24)" in log
    assert "simulated board" not in log


def test_parameters_of_a_recording_are_told_where_none_is_replayed() -> None:
    assert DriverSettings(replay_speed=2.0, replay_loop=False).unused == ("replay_speed", "replay_loop")
    assert DriverSettings(replay="touch", replay_speed=2.0).unused == ()
    assert DriverSettings(replay="none").unused == ()


def test_defaults_of_an_npz_file(tmp_path: Path) -> None:
    np.savez(tmp_path / "s.npz", indices=[[3, 1]], counts=[[5, 6]], rate_hz=50, rows=2, cols=2)
    (found,) = RecordedSamples.load(tmp_path / "s.npz").frames()
    assert (found.sequence, found.board_us, found.scheme, found.duration_us) == (0, 0, Scheme.UNKNOWN, 36)


def is_open(source: ReplaySource) -> bool:
    """Open it; False where a busy machine is still reading the bag, so that the next attempt may find it read."""
    try:
        source.open()
    except RecordingError as error:
        if "is still being read" not in str(error):
            raise
        return False
    return True
