# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When old frames are to be thrown away because the machine does not catch up."""

from __future__ import annotations

_LATE_NS = 50_000_000
_PATIENCE_NS = 500_000_000
# The board's own queue moves up after what was thrown away.
_PAUSE_NS = 100_000_000


class BacklogWatch:
    """Tells a backlog that lasts from one that a machine catches up with.

    After a short stall every frame is still read. Where frames stay more than 50 ms late for half a second, the machine
    is too slow for all of them: then fewer frames that are fresh are worth more than all frames too late.
    """

    def __init__(self) -> None:
        self._since_ns: int | None = None

    def lasts(self, arrival_ns: int, delay_ns: int) -> bool:
        """Whether to throw away what waits to be read; at most ten times a second.

        Parameters
        ----------
        arrival_ns : int
            When the newest frame was read [ns].
        delay_ns : int
            How late that was [ns].
        """
        if delay_ns <= _LATE_NS:
            self._since_ns = None
            return False
        if self._since_ns is None or arrival_ns < self._since_ns:
            self._since_ns = arrival_ns
        if arrival_ns - self._since_ns < _PATIENCE_NS:
            return False
        self._since_ns = arrival_ns - _PATIENCE_NS + _PAUSE_NS
        return True
