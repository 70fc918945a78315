# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics of the stream of frames: rate, gaps, repetitions, restarts of the board."""

from __future__ import annotations

import threading
from collections import deque

from acts_driver.stream.clock import DRIFT_MAX

_MODULUS = 1 << 32
_HALF = 1 << 31
_BIN_NS = 100_000_000
_BINS = 10
_RECENT = 64
# How long a frame may wait until a busy machine reads it [ns].
_LATE_NS = 500_000_000


class StreamStatistics:
    """Counts over all frames of a board, in the order of their arrival.

    Attributes
    ----------
    frames : int
        New frames.
    lost : int
        Frames missing between two others, by their sequence numbers (which wrap at 2**32).
    discarded : int
        Those of `lost` that the host threw away unread; see `discarded_unread`.
    repeated : int
        Frames that came a second time, or after a later one.
    restarts : int
        Restarts of the board. Its sequence starts anew then, and no frame counts as lost.
    overruns : int
        Frames the board dropped because the host did not read, as it said last.
    overruns_before : int
        Those of them that were dropped before the first frame came, when nobody may have been there to read.
    lock : threading.Lock
        `FrameStream.accept` holds it while it counts. Another thread that reads several counters holds it too, or one
        may already count a gap of which another does not know yet.
    """

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.frames = 0
        self.lost = 0
        self.discarded = 0
        self.repeated = 0
        self.restarts = 0
        self.overruns = 0
        self.overruns_before = 0
        self._sequence = -1
        self._board_us = 0
        self._measured_ns = 0
        self._recent: deque[tuple[int, int]] = deque(maxlen=_RECENT)
        self._reconnected = False
        self._threw_away = False
        # By how much the clock of the arrivals was set so far: the rate is told as if it had not been.
        self._set_by_ns = 0
        self._bin = 0
        self._bins: deque[tuple[int, int]] = deque(maxlen=_BINS + 1)
        self._in_bin = 0

    def observe(self, sequence: int, board_us: int, overruns: int, arrival_ns: int) -> bool:
        """Count one frame.

        Parameters
        ----------
        sequence, board_us, overruns : int
            As in `acts_core.frames.SampleFrame`.
        arrival_ns : int
            When it was read, on the host's clock [ns].

        Returns
        -------
        bool
            Whether it is new; one that is not must not be published.
        """
        if self._sequence >= 0:
            missing = (sequence - self._sequence - 1) % _MODULUS
            was_off = self._reconnected and self._was_off(board_us, arrival_ns)
            if missing >= _HALF and not was_off and self._came_before(sequence, board_us):
                self.repeated += 1
                return False
            if missing >= _HALF or board_us < self._board_us or was_off:
                self.restarts += 1
                self._recent.clear()
            else:
                self.lost += missing
                self.discarded += missing if self._threw_away else 0
        else:
            self.overruns_before = overruns
        self._reconnected = False
        self._threw_away = False
        self._sequence = sequence
        self._board_us = board_us
        self._measured_ns = arrival_ns
        self._recent.append((sequence, board_us))
        self.overruns = overruns
        self.frames += 1
        self._count_rate(arrival_ns)
        return True

    def reconnected(self) -> None:
        """Tell that the port was lost and opened again; for boards with a clock, see `FrameStream.reconnected`."""
        self._reconnected = True

    def discarded_unread(self) -> None:
        """Tell that what waited to be read is thrown away: what is missing before the next frame was discarded."""
        self._threw_away = True

    def stamped(self, stamp_ns: int) -> None:
        """Tell when the last frame was measured [ns], on the clock of the arrivals.

        It may have waited in a buffer for long, so its arrival says little about the clocks.
        """
        self._measured_ns = stamp_ns

    def host_was_set(self, step_ns: int) -> None:
        """Tell that the clock of the arrivals was set, and by how much [ns]."""
        self._measured_ns += step_ns
        self._set_by_ns += step_ns

    def rate_hz(self, now_ns: int) -> float:
        """New frames per second of arrival, over the last second; takes `lock`."""
        now = (now_ns - self._set_by_ns) // _BIN_NS
        # The bin that is being filled is left out: with it the rate would depend on the time of the call.
        with self.lock:
            done = [*self._bins, (self._bin, self._in_bin)]
        return sum(count for number, count in done if now - _BINS <= number < now) / (_BINS * _BIN_NS * 1e-9)

    def _came_before(self, sequence: int, board_us: int) -> bool:
        """Whether a frame that is behind the last one is from the same life of the board."""
        known_us = dict(self._recent).get(sequence)
        if known_us is not None:
            return known_us == board_us
        oldest_sequence, oldest_us = self._recent[0]
        return (sequence - oldest_sequence) % _MODULUS < _RECENT and oldest_us < board_us < self._board_us

    def _was_off(self, board_us: int, arrival_ns: int) -> bool:
        """Whether, after a reconnection, the board's clock tells that the board was without power meanwhile."""
        passed_ns = arrival_ns - self._measured_ns
        difference_ns = (board_us - self._board_us) * 1000 - passed_ns
        # A board that was off is behind by more than all the time that it was on before.
        return abs(difference_ns) > min(_LATE_NS, self._board_us * 500) + DRIFT_MAX * passed_ns

    def _count_rate(self, arrival_ns: int) -> None:
        number = (arrival_ns - self._set_by_ns) // _BIN_NS
        if number != self._bin:
            self._bins.append((self._bin, self._in_bin))
            self._bin = number
            self._in_bin = 0
        self._in_bin += 1
