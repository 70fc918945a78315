# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A function called at a fixed rate in a thread of its own, because a timer of rclpy does not keep 1 kHz."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


class FixedRateThread:
    """Calls `work` at absolute deadlines; missed deadlines are skipped.

    Parameters
    ----------
    rate_hz : float
        Calls per second [Hz].
    work : callable
        Called without arguments; an exception ends the thread and is kept in `failure`.

    Attributes
    ----------
    cycles, missed : int
        Calls so far, and deadlines that were skipped.
    failure : Exception or None
        What ended the thread.
    """

    def __init__(self, rate_hz: float, work: Callable[[], None]) -> None:
        self._period_s = 1.0 / rate_hz
        self._work = work
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="acts_cycle", daemon=True)
        self.cycles = 0
        self.missed = 0
        self.failure: Exception | None = None

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """Stop, and wait until the last call has returned."""
        self._stopped.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        due_s = time.monotonic()
        while not self._stopped.wait(max(0.0, due_s - time.monotonic())):
            try:
                self._work()
            except Exception as error:  # noqa: BLE001 - the owner reports `failure`
                self.failure = error
                return
            self.cycles += 1
            missed = int(max(0.0, time.monotonic() - due_s) / self._period_s)
            self.missed += missed
            due_s += (1 + missed) * self._period_s
