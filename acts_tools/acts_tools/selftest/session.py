# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Access to a board during a self-test: read frames, change settings, and restore them at the end."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import replace

from acts_core.errors import ActsError, PortError
from acts_core.frames import SampleFrame
from acts_core.wire import BoardSettings, BoardState
from acts_driver.board import BoardLink, NoAnswerError, NotHeardError, RefusedError, UnknownAnswerError
from acts_driver.port import Reader, SerialSource
from acts_driver.protocols import protocol_named
from acts_driver.selftest import FrameRecord

_REPLY_S = 0.5
_TRIES = 4
_SILENT_S = 5.0
# At the end of a record so long, half of it, and so many intervals between its frames: the board hangs.
_HUNG_S = 2.0
_HUNG_INTERVALS = 5.0
_SETTLE_FRAMES = 3
_LOOK_S = 0.1


class BoardReader:
    """Reads one board; a context manager.

    Parameters
    ----------
    port : str
        A path, ``auto`` or ``serial:NUMBER``.
    protocol : str
        A name of `acts_driver.protocols.PROTOCOLS`.
    rows, cols : int
        Size of the array, for protocols that do not report it.
    baud : int
        Baud rate [bit/s]; no effect on USB boards.
    """

    def __init__(self, port: str, protocol: str, rows: int, cols: int, baud: int = 115200) -> None:
        self._source = SerialSource(port, baud)
        kind = protocol_named(protocol)
        self._takes_commands = kind.takes_commands
        # Longer timeouts than in the driver, because full frames are slow.
        self._link = BoardLink(
            self._source.write,
            reply_timeout_s=_REPLY_S,
            tries=_TRIES,
            catch_up=lambda timeout_s: self._reader.catch_up(timeout_s),
        )
        self._decoder = kind.decoder(rows, cols, self._link.receive)
        self._batches: queue.SimpleQueue[tuple[list[SampleFrame], int]] = queue.SimpleQueue()
        self._reader = Reader(
            self._source, self._decoder, lambda frames, arrival_ns: self._batches.put((frames, arrival_ns))
        )

    def __enter__(self) -> BoardReader:
        self._source.open()
        self._reader.start(is_open=True)
        return self

    def __exit__(self, *_: object) -> None:
        self._reader.stop()

    @property
    def name(self) -> str:
        """Name of the port, for messages."""
        return self._source.name

    @property
    def has_board_clock(self) -> bool:
        """Whether frames have a board time."""
        return self._decoder.has_board_clock

    def query(self) -> BoardState | None:
        """The board's state; None where it has no commands.

        Raises
        ------
        NotHeardError, PortError
            The machine is too busy to read its answer, or the port was lost.
        """
        if not self._takes_commands:
            return None
        try:
            return self._link.query().state
        except NotHeardError:
            raise
        except (NoAnswerError, RefusedError, UnknownAnswerError):
            return None

    @contextmanager
    def full_frames(self, own: BoardSettings) -> Iterator[BoardSettings]:
        """Let the board measure full frames as fast as it can; restore its `own` settings at the end of the block.

        Yields
        ------
        BoardSettings
            Settings in force; `own` where the board cannot do it.

        Raises
        ------
        NoAnswerError, PortError
            The board does not reply, or its port was lost.
        """
        wanted = replace(own, scheme="raster", output="samples", frame_period_us=0)
        was_lost = False
        try:
            try:
                in_force = self._link.configure(wanted).state.settings
            except RefusedError:
                in_force = own
            yield in_force
        except PortError:
            was_lost = True
            raise
        finally:
            # That the port was lost says more than that nobody takes settings there now.
            with suppress(ActsError) if was_lost else nullcontext():
                self._link.configure(own)

    def first_frame(self) -> SampleFrame:
        """The next frame, after a few that may have been measured with other settings.

        Raises
        ------
        PortError
            When no frame arrives.
        """
        seen: list[SampleFrame] = []
        self._read_while(lambda: len(seen) <= _SETTLE_FRAMES, lambda frame, arrival_ns: seen.append(frame), _SILENT_S)
        if not seen:
            # Others do not report their size, and lines of another number of counts are no frames.
            own = "a board of this --protocol, --rows and --cols"
            kind = "an ACTS board (--protocol)" if self._takes_commands else own
            raise PortError(
                f"no frames from {self.name} within {_SILENT_S:g} s: {self._decoder.last_error or 'it is silent'}; "
                f"is it {kind}, and is it running?"
            )
        return seen[-1]

    def record(self, rows: int, cols: int, seconds: float, on_frame: Callable[[FrameRecord], None]) -> FrameRecord:
        """Record frames for some seconds, ignoring frames of another size.

        Parameters
        ----------
        rows, cols : int
        seconds : float
        on_frame : callable
            Called with the record so far after every frame.

        Raises
        ------
        PortError
            The port was lost, or the board fell silent before the end.
        """
        record = FrameRecord(rows, cols)
        end_s = time.monotonic() + seconds

        def take(frame: SampleFrame, arrival_ns: int) -> None:
            if (frame.rows, frame.cols) == (rows, cols):
                record.add(frame, arrival_ns)
                on_frame(record)

        self._read_while(lambda: time.monotonic() < end_s, take, seconds)
        if len(record.frames) > 1:
            first_ns, last_ns = record.arrivals_ns[0], record.arrivals_ns[-1]
            silent_s = (time.time_ns() - last_ns) * 1e-9
            interval_s = (last_ns - first_ns) * 1e-9 / (len(record.frames) - 1)
            if silent_s > max(_HUNG_S, seconds / 2, _HUNG_INTERVALS * interval_s):
                raise PortError(
                    f"no frames from {self.name} for {silent_s:.0f} s: it has fallen silent; start it anew, and then "
                    "the test"
                )
        return record

    def _read_while(
        self, condition: Callable[[], bool], take: Callable[[SampleFrame, int], None], longest_s: float
    ) -> None:
        """Process frames that arrive from now on."""
        while not self._batches.empty():
            self._batches.get()
        end_s = time.monotonic() + longest_s
        while condition() and time.monotonic() < end_s:
            if self._reader.problem or self._reader.reconnects:
                raise PortError(f"{self._reader.problem or f'port {self.name} was lost'}; start the test again")
            try:
                frames, arrival_ns = self._batches.get(timeout=_LOOK_S)
            except queue.Empty:
                continue
            for frame in frames:
                take(frame, arrival_ns)
