"""A board for the time of a self-test: frames out of it, settings into it, its own settings back at the end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from acts_core.board_messages import BoardMessage
from acts_core.commands import BoardSettings, Reply, encode_configure, encode_query
from acts_core.delimited import DelimitedDecoder
from acts_core.errors import PortError
from acts_core.frames import SampleFrame
from acts_core.raster_ascii import RasterDecoder
from acts_core.wire import StreamDecoder
from acts_driver.selftest.record import FrameRecord
from acts_driver.source import SerialSource

_REPLY_S = 0.5
_TRIES = 4
_SILENT_S = 5.0
_SETTLE_FRAMES = 3


class BoardReader:
    """Reads one board; use it in a ``with``.

    Parameters
    ----------
    port : str
        A path, ``auto`` or ``serial:NUMBER``.
    protocol : str
        ``binary`` or ``raster_ascii``.
    rows, cols : int
        Size of the array, for ``raster_ascii``, which does not tell it.
    """

    def __init__(self, port: str, protocol: str, rows: int, cols: int) -> None:
        self._source = SerialSource(port)
        self._reply: Reply | None = None
        self._is_binary = protocol == "binary"
        self._decoder: DelimitedDecoder = (
            StreamDecoder(on_message=self._keep_reply) if self._is_binary else RasterDecoder(rows, cols)
        )
        self._request = time.monotonic_ns() & 0xFFFFFFFF

    def __enter__(self) -> BoardReader:
        self._source.open()
        self._decoder.reset()
        return self

    def __exit__(self, *_: object) -> None:
        self._source.close()

    @property
    def name(self) -> str:
        """What a person calls the port."""
        return self._source.name

    @property
    def has_board_clock(self) -> bool:
        """Whether the frames carry a clock."""
        return self._decoder.has_board_clock

    def query(self) -> Reply | None:
        """The board's state; None where it does not understand commands."""
        return self._exchange(encode_query) if self._is_binary else None

    @contextmanager
    def full_frames(self, own: BoardSettings) -> Iterator[BoardSettings]:
        """Let the board measure all taxels of every frame, as fast as it can; its `own` settings come back at the end.

        Yields
        ------
        BoardSettings
            What is in force; `own` where the board does not do it.
        """
        wanted = replace(own, scheme="raster", output="samples", frame_period_us=0)
        try:
            reply = self._exchange(lambda request: encode_configure(request, wanted))
            yield wanted if reply is not None and reply.ok else own
        finally:
            self._exchange(lambda request: encode_configure(request, own))

    def first_frame(self) -> SampleFrame:
        """The next frame but a few, which may have been measured under other settings.

        Raises
        ------
        PortError
            When none comes.
        """
        seen: list[SampleFrame] = []
        self._read_while(lambda: len(seen) <= _SETTLE_FRAMES, lambda frame, arrival_ns: seen.append(frame), _SILENT_S)
        if not seen:
            raise PortError(
                f"no frames from {self.name} within {_SILENT_S:g} s: {self._decoder.last_error or 'it is silent'}; "
                "is it an ACTS board (--protocol), and is it running?"
            )
        return seen[-1]

    def record(self, rows: int, cols: int, seconds: float, on_frame: Callable[[FrameRecord], None]) -> FrameRecord:
        """Keep the frames of some seconds; frames of another size are left out.

        Parameters
        ----------
        rows, cols : int
        seconds : float
        on_frame : callable
            Called with the record so far after every frame.
        """
        record = FrameRecord(rows, cols)
        end_s = time.monotonic() + seconds

        def take(frame: SampleFrame, arrival_ns: int) -> None:
            if (frame.rows, frame.cols) == (rows, cols):
                record.add(frame, arrival_ns)
                on_frame(record)

        self._read_while(lambda: time.monotonic() < end_s, take, seconds)
        return record

    def _read_while(
        self, condition: Callable[[], bool], take: Callable[[SampleFrame, int], None], longest_s: float
    ) -> None:
        end_s = time.monotonic() + longest_s
        while condition() and time.monotonic() < end_s:
            data = self._source.read()
            arrival_ns = time.time_ns()
            for frame in self._decoder.feed(data):
                take(frame, arrival_ns)

    def _keep_reply(self, message: BoardMessage) -> None:
        if isinstance(message, Reply) and message.request == self._request:
            self._reply = message

    def _exchange(self, encode: Callable[[int], bytes]) -> Reply | None:
        """A command and its reply; repeated where none comes, which is harmless. None where none ever comes."""
        self._request = (self._request + 1) & 0xFFFFFFFF
        self._reply = None
        packet = encode(self._request)
        for _ in range(_TRIES):
            self._source.write(packet, _REPLY_S)
            self._read_while(lambda: self._reply is None, lambda frame, arrival_ns: None, _REPLY_S)
            if self._reply is not None:
                break
        return self._reply
