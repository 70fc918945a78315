# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver's report on /diagnostics, from its counters."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from acts_core.runtime import LogCallback, Pace
from acts_core.words import counted
from acts_driver.board import BoardSession, BoardStatus, settings_in_words, version_in_words
from acts_driver.port import Reader, Source
from acts_driver.protocols import Decoder
from acts_driver.stream import FrameStream
from acts_ros.diagnostics import ERROR, OK, WARN, Report


@dataclass(frozen=True)
class Totals:
    """Counters since the driver was configured; see `docs/driver.md`."""

    frames: int = 0
    lost: int = 0
    discarded: int = 0
    crc_errors: int = 0
    malformed: int = 0
    wrong_size: int = 0
    overruns: int = 0
    repeated: int = 0
    restarts: int = 0
    reconnects: int = 0
    partial: int = 0
    bytes_discarded: int = 0
    consumer_errors: int = 0
    clock_resets: int = 0

    def since(self, before: Totals) -> Totals:
        """What was added; a counter of the board that fell back with its restart counts from zero."""
        added = {}
        for field in fields(self):
            now, then = getattr(self, field.name), getattr(before, field.name)
            added[field.name] = now - then if now >= then else now
        return Totals(**added)


_TROUBLES = {
    "lost": ("frame lost", "frames lost"),
    "discarded": (
        "of them thrown away unread because it was late",
        "of them thrown away unread because they were late",
    ),
    "crc_errors": ("CRC error", "CRC errors"),
    "malformed": ("malformed packet", "malformed packets"),
    "overruns": ("overrun of the board", "overruns of the board"),
    "repeated": ("repeated frame", "repeated frames"),
    "restarts": ("restart of the board", "restarts of the board"),
    "reconnects": ("reconnection", "reconnections"),
    "consumer_errors": ("failure to publish", "failures to publish"),
    "clock_resets": ("jump of a clock", "jumps of a clock"),
}
# As late as this, a controller does without touch.
_LATE_US = 50_000
# Where frames come as rarely, none may fall into the second of a report.
_SLOW_S = 0.4
# The first report may come before the first frame.
_SILENT_REPORTS = 2


