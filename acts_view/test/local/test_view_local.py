# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A recording or a board shown without a graph: what is played when, and what the page is told of it."""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from view_messages import decode
from view_recorded import COL, DEADLINE_S, ROW, Counted, Played, Shown, write_bag, write_frames
from waiting import wait_for

from acts_core.errors import SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_driver.replay import ReplayOptions, open_recording
from acts_driver.settings import DriverSettings
from acts_msgs.msg import TactileSamples
from acts_recon.settings import ReconstructionSettings
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter
from acts_view.local import playback as playback_module
from acts_view.local.local_skin import LocalSkin
from acts_view.local.playback import Playback, PlaybackState
from acts_view.local.sources import BoardSource, RecordedSource, open_recorded

pytestmark = pytest.mark.slow

SIDE = 8


@pytest.fixture
def played() -> Iterator[Played]:
    made = Played(Counted())
    made.began_s = time.monotonic()
    made.playback.start()
    yield made
    made.playback.stop()


def test_a_recording_is_played_whole_at_its_pace_over_its_gaps_and_then_again(played: Played) -> None:
    wait_for(lambda: not played.playback.state.is_playing)
    assert time.monotonic() - played.began_s > 1.49
    assert played.numbers == list(range(1000))
    assert played.playback.state.position_s == pytest.approx(1.499)
    played.playback.play()
    wait_for(lambda: len(played.numbers) > 1003)
    assert played.numbers[1000:1003] == [0, 1, 2]
    assert played.jumps == [0, 1000]


def test_a_held_recording_shows_where_one_goes_and_goes_on_from_there(played: Played) -> None:
    playback = played.playback
    wait_for(lambda: bool(played.numbers))
    playback.pause()
    wait_for(lambda: not playback.state.is_playing)
    playback.seek(1.2)
    wait_for(lambda: played.numbers[-1] == 700)
    assert playback.state.position_s == pytest.approx(1.2)
    seen = len(played.numbers)
    playback.play()
    wait_for(lambda: len(played.numbers) > seen)
    assert played.numbers[seen] == 701
    playback.seek(1e9)
    wait_for(lambda: not playback.state.is_playing)
    playback.seek(-5.0)
    wait_for(lambda: played.numbers[-1] == 0)


class ClockSet(Counted):
    """The same, but the clock of the frames is set when it is half over."""

    def __init__(self, by_s: int) -> None:
        self._by_us = 1_000_000 * by_s

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        for one in super().frames(from_us):
            yield one._replace(board_us=one.board_us + (self._by_us if one.sequence >= 500 else 0))


@pytest.mark.parametrize("by_s", [3600, -3600, -3])
def test_a_recording_is_played_and_sought_beyond_a_time_at_which_its_clock_was_set(by_s: int) -> None:
    played = Played(ClockSet(by_s))
    playback = played.playback
    playback.start()
    try:
        wait_for(lambda: not playback.state.is_playing)
        assert played.numbers == list(range(1000))
        # It is held at its end. How long the step was at which the clock was set nobody knows.
        for time_s, number in ((1.2, 700), (0.05, 50), (1.4, 900)):
            playback.seek(time_s)
            wait_for(lambda number=number: number <= played.numbers[-1] <= number + 1)  # type: ignore[misc]
        playback.play()
        wait_for(lambda: not playback.state.is_playing)
        assert played.numbers[-98:] == list(range(902, 1000))
    finally:
        playback.stop()


