# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The board's clock mapped onto the host's: offset, drift, jumps.

A frame measured at board time b arrives at host time a. Then ``a - b = offset + transport delay``. The transport delay
is never negative and mostly short. So the offset is estimated by the line under all a - b of the last seconds
(`LowerEnvelope`); its slope is the drift. The shortest transport delay remains in the offset.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from acts_driver.stream.envelope import LowerEnvelope

DRIFT_MAX = 500e-6
"""Largest drift of a quartz, faulty ones included: 500 ppm."""

# Time over which offset and drift are estimated, and after which drift is [ns].
_WINDOW_NS = 10_000_000_000
_DRIFT_FROM_NS = 2_000_000_000
# Difference from the expected delay that means a clock has jumped, and how long frames must be late by that much, since
# a stall passes [ns].
_JUMP_NS = 50_000_000
_JUMP_CONFIRM_NS = 2_000_000_000
# Board time in one read that shows a backlog: lateness is then no sign of a jump [us].
_BACKLOG_US = 3_000.0


@dataclass(frozen=True)
class ClockFilterState:
    """State of the filter.

    Attributes
    ----------
    offset_us : int
        Host time minus board time at the newest frame [us].
    drift_ppm : float
        Growth of the offset [us per s]; positive where the board's clock is slow.
    delay_us : float
        Transport delay of the newest frame, beyond the shortest one [us].
    resets : int
        Jumps of a clock, including restarts of the board.
    """

    offset_us: int = 0
    drift_ppm: float = 0.0
    delay_us: float = 0.0
    resets: int = 0


