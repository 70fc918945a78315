# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A recording gone through at its own pace, with pause and seek, on a thread of its own. Knows no ROS."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from acts_core.errors import RecordingError
from acts_core.frames import SampleFrame
from acts_driver.replay import SeekableRecording

# Frames are handed on so often: what is drawn 30 times a second need not come one by one [s].
_TURN_S = 0.01
# Reading that is slower than playing is shown so often [us].
_READ_MAX_US = 100_000
# Where the machine is later than this, the recording waits: nothing is left out [s].
_LATE_MAX_S = 0.25
# One frame alone shows little: those before the time that is sought are shown with it [us].
_RUN_UP_US = 100_000
# Times that are further from where they can be are those of a clock that was set [us].
_CLOCK_SET_US = 1_000_000


@dataclass(frozen=True)
class PlaybackState:
    """Where a playback is.

    Attributes
    ----------
    position_s, length_s : float
        From the recording's first frame [s].
    is_playing : bool
    problem : str
        Why it cannot go on; empty where it can.
    """

    position_s: float
    length_s: float
    is_playing: bool
    problem: str = ""


class Playback:
    """Plays from the beginning as soon as it is started; at the end it stops, and begins anew when told to play.

    Parameters
    ----------
    recording : SeekableRecording
    on_frames : callable
        Takes frames in their order, on the playback's thread.
    on_jump : callable
        Called there before frames that do not follow on those before.
    """

    def __init__(
        self, recording: SeekableRecording, on_frames: Callable[[list[SampleFrame]], None], on_jump: Callable[[], None]
    ) -> None:
        self._recording = recording
        self._on_frames = on_frames
        self._on_jump = on_jump
        self._length_us = recording.length_us
        self._changed = threading.Condition()
        self._is_playing = True
        self._is_stopped = False
        self._seek_us: int | None = 0
        self._position_us = 0
        self._problem = ""
        # Of the thread alone: the frames' clock at the beginning, and what it would have been there as it is set where
        # the recording is; what is still to be read, the first of it, and when the recording's time was 0.
        self._first_us: int | None = None
        self._zero_us: int | None = None
        self._frames: Iterator[SampleFrame] = iter(())
        self._coming: SampleFrame | None = None
        self._anchor_us = 0.0
        self._thread = threading.Thread(target=self._run, name="acts_playback", daemon=True)

    @property
    def state(self) -> PlaybackState:
        """Where it is; from any thread."""
        with self._changed:
            seek_us = self._seek_us
            position_us = self._position_us if seek_us is None else seek_us
            return PlaybackState(position_us * 1e-6, self._length_us * 1e-6, self._is_playing, self._problem)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End for good."""
        with self._changed:
            self._is_stopped = True
            self._changed.notify()
        self._thread.join()

    def play(self) -> None:
        """Go on; at the end begin anew."""
        with self._changed:
            if not self._is_playing and self._seek_us is None and self._position_us >= self._length_us:
                self._seek_us = 0
            self._is_playing = True
            self._changed.notify()

    def pause(self) -> None:
        """Hold."""
        with self._changed:
            self._is_playing = False

    def seek(self, time_s: float) -> None:
        """Go to a time, of which a frame is shown even while it is held.

        Parameters
        ----------
        time_s : float
            From the first frame; beyond either end it is that end.
        """
        with self._changed:
            self._seek_us = round(min(max(time_s * 1e6, 0.0), float(self._length_us)))
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._wait_while_held()
                if self._is_stopped:
                    return
                seek_us, self._seek_us = self._seek_us, None
                if seek_us is not None:
                    # Told from now on: to read what is there may take a while.
                    self._position_us = seek_us
                    # Of where it was before.
                    self._problem = ""
            try:
                if seek_us is not None:
                    self._jump(seek_us)
                    continue
                due = self._take_due()
            except RecordingError as error:
                self._end(str(error))
                continue
            if due:
                self._on_frames(due)
            if self._coming is None:
                self._end("")
            else:
                self._tell_position(self._coming)
                self._wait_a_turn()

    def _wait_while_held(self) -> None:
        while not (self._is_stopped or self._is_playing or self._seek_us is not None):
            self._changed.wait()
            self._anchor_us = _now_us() - self._position_us

    def _wait_a_turn(self) -> None:
        with self._changed:
            if self._seek_us is None and not self._is_stopped:
                self._changed.wait(_TURN_S)

    def _jump(self, seek_us: int) -> None:
        """Go to a time: hand on the frame there, and those shortly before it."""
        from_us = max(seek_us - _RUN_UP_US, 0)
        self._frames = self._recording.frames(from_us)
        self._coming = next(self._frames, None)
        # Where it was before, the clock may have been another.
        self._zero_us = self._first_us
        if self._coming is not None:
            if self._first_us is None:
                self._first_us = self._zero_us = self._coming.board_us - from_us
            place_us = self._place_us(self._coming)
            if place_us < from_us - _CLOCK_SET_US or self._is_beyond_end(place_us):
                self._zero_us = self._coming.board_us - from_us
        self._on_jump()
        shown: list[SampleFrame] = []
        while self._coming is not None and (not shown or self._place_us(self._coming) <= seek_us):
            shown.append(self._coming)
            self._read_on(self._coming)
        if shown:
            self._on_frames(shown)
        self._anchor_us = _now_us() - seek_us

    def _take_due(self) -> list[SampleFrame]:
        """The frames whose time has come."""
        due: list[SampleFrame] = []
        now_us = _now_us()
        late_us = 0.0 if self._coming is None else now_us - self._anchor_us - self._place_us(self._coming)
        if late_us > _LATE_MAX_S * 1e6:
            self._anchor_us += late_us
        # Up to a time that stands still: after one that moves on, slow reading would run for ever.
        while self._coming is not None and self._place_us(self._coming) <= now_us - self._anchor_us:
            due.append(self._coming)
            self._read_on(self._coming)
            if _now_us() - now_us > _READ_MAX_US:
                break
        return due

    def _read_on(self, last: SampleFrame) -> None:
        """Read the next frame; where the frames' clock was set before it, it follows at once."""
        self._coming = next(self._frames, None)
        if self._coming is None or self._zero_us is None:
            return
        step_us = self._coming.board_us - last.board_us
        # A pause is as long by the frames' clock as by the recording's length.
        is_past_end = step_us > _CLOCK_SET_US and self._is_beyond_end(self._place_us(self._coming))
        if step_us < -_CLOCK_SET_US or is_past_end:
            self._zero_us += step_us

    def _is_beyond_end(self, place_us: int) -> bool:
        return place_us > self._length_us + _CLOCK_SET_US

    def _place_us(self, frame: SampleFrame) -> int:
        return frame.board_us - (self._zero_us or 0)

    def _tell_position(self, coming: SampleFrame) -> None:
        """Where time is: it passes also where the recording has a gap, and after a hold goes on from there."""
        with self._changed:
            self._position_us = round(min(_now_us() - self._anchor_us, self._place_us(coming)))

    def _end(self, problem: str) -> None:
        with self._changed:
            if self._seek_us is None:
                self._is_playing = False
                self._position_us = max(self._position_us, self._length_us)
                self._problem = problem


def _now_us() -> float:
    return time.monotonic() * 1e6
