# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From decoded frames to those worth publishing: new, of the expected size, with the time of their measurement."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from acts_core.frames import SampleFrame
from acts_driver.stream.clock import ClockFilter
from acts_driver.stream.host_clock import HostClock
from acts_driver.stream.statistics import StreamStatistics

# Frames of more taxels come one at a time, as a terminal hands over 4095 bytes.
_LARGE_TAXELS = 512


class FrameStream:
    """Statistics, size check and stamps of one board's frames.

    Parameters
    ----------
    rows, cols : int
        Expected size of the array.
    has_board_clock : bool
        Whether the frames' `board_us` is a clock; otherwise they are stamped with their arrival.
    host_clock : HostClock or None
        What tells that the clock of the arrivals was set; None: that of this machine.

    Attributes
    ----------
    statistics : StreamStatistics
        Counts over all new frames, also those of a wrong size.
    clock : ClockFilter
        The mapping of the clocks.
    wrong_size : int
        Frames dropped because of their size.
    wrong_size_last : tuple of int
        Rows and columns of the last of them; (0, 0) for none.
    """

    def __init__(
        self, rows: int, cols: int, *, has_board_clock: bool = True, host_clock: HostClock | None = None
    ) -> None:
        self._host_clock = HostClock() if host_clock is None else host_clock
        self.statistics = StreamStatistics()
        self.clock = ClockFilter()
        self.has_board_clock = has_board_clock
        self.wrong_size = 0
        self.wrong_size_last = (0, 0)
        self._rows = rows
        self._cols = cols

    def reconnected(self) -> None:
        """Tell that the port was lost and opened again: the next frame may be from a board that was restarted."""
        # Nothing but the board's clock tells whether it was.
        if self.has_board_clock:
            self.statistics.reconnected()

    def board_was_replaced(self) -> None:
        """Tell that the next frame is of another board; the clocks of two boards that began together are much alike."""
        self.clock.board_was_replaced()

    def accept(
        self, frames: Sequence[SampleFrame], arrival_ns: int, is_behind: Callable[[], bool] = lambda: False
    ) -> list[tuple[SampleFrame, int]]:
        """Check and stamp frames that were read together; return those to publish.

        Parameters
        ----------
        frames : sequence of SampleFrame
            In order of arrival.
        arrival_ns : int
            When they were read, in ROS time [ns].
        is_behind : callable
            Whether more waits to be read.

        Returns
        -------
        list of (SampleFrame, int)
            The stamp is the ROS time at the end of the frame's last measurement [ns].
        """
        statistics = self.statistics
        new: list[SampleFrame] = []
        board_us: list[int] = []
        restarted = False
        if self._host_clock.was_set():
            if self.has_board_clock:
                self.clock.host_was_set()
            statistics.host_was_set(self._host_clock.step_ns)
            # They may have been read just before that.
            arrival_ns = self._host_clock.now_ns()
        with statistics.lock:
            for frame in frames:
                restarts = statistics.restarts
                if statistics.observe(frame.sequence, frame.board_us, frame.overruns, arrival_ns):
                    restarted |= not new and statistics.restarts > restarts
                    new.append(frame)
                    board_us.append(frame.board_us)
        if not new:
            return []
        if self.has_board_clock:
            is_large = len(new[-1].indices) > _LARGE_TAXELS
            stamps = self.clock.step_batch(
                board_us, arrival_ns, restarted=restarted, is_behind=lambda: is_large and is_behind()
            )
            statistics.stamped(stamps[-1])
        else:
            stamps = [arrival_ns - (len(new) - 1 - number) for number in range(len(new))]
        accepted: list[tuple[SampleFrame, int]] = []
        for frame, stamp_ns in zip(new, stamps, strict=True):
            if frame.rows == self._rows and frame.cols == self._cols:
                accepted.append((frame, stamp_ns))
            else:
                self.wrong_size += 1
                self.wrong_size_last = (frame.rows, frame.cols)
        return accepted