class DriverReport:
    """Makes the report of a configured driver, about what happened since the report before.

    Parameters
    ----------
    source, reader, decoder, stream
        What is reported on.
    expected_size : tuple of int
        Rows and columns that frames must have.
    session : BoardSession or None
        The dialogue with the board, where there is one.
    log : callable
        Is told once that an open port gives no frames, and why, and once that it does again.
    """

    def __init__(
        self,
        source: Source,
        reader: Reader,
        decoder: Decoder,
        stream: FrameStream,
        expected_size: tuple[int, int],
        session: BoardSession | None = None,
        log: LogCallback = lambda level, message: None,
    ) -> None:
        self._log = log
        self._silent_reports = 0
        self._session = session
        self._source = source
        self._reader = reader
        self._decoder = decoder
        self._stream = stream
        self._expected_size = expected_size
        self._before = Totals()
        self._pace = Pace()
        # Words for it where all frames of the last report that had any were of a wrong size.
        self._wrong_size = ""

    def totals(self) -> Totals:
        """Present counters."""
        statistics, decoder = self._stream.statistics, self._decoder
        with statistics.lock:
            return Totals(
                frames=statistics.frames,
                lost=statistics.lost,
                discarded=statistics.discarded,
                crc_errors=decoder.crc_errors,
                malformed=decoder.malformed,
                wrong_size=self._stream.wrong_size,
                overruns=statistics.overruns,
                repeated=statistics.repeated,
                restarts=statistics.restarts,
                reconnects=self._reader.reconnects,
                partial=decoder.partial,
                bytes_discarded=decoder.bytes_discarded,
                consumer_errors=self._reader.consumer_errors,
                clock_resets=self._stream.clock.state.resets,
            )

    def make(self, state: str, now_ns: int) -> Report:
        """Level, sentence and values for the time since the last call.

        Parameters
        ----------
        state : str
            Of the node's life cycle, for example "active".
        now_ns : int
            The clock that frames are given their arrival with [ns].
        """
        totals = self.totals()
        if not self._before.frames:
            self._before = replace(self._before, overruns=self._stream.statistics.overruns_before)
        added = totals.since(self._before)
        self._before = totals
        if added.frames:
            self._pace.step(now_ns * 1e-9, added.frames)
        is_slow = self._pace.interval_s > _SLOW_S
        is_silent = not added.frames and not (is_slow and not self._pace.is_silent(now_ns * 1e-9))
        rate_hz = self._stream.statistics.rate_hz(now_ns)
        level, message = self._judge(added, f"{rate_hz:.1f} frames/s, {state}", is_silent=is_silent)
        self._tell_silence(added, message, is_silent=is_silent)
        board = BoardStatus() if self._session is None else self._session.status
        if self._session is not None and self._reader.connected:
            level, message = _with_board(level, message, board, is_needed=self._session.asks_for_something)
        clock = self._stream.clock.state
        has_clock = self._stream.has_board_clock
        values: dict[str, object] = {"rate_hz": rate_hz}
        values.update({field.name: getattr(totals, field.name) for field in fields(totals)})
        values["clock_offset_us"] = clock.offset_us if has_clock else "none"
        values["clock_drift_ppm"] = clock.drift_ppm if has_clock else "none"
        values["delay_us"] = clock.delay_us if has_clock else "none"
        values.update(_board_values(board))
        values["last_error"] = self._decoder.last_error
        values["port"] = self._source.name
        values["state"] = state
        return level, message, values

    def _tell_silence(self, added: Totals, message: str, *, is_silent: bool) -> None:
        """Log silence: a user who starts a driver reads the screen before the diagnostics."""
        if not is_silent or not self._reader.connected:
            if added.frames and self._silent_reports >= _SILENT_REPORTS:
                self._log("info", f"frames again: {message}")
            self._silent_reports = 0
            return
        self._silent_reports += 1
        if self._silent_reports == _SILENT_REPORTS:
            self._log("info" if self._source.silence else "error", message)

    def _judge(self, added: Totals, fine: str, *, is_silent: bool) -> tuple[int, str]:
        if not self._reader.connected:
            return ERROR, self._reader.problem or f"{self._source.name} is closed"
        troubles = self._troubles(added, is_silent=is_silent)
        if is_silent:
            why = f" ({self._source.silence})" if self._source.silence else ""
            return ERROR, ", ".join([f"no frames from {self._source.name}{why}", *troubles])
        if self._wrong_size:
            # Between two frames of a slow board it is as it was.
            return ERROR, ", ".join(troubles if added.frames else [self._wrong_size, *troubles])
        if troubles:
            return WARN, ", ".join(troubles)
        return OK, fine

    def _troubles(self, added: Totals, *, is_silent: bool) -> list[str]:
        """What is wrong with what has come since the last report; remembers what is told of frames of a wrong size."""
        troubles = [counted(getattr(added, name), *words) for name, words in _TROUBLES.items() if getattr(added, name)]
        if added.frames:
            self._wrong_size = ""
        if added.wrong_size:
            given, expected = self._stream.wrong_size_last, self._expected_size
            words = (
                f"{counted(added.wrong_size, 'frame')} of {given[0]} x {given[1]} taxels dropped, expected are "
                f"{expected[0]} x {expected[1]} (parameters rows and cols)"
            )
            troubles.insert(0, words)
            self._wrong_size = words if added.frames == added.wrong_size else ""
        if added.crc_errors or added.malformed:
            troubles.append(f"last: {self._decoder.last_error}")
        elif is_silent and added.bytes_discarded and self._decoder.last_error:
            # What never ends a packet is counted once, and goes on.
            troubles.append(f"{counted(added.bytes_discarded, 'byte')} without one: {self._decoder.last_error}")
        delay_us = self._stream.clock.state.delay_us if self._stream.has_board_clock else 0.0
        if delay_us > _LATE_US:
            late = f"frames are read {delay_us / 1e6:.1f} s late"
            troubles.insert(0, f"{late}: this machine is too slow or too busy (acts doctor tells)")
        return troubles


def _with_board(level: int, message: str, board: BoardStatus, *, is_needed: bool) -> tuple[int, str]:
    """The report with the board's own state added to that of its frames."""
    if not board.problem:
        return level, message
    if board.is_silent:
        # Frames are valid all the same; only who wants to tell the board something has to know.
        if is_needed:
            return max(level, WARN), f"{board.problem}: the parameters about the board are not in force; {message}"
        return level, f"{message}, {board.problem}" if level == OK else message
    return ERROR, f"{board.problem}; {message}"


def _board_values(board: BoardStatus) -> dict[str, object]:
    state = board.state
    if state is None:
        return {"board": "does not answer" if board.is_silent else "none", "firmware": "", "board_settings": ""}
    return {
        "board": state.board_id,
        "firmware": version_in_words(state),
        "board_settings": settings_in_words(state.settings),
    }
