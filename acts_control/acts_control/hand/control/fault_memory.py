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
        self._motors, self._most = motors, most
        self._times_s = self._none()

    def add(self, motor: int) -> bool:
        """Count a fault that has come now; whether the motor has failed too often."""
        times_s, now_s = self._times_s[motor], time.monotonic()
        times_s.append(now_s)
        return len(times_s) == self._most and now_s - times_s[0] < _MEMORY_S

    def forget(self) -> None:
        """Begin anew."""
        # `add` may be counting in those that there are.
        self._times_s = self._none()

    def _none(self) -> list[deque[float]]:
        return [deque(maxlen=self._most) for _ in range(self._motors)]