class ClockFilter:
    """Stamps frames with the host time of their measurement.

    Stamps increase strictly and never lie after the arrival. Only where the host's own clock is set back do they follow
    it. A jump of either clock starts the estimate anew. This is at once where the board's clock jumps forwards,
    where the host's jumps backwards, and where `host_was_set` tells of it. Other jumps look like a stall in transport:
    these count after two seconds without a backlog. A host that is too slow reads its backlog in large pieces, and
    what it reads is as old as it looks. A first frame that was read late is no jump.

    Attributes
    ----------
    delay_ns : int
        Transport delay of the newest frame, beyond the shortest one [ns].
    """

    def __init__(self) -> None:
        self._resets = 0
        self._envelope: LowerEnvelope | None = None
        # Points of the envelope are relative to the first frame, so that they stay small.
        self._origin_board_ns = 0
        self._origin_delay_ns = 0
        self._late_since_ns: int | None = None
        # Whether the estimate rests on one read alone, which may have come late.
        self._is_first = False
        self.delay_ns = 0
        self._last_board_us = 0
        self._last_arrival_ns = 0
        self._last_stamp_ns: int | None = None

    @property
    def state(self) -> ClockFilterState:
        """Present estimate."""
        envelope = self._envelope
        if envelope is None:
            return ClockFilterState(resets=self._resets)
        x = self._last_board_us * 1000 - self._origin_board_ns
        return ClockFilterState(
            offset_us=(self._origin_delay_ns + envelope.at(x)) // 1000,
            drift_ppm=envelope.slope * 1e6,
            delay_us=self.delay_ns * 1e-3,
            resets=self._resets,
        )

    def host_was_set(self) -> None:
        """Tell that the host's clock was set: the estimate begins anew with the next frame, and stamps follow it."""
        self._resets += 1
        self._envelope = None
        self._last_arrival_ns = 0
        self._last_stamp_ns = None

    def board_was_replaced(self) -> None:
        """Tell that the next frame is of another board: the estimate begins anew with it."""
        self._envelope = None

    def step(self, board_us: int, arrival_ns: int) -> int:
        """Update by one frame; see `step_batch`."""
        return self.step_batch((board_us,), arrival_ns)[0]

    def step_batch(
        self,
        board_us: Sequence[int],
        arrival_ns: int,
        *,
        restarted: bool = False,
        is_behind: Callable[[], bool] = lambda: False,
    ) -> list[int]:
        """Update by frames that arrived together, and return their stamps.

        Parameters
        ----------
        board_us : sequence of int
            Board times, in order of arrival [us]. The last frame has the shortest transport delay, so the estimate is
            updated by it alone.
        arrival_ns : int
            When they were read, on the host's clock [ns].
        restarted : bool
            Whether the first of them is known to be of a board that was restarted, even where its clock is ahead of the
            last frame's.
        is_behind : callable
            Whether more frames wait to be read, where that is another sign of a backlog; asked of late frames only.

        Returns
        -------
        list of int
            Host time of each measurement [ns].
        """
        if arrival_ns < self._last_arrival_ns:
            self._restart(board_us[-1], arrival_ns)
            self._last_stamp_ns = None
        self._last_arrival_ns = arrival_ns
        stamps: list[int] = []
        begin = 0
        for end in range(1, len(board_us) + 1):
            # A board that restarts within a batch begins a batch of its own.
            if end == len(board_us) or board_us[end] < board_us[end - 1]:
                anew = board_us[begin] < self._last_board_us or (restarted and begin == 0)
                stamps += self._stamps(board_us[begin:end], arrival_ns, len(board_us) - begin, anew, is_behind)
                begin = end
        return stamps

    def _stamps(
        self, board_us: Sequence[int], arrival_ns: int, room: int, restarted: bool, is_behind: Callable[[], bool]
    ) -> list[int]:
        is_long = board_us[-1] - board_us[0] > _BACKLOG_US
        envelope = self._observe(board_us[-1], arrival_ns, restarted, lambda: is_long or is_behind())
        self._last_board_us = board_us[-1]
        stamps = []
        last = self._last_stamp_ns
        for time_us in board_us:
            board_ns = time_us * 1000
            stamp = board_ns + self._origin_delay_ns + envelope.at(board_ns - self._origin_board_ns)
            if last is not None and stamp <= last:
                stamp = last + 1
            # Stamps of a batch are at least 1 ns apart, and none lies after the arrival.
            room -= 1
            last = min(stamp, arrival_ns - room)
            stamps.append(last)
        self._last_stamp_ns = last
        return stamps

    def _observe(
        self, board_us: int, arrival_ns: int, restarted: bool, is_backlog: Callable[[], bool]
    ) -> LowerEnvelope:
        if self._envelope is None:
            return self._start(board_us, arrival_ns)
        if restarted:
            return self._restart(board_us, arrival_ns)
        x_ns = board_us * 1000 - self._origin_board_ns
        y_ns = arrival_ns - board_us * 1000 - self._origin_delay_ns
        late_ns = y_ns - self._envelope.at(x_ns)
        if late_ns > _JUMP_NS and is_backlog():
            # Says nothing about the clocks, however long it lasts.
            self.delay_ns = late_ns
            self._late_since_ns = None
            return self._envelope
        height_ns = self._envelope.observe(x_ns, y_ns)
        self.delay_ns = height_ns if height_ns > 0 else 0
        is_first, self._is_first = self._is_first, False
        if height_ns < -_JUMP_NS:
            return self._start(board_us, arrival_ns) if is_first else self._restart(board_us, arrival_ns)
        if height_ns <= _JUMP_NS:
            self._late_since_ns = None
        elif self._late_since_ns is None:
            self._late_since_ns = arrival_ns
        elif arrival_ns - self._late_since_ns > _JUMP_CONFIRM_NS:
            return self._restart(board_us, arrival_ns)
        return self._envelope

    def _start(self, board_us: int, arrival_ns: int) -> LowerEnvelope:
        self._origin_board_ns = board_us * 1000
        self._origin_delay_ns = arrival_ns - self._origin_board_ns
        self._late_since_ns = None
        self._is_first = True
        self.delay_ns = 0
        self._envelope = LowerEnvelope(_WINDOW_NS, _DRIFT_FROM_NS, DRIFT_MAX, (0, 0))
        return self._envelope

    def _restart(self, board_us: int, arrival_ns: int) -> LowerEnvelope:
        self._resets += 1
        return self._start(board_us, arrival_ns)
