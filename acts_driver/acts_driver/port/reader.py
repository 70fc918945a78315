# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The thread that reads a source, decodes and hands frames on, and opens the source again whenever it is lost."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from acts_core.errors import ActsError
from acts_core.frames import SampleFrame
from acts_core.runtime import LogCallback, RealtimeConfig, enter_realtime
from acts_driver.port.source import READ_TIMEOUT_S, Source
from acts_driver.protocols import Decoder

FramesCallback = Callable[[list[SampleFrame], int], None]
"""Takes frames that were read together and the host time of their arrival [ns], on the reader's thread.

There may be none of them where `Reader` was told to look for results."""

_FIRST_RETRY_S = 0.02
_STOP_S = 5.0
_DISCARDED_S = 1.0


class Reader:
    """Reads a source on a thread of its own until it is stopped.

    The decoder handles bad bytes; they never cause the port to be opened again. Exceptions of the consumer are logged
    and counted, and reading goes on. A lost source is opened again at once, then after waits that double from 0.02 s up
    to `reconnect_s`, until bytes come; loss and recovery are logged once each.

    Parameters
    ----------
    source : Source
        Open already, or else opened by the thread.
    decoder : Decoder
        Used by the reader's thread alone; its counters may be read from any.
    on_frames : callable
        See `FramesCallback`.
    has_results : callable
        Whether the bytes just decoded held anything besides frames that `on_frames` is to be called for.
    reconnect_s : float
        Longest wait between two attempts to open a lost source [s].
    realtime : RealtimeConfig or None
        How the process is scheduled once its first frames have been handed on.
    log : callable
        See `acts_core.runtime.LogCallback`; called on the reader's thread.
    on_reconnect : callable or None
        Called on the reader's thread when a lost source is open again, before its first frame.

    Attributes
    ----------
    connected : bool
        Whether the source is open.
    problem : str
        Why it is not, for a person; empty while it is.
    reconnects : int
        How many times a lost source was opened again.
    consumer_errors : int
        How many times `on_frames` raised.
    """

    def __init__(
        self,
        source: Source,
        decoder: Decoder,
        on_frames: FramesCallback,
        *,
        has_results: Callable[[], bool] = lambda: False,
        reconnect_s: float = 0.5,
        realtime: RealtimeConfig | None = None,
        log: LogCallback = lambda level, message: None,
        on_reconnect: Callable[[], None] | None = None,
    ) -> None:
        self._source = source
        self._decoder = decoder
        self._on_frames = on_frames
        self._on_reconnect = on_reconnect
        self._has_results = has_results
        self._reconnect_s = reconnect_s
        self._realtime = realtime
        self._log = log
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="acts_reader", daemon=True)
        self._consumer_errors_told: set[tuple[type, str, int]] = set()
        self._discards = False
        self._discarded_s = -_DISCARDED_S
        self._is_asked = False
        # Before the next attempt to open the source.
        self._wait_s = 0.0
        # The loss that was logged last; told again once bytes have come. And whether its end is yet to be logged.
        self._told_loss = ""
        self._tells_end = False
        self._caught_up = threading.Event()
        self.connected = False
        self.problem = ""
        self.reconnects = 0
        self.consumer_errors = 0

    def start(self, *, is_open: bool = False) -> None:
        """Begin to read; `is_open` tells that the source is open already."""
        self.connected = is_open
        self._decoder.reset()
        self._thread.start()

    def stop(self) -> None:
        """End the thread and close the source. May be called again, and before `start`."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(READ_TIMEOUT_S + _STOP_S)
            if self._thread.is_alive():
                self._log("error", f"the reader of {self._source.name} does not end; its consumer is stuck")
                return
        self._source.close()
        self.connected = False

    def discard(self) -> None:
        """Throw away what waits to be read; to be called by `on_frames`."""
        self._discards = True

    def catch_up(self, timeout_s: float) -> bool:
        """Wait until all that has arrived by now is decoded, and say whether it is; from one other thread at a time.

        It is not where that takes longer than `timeout_s`, or where bytes were thrown away within the last second.
        """
        if not self.connected:
            return True
        self._caught_up.clear()
        self._is_asked = True
        is_decoded = self._caught_up.wait(timeout_s)
        return is_decoded and time.monotonic() - self._discarded_s >= _DISCARDED_S

    def _run(self) -> None:
        was_lost = False
        while not self._stop.is_set():
            if not self.connected and not self._open(was_lost):
                return
            try:
                self._read_until_stopped()
            # Also what nobody expects: a thread that has ended reads no more, and nobody would be told.
            except Exception as error:  # noqa: BLE001
                self.connected = False
                self._caught_up.set()
                was_lost = True
                self.problem = _told(error)
                self._source.close()
                if self.problem != self._told_loss:
                    self._told_loss, self._tells_end = self.problem, True
                    self._log("warning", f"{self.problem}; trying again at least every {self._reconnect_s:g} s")

    def _open(self, was_lost: bool) -> bool:
        """Open the source, however long that takes; False when stopped meanwhile."""
        begin = time.monotonic()
        while not self._stop.wait(self._wait_s):
            # Only bytes end the waits: a source may open each time, and be lost when it is read.
            self._wait_s = min(2 * self._wait_s or _FIRST_RETRY_S, self._reconnect_s)
            try:
                self._source.open()
            except Exception as error:  # noqa: BLE001 - as in `_run`
                self.problem = _told(error)
                continue
            self._decoder.reset()
            if was_lost:
                self.reconnects += 1
                if self._on_reconnect is not None:
                    self._on_reconnect()
            if self._tells_end:
                self._tells_end = False
                self._log("info", f"port {self._source.name} is back after {time.monotonic() - begin:.2f} s")
            self.problem = ""
            self.connected = True
            return True
        return False

    def _read_until_stopped(self) -> None:
        read, feed, now_ns, has_results = self._source.read, self._decoder.feed, time.time_ns, self._has_results
        while not self._stop.is_set():
            data = read()
            arrival_ns = now_ns()
            frames = feed(data) if data else []
            # In this order: what arrives after the question need not be decoded for the answer.
            if self._is_asked and not self._source.waits():
                self._is_asked = False
                self._caught_up.set()
            if not data:
                continue
            self._wait_s = 0.0
            self._told_loss = ""
            if frames or has_results():
                self._hand_on(frames, arrival_ns)
                if self._realtime is not None:
                    # Only now: what decodes the first frames may have to be compiled, which is no work for real time.
                    enter_realtime(self._realtime, "driver", self._log)
                    self._realtime = None
            if self._discards:
                self._discards = False
                self._discarded_s = time.monotonic()
                self._source.discard()
                # The packet whose end is gone is no error.
                self._decoder.reset()

    def _hand_on(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        try:
            self._on_frames(frames, arrival_ns)
        except Exception as error:  # noqa: BLE001 - reading goes on, whatever the consumer does
            self.consumer_errors += 1
            # Once for each kind: at 1 kHz a log line a frame would be an error of its own, and numbers in the words
            # make each of them another one.
            kind = (type(error), *_place_of(error))
            if kind not in self._consumer_errors_told:
                self._consumer_errors_told.add(kind)
                self._log("error", f"frames could not be handed on: {type(error).__name__}: {error}")


def _place_of(error: Exception) -> tuple[str, int]:
    """File and line that raised it."""
    at = error.__traceback__
    while at is not None and at.tb_next is not None:
        at = at.tb_next
    return ("", 0) if at is None else (at.tb_frame.f_code.co_filename, at.tb_lineno)


def _told(error: Exception) -> str:
    return str(error) if isinstance(error, ActsError) else f"{type(error).__name__}: {error}"