class SetBack:
    """A minute at 100 Hz; the clock of the frames is set back by 20 s after 40 s, that of the recording is not."""

    length_us = 59_990_000

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        empty = np.zeros(1, np.uint16)
        for number in range(from_us // 10_000, 6000):
            board_us = 10_000 * number - (20_000_000 if number >= 4000 else 0)
            yield SampleFrame(number, 30_000_000 + board_us, 0, Scheme.RASTER, 32, 32, 0, empty, empty)


def test_a_time_before_the_clock_was_set_is_sought_after_one_behind_that() -> None:
    """Frames were taken for later by as much as the clock was set: one was shown, and then none for so long."""
    numbers: list[int] = []
    playback = Playback(SetBack(), lambda frames: numbers.extend(one.sequence for one in frames), lambda: None)
    playback.start()
    try:
        wait_for(lambda: bool(numbers))
        playback.pause()
        for time_s in (50.0, 10.0, 55.0, 30.0):
            playback.seek(time_s)
            wait_for(lambda time_s=time_s: numbers and numbers[-1] == round(100 * time_s))  # type: ignore[misc]
    finally:
        playback.stop()


def test_a_recording_that_is_read_slower_than_it_plays_is_shown_as_it_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    slow_us = 4000.0
    read_us = itertools.count(step=slow_us)
    late_us = 0.0

    class Slow(Counted):
        """Each frame, of a millisecond, takes four to read."""

        def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
            nonlocal late_us
            for one in super().frames(from_us):
                late_us = next(read_us)
                yield one

    handed_on: list[tuple[float, list[int]]] = []
    now_us = playback_module._now_us
    monkeypatch.setattr(playback_module, "_now_us", lambda: now_us() + late_us)
    playback = Playback(
        Slow(), lambda frames: handed_on.append((late_us, [one.sequence for one in frames])), lambda: None
    )
    playback.start()
    wait_for(lambda: not playback.state.is_playing)
    playback.stop()
    assert [number for _, numbers in handed_on for number in numbers] == list(range(1000))
    # Never without a picture for as long as half a second, of the four that it takes.
    times_us = [time_us for time_us, _ in handed_on]
    assert max(np.diff(times_us)) < 500_000


def test_a_bag_whose_recorder_was_killed_is_shown_and_said_to_be_one(tmp_path: Path) -> None:
    bag, kind = BagWriter(tmp_path / "bag"), "acts_msgs/msg/TactileSamples"
    topic = bag.add_topic("/plate/samples", kind, *Definitions().describe(kind), [])
    for number in range(3):
        message = TactileSamples(rows=32, cols=32, sequence=number, indices=[5], counts=[600])
        message.header.stamp.sec = 1 + number
        bag.write(topic, serialize_message(message))
    bag.flush()
    source, name = open_recorded(tmp_path / "bag", [], "square")
    assert name == "/plate"
    source.start(lambda: None)
    (diagnosis,) = source.status()["diagnostics"]
    source.stop()
    assert diagnosis["level"] == 1
    assert "was never closed" in diagnosis["message"]
    bag.close()


def highest_at(source: RecordedSource, time_s: float) -> int:
    """The largest count of the image there, played on this thread."""
    source.skin.reset()
    source._take(list(itertools.islice(source.recording.frames(), round(time_s - 9))))
    taken = source.skin.newest()
    assert taken is not None
    assert taken[0].image is not None
    return int(taken[0].image.max())


def test_the_baseline_of_a_bag_is_subtracted_as_it_was_at_the_time(tmp_path: Path) -> None:
    # The first is that of before the recording; from 13 s on half of it is left.
    path = write_bag(tmp_path / "bag", {5: [300] * 16, 13: [150] * 16})
    source, _ = open_recorded(path, [], "square")
    assert highest_at(source, 12) < 30
    assert highest_at(source, 14) == pytest.approx(150, abs=30)
    assert highest_at(source, 11) < 30


@pytest.mark.parametrize("namespaces", [[], ["/"]])
def test_a_skin_in_the_root_namespace_of_a_bag_is_shown_without_its_baseline(
    tmp_path: Path, namespaces: list[str]
) -> None:
    path = write_bag(tmp_path / "bag", {5: [300] * 16}, skin="")
    source, name = open_recorded(path, namespaces, "square")
    assert name == "/bag"
    assert highest_at(source, 12) < 30


def test_a_bag_counts_from_its_first_frame(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The baseline 30 s before the first of five frames, by the recorder's clock.
    stamps_s = iter([1000, *range(1030, 1035)])
    monkeypatch.setattr(BagWriter, "_stamp_ns", lambda _: next(stamps_s) * 10**9)
    recording = open_recording(ReplayOptions(write_bag(tmp_path / "bag", {5: [300] * 16})))
    assert recording.length_us == 4_000_000
    assert [frame.sequence for frame in recording.frames(2_000_000)] == [12, 13, 14]


def test_a_bag_without_a_baseline_is_shown_as_it_was_measured(tmp_path: Path) -> None:
    source, _ = open_recorded(write_bag(tmp_path / "bag", {}), [], "square")
    assert highest_at(source, 14) == pytest.approx(300, abs=30)


def test_a_baseline_that_does_not_fit_is_told(tmp_path: Path) -> None:
    source, _ = open_recorded(write_bag(tmp_path / "bag", {5: [300] * 8}), [], "square")
    assert highest_at(source, 14) == pytest.approx(300, abs=30)
    source.start(lambda: None)
    (diagnosis,) = source.status()["diagnostics"]
    source.stop()
    assert diagnosis["level"] == 1
    assert "/plate/baseline could be read: a baseline of 2 x 4" in diagnosis["message"]


@pytest.mark.parametrize("kind", ["full frames", "samples"])
def test_a_recording_is_gone_through_from_any_time(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "one.npz"
    if kind == "full frames":
        write_frames(path)
    else:
        shape = (2000, 3)
        np.savez(path, indices=np.tile(np.arange(3), (2000, 1)), counts=np.ones(shape, int), rate_hz=1000.0)
    recording = open_recording(ReplayOptions(path))
    whole = [one.board_us for one in recording.frames()]
    assert recording.length_us == whole[-1] - whole[0]
    part = next(recording.frames(1_500_000)).board_us - whole[0]
    assert 0 <= part - 1_500_000 <= 1000
    assert next(recording.frames(recording.length_us + 5000), None) is None


def test_touch_is_recovered_as_by_the_node(tmp_path: Path) -> None:
    source, name = open_recorded(write_frames(tmp_path / "press.npz"), [], "square", with_outlines=True)
    assert name == "/press"
    skin = source.skin
    skin.take([(one, 1000 * one.board_us) for one in itertools.islice(source.recording.frames(), 60)], None)
    taken = skin.newest()
    assert taken is not None
    frame, samples = taken
    assert len(samples) == 60
    assert frame.image is not None
    row, col = np.unravel_index(frame.image.argmax(), frame.image.shape)
    assert (int(row), int(col)) in itertools.product(range(ROW - 1, ROW + 2), range(COL - 1, COL + 2))
    assert len(frame.contacts) == 1
    np.testing.assert_allclose(frame.contacts[0, :2], [(COL - 15.5) * 0.004375, (15.5 - ROW) * 0.004375], atol=0.003)
    (outline,) = frame.outlines
    np.testing.assert_allclose(outline.mean(axis=0), frame.contacts[0, :2], atol=0.003)
    assert skin.newest() is None


def test_dead_taxels_are_estimated(tmp_path: Path) -> None:
    source, _ = open_recorded(write_frames(tmp_path / "press.npz"), [], "square", dead_taxels=f"{ROW},{COL}")
    source.skin.take([(one, 1000 * one.board_us) for one in itertools.islice(source.recording.frames(), 60)], None)
    taken = source.skin.newest()
    assert taken is not None
    frame, _ = taken
    assert frame.image is not None
    assert frame.age_s is not None
    assert frame.image[ROW, COL] > 0
    assert np.argwhere(np.isinf(frame.age_s)).tolist() == [[ROW, COL]]
    with pytest.raises(SettingsError, match="dead_taxels: 'row=32' is outside of an array of 32 x 32"):
        open_recorded(tmp_path / "press.npz", [], "square", dead_taxels="row=32")


def test_an_error_in_a_recording_stays_one_where_frames_were_left_out_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source, _ = open_recorded(write_frames(tmp_path / "press.npz"), [], "square")
    monkeypatch.setattr(Playback, "state", PlaybackState(1.0, 2.0, is_playing=False, problem="message 9 is damaged"))
    source.start(lambda: None)
    source.stop()
    source.skin.rejected, source.skin.problem = 5, "frame of 4 x 4 taxels"
    (diagnosis,) = source.status()["diagnostics"]
    assert diagnosis["level"] == 2
    assert diagnosis["message"] == "message 9 is damaged; 5 frames left out: frame of 4 x 4 taxels"


def test_what_does_not_fit_is_counted_and_a_baseline_subtracted() -> None:
    skin = LocalSkin(ReconstructionSettings(rows=8, cols=8))
    small = np.zeros(1, np.uint16)
    skin.take([(SampleFrame(0, 0, 0, Scheme.RASTER, 4, 4, 0, small, small), 0)], None)
    assert (skin.rejected, skin.newest()) == (1, None)
    assert "4 x 4" in skin.problem
    whole = np.arange(64, dtype=np.uint16)
    skin.take([(SampleFrame(1, 0, 0, Scheme.RASTER, 8, 8, 0, whole, whole), 10)], None)
    taken = skin.newest()
    assert taken is not None
    assert taken[0].image is not None
    # What comes twice changes nothing.
    skin.take([(SampleFrame(1, 0, 0, Scheme.RASTER, 8, 8, 0, whole, whole), 10)], None)
    assert (skin.rejected, skin.newest()) == (2, None)
    # What cannot be shown takes the place of what was, once.
    skin.take([(SampleFrame(2, 0, 0, Scheme.RASTER, 4, 4, 0, small, small), 20)], None)
    taken = skin.newest()
    assert taken is not None
    assert (taken[0].image, taken[0].touch, taken[1]) == (None, None, [])
    assert skin.newest() is None


def test_a_page_holds_a_recording_and_others_see_it(tmp_path: Path) -> None:
    source, name = open_recorded(write_frames(tmp_path / "press.npz", 40), ["plate"], "square")
    shown = Shown(source, name)
    try:
        with shown.connect() as client:
            client.send('{"id":5,"do":"pause"}')
            client.send('{"id":6,"do":"grasp"}')
            seen: dict[str, Any] = {}
            answers: dict[int, tuple[bool, str]] = {}

            def read() -> None:
                header, _ = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
                if header["type"] == "answer":
                    answers[header["id"]] = (header["done"], header["text"])
                elif header["type"] == "status":
                    seen.clear()
                    seen.update(header)

            wait_for(
                lambda: seen.get("replay", {}).get("playing") is False and len(answers) == 2,
                timeout_s=DEADLINE_S,
                meanwhile=read,
                state=lambda: (seen, answers),
            )
            assert answers[5] == (True, "")
            assert answers[6][0] is False
            assert seen["skins"] == ["/press"]
    finally:
        shown.close()


def test_what_a_tared_board_reads_untouched_is_followed_as_it_drifts() -> None:
    """The picture was less what was read at the tare, for hours, though a recording had what is read now."""
    far, near = os.openpty()
    driver = DriverSettings(port=os.ttyname(near), protocol="raster_ascii", rows=SIDE, cols=SIDE, baseline_tau_s=2.0)
    source = BoardSource("/board", driver, "square", lambda level, words: None)
    indices, numbers = np.arange(SIDE * SIDE, dtype=np.uint16), itertools.count()

    def read(seconds: float, counts: int) -> int:
        """What the picture shows at the end."""
        for _ in range(round(100 * seconds)):
            number = next(numbers)
            readings = np.full(indices.size, counts, dtype=np.uint16)
            one = SampleFrame(number, 10_000 * number, 900, Scheme.RASTER, SIDE, SIDE, 0, indices, readings)
            source._take([(one, 10_000_000 * (200 + number))], None)
        newest = source.skin.newest()
        assert newest is not None
        assert newest[0].image is not None
        return int(newest[0].image.max())

    try:
        assert read(1.0, 40) == 40
        source._tare()
        assert read(0.5, 40) == 0
        written: list[float] = []
        feed = SimpleNamespace(
            take=lambda frames: None, set_baseline=lambda baseline: written.append(float(baseline.counts.max()))
        )
        source._feed = cast(Any, feed)
        read(20.0, 55)
        assert read(5.0, 70) <= 5
        assert written == sorted(written)
        assert written[-1] == pytest.approx(70, abs=5)
        # What is quicker is a touch.
        assert read(5.0, 200) >= 130
        assert written[-1] < 71
    finally:
        source.stop()
        os.close(near)
        os.close(far)
