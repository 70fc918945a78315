# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From an open source to frames worth publishing: reader, decoder, stream and the dialogue with the board."""

from __future__ import annotations

import time
from collections.abc import Callable

from acts_core.errors import BoardError
from acts_core.frames import SampleFrame
from acts_core.runtime import LogCallback, RateLimit
from acts_core.wire import BoardMessage
from acts_driver.board import BoardLink, BoardResult, BoardResults, BoardSession, BoardStatus
from acts_driver.nodes.report import DriverReport
from acts_driver.port import HeldBack, Reader, Source, StaleFrames
from acts_driver.settings import DriverSettings
from acts_driver.stream import BacklogWatch, FrameStream
from acts_ros.diagnostics import Report

VERDICT_S = 1.0
"""Longest time that the start waits for a board to identify itself, or to be known not to reply."""

_WRONG_SIZES_TOLD_HZ = 0.2

Consume = Callable[[list[tuple[SampleFrame, int]], list[tuple[BoardResult, int]]], None]
"""Takes frames, and results of the board, each with its stamp [ns]; on the reader's thread."""


class Intake:
    """The driver without ROS: everything between its port and its topics.

    Parameters
    ----------
    settings : DriverSettings
        The driver's parameters.
    source : Source
        Open already.
    consume : callable
        See `Consume`. Called for what may be used: of boards with another firmware nothing.
    log : callable
        See `acts_core.runtime.LogCallback`; called from any thread.
    on_board : callable
        Takes what is known of the board whenever it has changed; from any thread.

    Attributes
    ----------
    reader : Reader
    stream : FrameStream
    session : BoardSession or None
        The dialogue with the board; None where the source takes no commands.
    """

    def __init__(
        self,
        settings: DriverSettings,
        source: Source,
        consume: Consume,
        *,
        log: LogCallback,
        on_board: Callable[[BoardStatus], None],
    ) -> None:
        size = (settings.rows, settings.cols)
        self._size = size
        self._is_replay = settings.is_replay
        self._source = source
        self._consume = consume
        self._log = log
        self._results = BoardResults()
        self._link = BoardLink(source.write, catch_up=lambda timeout_s: self.reader.catch_up(timeout_s))
        decoder = settings.make_decoder(self._receive)
        self._stale_frames = StaleFrames(decoder)
        self._held_back = HeldBack(needed=not decoder.has_board_clock)
        self.stream = FrameStream(*size, has_board_clock=decoder.has_board_clock)
        self.session = (
            BoardSession(self._link, settings, size=size, log=log, on_change=on_board)
            if settings.has_dialogue
            else None
        )
        self.reader = Reader(
            source,
            decoder,
            self._on_frames,
            has_results=self._results.has_results,
            reconnect_s=settings.reconnect_s,
            realtime=settings,
            log=log,
            on_reconnect=self._on_reconnect,
        )
        self._report = DriverReport(source, self.reader, decoder, self.stream, size, self.session, log)
        self._backlog = BacklogWatch()
        self._restarts_told = 0
        self._replacements_seen = 0
        self._wrong_size_told = (0, 0)
        self._wrong_sizes_due = RateLimit(_WRONG_SIZES_TOLD_HZ)

    def start(self) -> None:
        """Begin to read, and wait until it is known which board this is, and which frames are new, for `VERDICT_S`."""
        self._held_back.opened()
        self.reader.start(is_open=True)
        self._held_back.wait(lambda: self.reader.catch_up(VERDICT_S))
        if self.session is not None:
            self.session.start()
            self.session.wait_for_verdict(VERDICT_S)

    def stop(self) -> None:
        """End the threads and close the source. May be called again."""
        if self.session is not None:
            self.session.stop()
        self.reader.stop()

    def change(self, settings: DriverSettings) -> None:
        """Tell the board what the parameters ask for now.

        Raises
        ------
        BoardError, SettingsError
            It cannot be, see `BoardSession.change`.
        """
        if self.session is None:
            raise BoardError("only a board that speaks the binary protocol can be told settings while the driver runs")
        self.session.change(settings)

    def report(self, state: str, now_ns: int) -> Report:
        """What happened since the last call, see `DriverReport.make`."""
        level, message, values = self._report.make(state, now_ns)
        results = {"board_results": self._results.results, "board_results_dropped": self._results.dropped}
        return level, message, {**values, **results}

    def _receive(self, message: BoardMessage) -> None:
        self._stale_frames.receive(message)
        self._link.receive(message)
        self._results.receive(message)

    def _on_frames(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        """Frames that were read together; on the reader's thread."""
        session = self.session
        if not self._stale_frames.is_over:
            frames = self._stale_frames.new(frames, is_known=session is None or session.has_verdict)
        if session is not None and session.replacements != self._replacements_seen:
            self._replacements_seen = session.replacements
            self.stream.board_was_replaced()
        accepted = self.stream.accept(frames, arrival_ns, self._source.waits)
        if self._backlog.lasts(arrival_ns, self.stream.clock.delay_ns):
            self.reader.discard()
            self.stream.statistics.discarded_unread()
        results = self._results.stamped(accepted)
        if self.stream.wrong_size_last != self._wrong_size_told:
            self._tell_wrong_size()
        if session is not None:
            if self.stream.statistics.restarts != self._restarts_told:
                self._restarts_told = self.stream.statistics.restarts
                session.wake()
            if not session.may_publish:
                return
        if self._held_back.holds(self._source.waits):
            return
        self._consume(accepted, results)

    def _on_reconnect(self) -> None:
        """The port is open again; on the reader's thread, before the first frame."""
        self._held_back.opened()
        self.stream.reconnected()
        if self.session is not None:
            self.session.reconnected()

    def _tell_wrong_size(self) -> None:
        # A stream of several sizes, as from two boards on one line, would fill the log.
        if not self._wrong_sizes_due.due(time.monotonic()):
            return
        self._wrong_size_told = self.stream.wrong_size_last
        rows, cols = self._wrong_size_told
        own_rows, own_cols = self._size
        dropped = f"frames of {rows} x {cols} taxels, expected are {own_rows} x {own_cols}; they are dropped"
        if self._is_replay:
            remedy = f"set the parameters rows and cols to {rows} and {cols} (of a launch: rows:={rows} cols:={cols})"
            self._log("error", f"{self._source.name} has {dropped}: {remedy}")
            return
        self._log(
            "error",
            f"the board sends {dropped}: set the parameters rows and cols (of acts view: --size {rows} {cols}); a "
            "simulated board reads no params file, it needs the launch arguments "
            f"rows:={own_rows} cols:={own_cols}",
        )
