# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Thinning a stream to a rate."""

from __future__ import annotations

import math


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
        self._period_s = 0.0
        self._next_s = -math.inf
        self.set_rate(rate_hz)

    def set_rate(self, rate_hz: float) -> None:
        """Change the rate: the next frame is due a period of it after the last one."""
        before_s, self._period_s = self._period_s, 1.0 / rate_hz if rate_hz > 0 else 0.0
        self._next_s += self._period_s - before_s

    def due(self, now_s: float) -> bool:
        """Whether the frame that came at `now_s` (monotonic) is due; if so, the next one is due a period later."""
        if now_s < self._next_s:
            return False
        on_time = now_s < self._next_s + self._period_s
        self._next_s = (self._next_s if on_time else now_s) + self._period_s
        return True
