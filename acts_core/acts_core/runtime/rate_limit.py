# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Thinning a stream to a rate."""

from __future__ import annotations


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

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate, from the next due frame on."""
        self._period_s = 1.0 / rate_hz if rate_hz > 0 else 0.0

    def due(self, now_s: float) -> bool:
        """Whether the frame that came at `now_s` (monotonic) is due; if so, the next one is due a period later."""
        if now_s < self._next_s:
            return False
        on_time = now_s < self._next_s + self._period_s
        self._next_s = (self._next_s if on_time else now_s) + self._period_s
        return True
