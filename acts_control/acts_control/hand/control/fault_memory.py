# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How often each motor of a hand has switched itself off of late."""

from __future__ import annotations

import time
from collections import deque

_MEMORY_S = 60.0


class FaultMemory:
    """Counts the faults of each motor within a minute; `forget` may be called from any thread.

    Parameters
    ----------
    motors : int
    most : int
        With so many a motor has failed too often.
    """

    def __init__(self, motors: int, most: int) -> None:
        self._times_s: list[deque[float]] = [deque(maxlen=most) for _ in range(motors)]
        self._most = most

    def add(self, motor: int) -> bool:
        """Count a fault that has come now; whether the motor has failed too often."""
        times_s, now_s = self._times_s[motor], time.monotonic()
        times_s.append(now_s)
        return len(times_s) == self._most and now_s - times_s[0] < _MEMORY_S

    def forget(self) -> None:
        """Begin anew."""
        for times_s in self._times_s:
            times_s.clear()
