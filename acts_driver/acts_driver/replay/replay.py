# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A recording as a source: the bytes that a board would send, at the pace of the recording."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass

from acts_core.errors import PacketError, PortError, RecordingError
from acts_core.frames import SampleFrame
from acts_core.runtime import background
from acts_core.wire import encode_frame
from acts_driver.port import READ_TIMEOUT_S
from acts_driver.replay.recordings import Recording

_LATE_MAX_US = 250_000
_TOGETHER_MAX = 64
_FIRST_STEP_US = 1000
# Silence of an open port is an error after a second.
_PAUSE_US = 1_000_000


@dataclass(frozen=True)
class _Next:
    """The frame that comes next, on the board's clock, and its bytes."""

    frame: SampleFrame
    data: bytes

    @classmethod
    def of(cls, frame: SampleFrame) -> _Next:
        return cls(frame, encode_frame(frame))


class ReplaySource:
    """A `Source` that speaks the binary protocol, with a board's clock that runs with the host's.

    Nothing comes before `begin`. Sequence numbers are the recorded ones, gaps included. At the end the recording
    starts over, or is silent; with a loop, sequence and clock go on as if it had gone on. Where the process was not
    scheduled for long, the recording waits: nothing is left out.

    Parameters
    ----------
    name : str
        For a person.
    open_recording : callable
        Opens the recording, or raises `RecordingError`; on a thread of its own.
    speed : float
        2 replays twice as fast.
    loop : bool
        Start over at the end.
    delay_s : float
        Time from `begin` to the first frame, so that subscribers find the topic [s].

    Attributes
    ----------
    name : str
        As given.
    silence : str
        Why no bytes come, where that is known; empty otherwise.
    """

    def __init__(
        self,
        name: str,
        open_recording: Callable[[], Recording],
        *,
        speed: float = 1.0,
        loop: bool = True,
        delay_s: float = 1.0,
    ) -> None:
        self.name = name
        self._open_recording = open_recording
        self._speed = speed
        self._loop = loop
        self._delay_us = round(delay_s * 1e6)
        self._recording: Recording | None = None
        self._opening: Future[Recording] | None = None
        self._pass: Iterator[SampleFrame] = iter(())
        self._zero_us: int | None = None
        self.silence = ""

    @property
    def note(self) -> str:
        """For a person: what is wrong with an open recording that is replayed all the same; empty where it is whole."""
        return getattr(self._recording, "note", None) or ""

    def open(self) -> None:
        """Open the recording, or raise `RecordingError`.

        Where that takes longer than `background.PATIENCE_S` it is an error, too; it goes on, for the next attempt.
        """
        self.close()
        if self._opening is None:
            self._opening = background.begin(self._open_recording)
        opening = self._opening
        if not background.is_done(opening):
            raise RecordingError(f"{self.name} is still being read; try again until it is")
        self._opening = None
        self._recording = opening.result()
        self._in_pass = 0
        has_begun = self._zero_us is not None
        self._zero_us = None
        self._offset_us = 0
        self._board_us = -1
        self._step_us = _FIRST_STEP_US
        self._sequence_offset = 0
        self._sequence = -1
        self._next: _Next | None = None
        self.silence = "it begins when the driver is activated"
        self._start_pass()
        self._prepare()
        if has_begun:
            # Lost and opened again: nobody tells it a second time.
            self.begin()

    def begin(self) -> None:
        """Let the frames come; a second time changes nothing."""
        if self._zero_us is None:
            if self._next is not None:
                # Else it says why not even the first frame can come.
                self.silence = ""
            self._zero_us = _now_us() + self._delay_us

    def read(self) -> bytes:
        """Return the frames that are due, waiting for the first one up to `READ_TIMEOUT_S`."""
        if self._recording is None:
            raise PortError(f"recording {self.name} is not open")
        zero_us, coming = self._zero_us, self._next
        if zero_us is None or coming is None:
            time.sleep(READ_TIMEOUT_S)
            return b""
        wait_us = zero_us + coming.frame.board_us - _now_us()
        is_pause = wait_us > _PAUSE_US
        self.silence = f"its next frame is due in {wait_us * 1e-6:.0f} s" if is_pause else ""
        if wait_us > READ_TIMEOUT_S * 1e6:
            time.sleep(READ_TIMEOUT_S)
            return b""
        if wait_us > 0:
            time.sleep(wait_us * 1e-6)
        elif wait_us < -_LATE_MAX_US:
            # The board's clock has gone on meanwhile.
            self._offset_us -= wait_us
            self._board_us -= wait_us
            self._next = _Next.of(coming.frame._replace(board_us=self._board_us))
        data: list[bytes] = []
        now_us = _now_us() - zero_us
        while self._next is not None and self._next.frame.board_us <= now_us and len(data) < _TOGETHER_MAX:
            data.append(self._next.data)
            self._prepare()
        return b"".join(data)

    def waits(self) -> bool:
        """Nothing of a recording arrives before it is read."""
        return False

    def discard(self) -> None:
        """A recording waits by itself for a reader that is late."""

    def write(self, data: bytes, timeout_s: float) -> None:
        """A recording takes no commands: raises `PortError`."""
        raise PortError(f"{self.name} takes no commands")

    def close(self) -> None:
        """Let go of the recording, and of its file."""
        self._recording = None
        self._pass = iter(())

    def _start_pass(self) -> None:
        assert self._recording is not None
        self._pass = self._recording.frames()
        self._in_pass = 0

    def _prepare(self) -> None:
        """Make the next frame ready ahead of its time."""
        self._next = None
        try:
            frame = next(self._pass, None)
            if frame is None and self._loop and self._in_pass:
                self._start_pass()
                frame = next(self._pass, None)
            if frame is None:
                self.silence = "the recording has ended"
                return
            self._next = self._placed(frame)
        except PacketError as error:
            self.silence = f"frame {self._in_pass} of the recording is not valid: {error}"
        except RecordingError as error:
            self.silence = str(error)

    def _placed(self, frame: SampleFrame) -> _Next:
        """A frame on the board's clock, which only goes forward, whatever the recording's did."""
        recorded_us = round(frame.board_us / self._speed)
        board_us = recorded_us + self._offset_us
        if self._in_pass == 0 or board_us <= self._board_us:
            if self._board_us >= 0:
                self._sequence_offset = self._sequence + 1 - frame.sequence
            board_us = self._board_us + self._step_us if self._board_us >= 0 else 0
            self._offset_us = board_us - recorded_us
        else:
            self._step_us = board_us - self._board_us
        self._in_pass += 1
        self._board_us = board_us
        self._sequence = frame.sequence + self._sequence_offset
        return _Next.of(
            frame._replace(
                sequence=self._sequence,
                board_us=board_us,
                duration_us=round(frame.duration_us / self._speed),
                overruns=0,
            )
        )


def _now_us() -> int:
    return time.monotonic_ns() // 1000
