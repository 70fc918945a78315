# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Thinning a stream to a rate."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable


class RateLimit:
    """Says which of the frames that come are due so that no more than `rate_hz` a second are.

    Due times lie on a fixed grid where frames come steadily, so that the rate is the one asked for; after a pause the
    grid begins anew.

    Parameters
    ----------
    rate_hz : float
        0: every frame is due.
    """

    def __init__(self, rate_hz: float) -> None:
        self.set_rate(rate_hz)
        self._next_s = 0.0
        self.taken = 0
        """Frames that were due so far."""

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate, from the next due frame on."""
        self._period_s = 1.0 / rate_hz if rate_hz > 0 else 0.0

    def due(self, now_s: float) -> bool:
        """Whether the frame that came at `now_s` (monotonic) is due; if so, it counts as taken."""
        if now_s < self._next_s:
            return False
        on_time = now_s < self._next_s + self._period_s
        self._next_s = (self._next_s if on_time else now_s) + self._period_s
        self.taken += 1
        return True


class Turns:
    """Says which of several outputs are due with a frame, so that no frame bears the work of all of them.

    Each is due at most `rate_hz` times a second, and one with a frame. Where frames are so rare that outputs still wait
    when the next round begins, those are due together.

    Parameters
    ----------
    rate_hz : float
        0: every frame begins a round.
    """

    def __init__(self, rate_hz: float) -> None:
        self._limit = RateLimit(rate_hz)
        self._waiting: deque[str] = deque()

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate, from the next round on."""
        self._limit.set_rate(rate_hz)

    def due(self, now_s: float, wanted: Iterable[str]) -> list[str]:
        """Which outputs are due with the frame that came at `now_s` (monotonic).

        Parameters
        ----------
        now_s : float
        wanted : iterable of str
            The outputs of the next round, if one begins now.
        """
        due: list[str] = []
        if self._limit.due(now_s):
            due += self._waiting
            self._waiting = deque(wanted)
        if self._waiting:
            due.append(self._waiting.popleft())
        return due
