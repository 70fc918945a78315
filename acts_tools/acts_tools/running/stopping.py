# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Ctrl-C, SIGTERM and SIGHUP as a flag, so that a loop ends between two steps, never within one."""

from __future__ import annotations

import signal
import time
from types import FrameType, TracebackType

_SLICE_S = 0.1


class StopFlag:
    """Context in which the first SIGINT, SIGTERM or SIGHUP sets a flag; SIGHUP stays ignored under nohup.

    rclpy's own handlers must be off: ``rclpy.init(signal_handler_options=SignalHandlerOptions.NO)``.
    """

    def __init__(self) -> None:
        self.is_set = False
        self._previous: dict[int, object] = {}

    def __enter__(self) -> StopFlag:
        """Install the handlers."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if number is signal.SIGHUP and signal.getsignal(number) is signal.SIG_IGN:
                continue
            self._previous[number] = signal.signal(number, self._set)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Restore the handlers."""
        for number, handler in self._previous.items():
            signal.signal(number, handler)  # type: ignore[arg-type]

    def sleep_until(self, deadline_s: float) -> bool:
        """Sleep until a time of the monotonic clock [s]; False as soon as the flag is set."""
        while not self.is_set:
            remaining_s = deadline_s - time.monotonic()
            if remaining_s <= 0:
                return True
            # In slices, because a signal does not end a sleep.
            time.sleep(min(remaining_s, _SLICE_S))
        return False

    def _set(self, _number: int, _frame: FrameType | None) -> None:
        self.is_set = True
