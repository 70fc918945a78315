# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When the frames of a recording come, its loop, and its end."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pty_board import frame, wait_for

from acts_core.errors import RecordingError
from acts_core.frames import SampleFrame
from acts_core.wire import StreamDecoder
from acts_driver.port import Reader
from acts_driver.replay import ReplaySource
from acts_driver.stream import FrameStream

pytestmark = pytest.mark.slow


class FixedRecording:
    """Frames out of a list."""

    def __init__(self, frames: list[SampleFrame]) -> None:
        self._frames = frames

    def frames(self) -> Iterator[SampleFrame]:
        return iter(self._frames)


def drain(source: ReplaySource, count: int) -> tuple[list[SampleFrame], list[int]]:
    """Frames and the stamps that the driver gives them."""
    stream = FrameStream(32, 32)
    accepted: list[tuple[SampleFrame, int]] = []
    reader = Reader(source, StreamDecoder(), lambda frames, at_ns: accepted.extend(stream.accept(frames, at_ns)))
    source.open()
    reader.start(is_open=True)
    source.begin()
    wait_for(lambda: len(accepted) >= count, f"{count} frames")
    reader.stop()
    assert stream.statistics.restarts == stream.statistics.repeated == stream.clock.state.resets == 0
    return [one for one, _ in accepted[:count]], [stamp_ns for _, stamp_ns in accepted[:count]]


@pytest.mark.parametrize("speed", [1.0, 4.0])
def test_stamps_advance_as_recorded_and_a_loop_goes_on(speed: float) -> None:
    recorded = [frame(10 + k, board_us=7_000_000 + at) for k, at in enumerate((0, 10_000, 12_000, 40_000))]
    source = ReplaySource("test", lambda: FixedRecording(recorded), speed=speed, delay_s=0.0)
    frames, stamps_ns = drain(source, 10)
    assert [one.sequence for one in frames] == list(range(10, 20))
    steps_us = np.diff([one.board_us for one in frames])
    # From the last to the first as from the last but one to the last.
    assert steps_us.tolist() == [round(step / speed) for step in ([10_000, 2_000, 28_000, 28_000] * 3)[:9]]
    assert (np.diff(stamps_ns) > 0).all()
    for one, original in zip(frames, itertools.cycle(recorded), strict=False):
        np.testing.assert_array_equal(one.counts, original.counts)


@given(
    st.lists(st.tuples(st.integers(0, 2**33), st.integers(0, 2**40)), min_size=1, max_size=20),
    st.floats(0.01, 100.0),
)
@settings(max_examples=100, deadline=None)
def test_the_replayed_clock_only_goes_forward(times: list[tuple[int, int]], speed: float) -> None:
    recorded = [frame(sequence & 0xFFFF, board_us=at_us, m=1) for sequence, at_us in times]
    source = ReplaySource("test", lambda: FixedRecording(recorded), speed=speed)
    source.open()
    decoder = StreamDecoder()
    last_us = -1
    for _ in range(3 * len(times)):
        assert source._next is not None
        (found,) = decoder.feed(source._next.data)
        assert found.board_us > last_us
        last_us = found.board_us
        source._prepare()


def test_without_a_loop_the_end_is_told() -> None:
    source = ReplaySource("test", lambda: FixedRecording([frame(0), frame(1)]), loop=False, delay_s=0.0)
    source.open()
    assert source.read() == b""
    assert "begins when" in source.silence
    source.begin()
    assert source.silence == ""
    data = b""
    while not source.silence:
        data += source.read()
    assert [one.sequence for one in StreamDecoder().feed(data)] == [0, 1]
    assert source.silence == "the recording has ended"
    assert source.read() == b""


def test_a_pause_of_the_recording_is_told() -> None:
    # As of a robot whose clock began in 1970, and was set while it recorded.
    recorded = [frame(0, board_us=0), frame(1, board_us=1000), frame(2, board_us=1_600_000_000_000_000)]
    source = ReplaySource("test", lambda: FixedRecording(recorded), delay_s=0.0)
    source.open()
    source.begin()
    frames: list[SampleFrame] = []
    decoder = StreamDecoder()

    def have_come() -> bool:
        frames.extend(decoder.feed(source.read()))
        return len(frames) == 2

    wait_for(have_come, "the frames before the pause")
    assert source.silence == ""
    assert source.read() == b""
    assert re.fullmatch(r"its next frame is due in 1\d{9} s", source.silence)
    source.close()


def test_a_recording_that_is_lost_and_opened_again_goes_on() -> None:
    passes = 0

    class OnALostDrive:
        def frames(self) -> Iterator[SampleFrame]:
            nonlocal passes
            passes += 1
            if passes == 2:
                raise OSError(5, "Input/output error")
            yield from (frame(k) for k in range(3))

    taken: list[SampleFrame] = []
    source = ReplaySource("test", OnALostDrive, delay_s=0.0)
    reader = Reader(source, StreamDecoder(), lambda frames, at_ns: taken.extend(frames), reconnect_s=0.02)
    source.open()
    reader.start(is_open=True)
    source.begin()
    wait_for(lambda: len(taken) > 6, "frames after the loss")
    reader.stop()
    assert reader.reconnects == 1


def test_damage_is_told_after_everything_before_it() -> None:
    class Damaged:
        def frames(self) -> Iterator[SampleFrame]:
            yield frame(0)
            raise RecordingError("the bag is damaged after 1 message")

    source = ReplaySource("test", Damaged, delay_s=0.0)
    source.open()
    source.begin()
    assert [one.sequence for one in StreamDecoder().feed(source.read())] == [0]
    assert source.silence == "the bag is damaged after 1 message"


def test_damage_of_the_first_frame_is_told_also_once_frames_are_wanted() -> None:
    twice = frame(0)._replace(indices=np.array([7, 7], np.uint16), counts=np.array([1, 2], np.uint16))
    source = ReplaySource("test", lambda: FixedRecording([twice, frame(1)]), delay_s=0.0)
    source.open()
    source.begin()
    assert source.read() == b""
    assert source.silence.startswith("frame 1 of the recording is not valid: index 7 of sample 1 occurred before")
