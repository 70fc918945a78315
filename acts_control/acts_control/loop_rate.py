# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When the cycles of a control loop begin, and the clock of control loops."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

_LATE_PERIODS = 1.5


def steady_s() -> float:
    """The clock of control loops [s].

    Unlike `time.monotonic` it also runs while the machine sleeps: a loop that goes on in a laptop that is opened again
    has stood still, and what it remembers is old.
    """
    return time.clock_gettime(time.CLOCK_BOOTTIME)


class Cycle(NamedTuple):
    """A cycle that begins.

    Attributes
    ----------
    now_s : float
        When it begins, by the clock of the `LoopRate` [s].
    dt_s : float
        Since the begin of the one before, or of the `LoopRate` [s].
    is_late : bool
        Whether that is more than one and a half periods.
    """

    now_s: float
    dt_s: float
    is_late: bool


class LoopRate:
    """Cycles at a fixed rate, by absolute deadlines.

    After a delay of more than a period it goes on from then: no burst of cycles makes up for lost ones.

    Parameters
    ----------
    period_s : float
        From the begin of a cycle to that of the next [s].
    steady_s, sleep : callable
        The clock that it goes by [s], and how to let it pass; a simulation has its own.
    """

    def __init__(
        self,
        period_s: float,
        steady_s: Callable[[], float] = steady_s,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._period_s = period_s
        self._steady_s = steady_s
        self._sleep = sleep
        self._due_s = self._last_s = steady_s()

    def wait(self) -> Cycle:
        """Wait until the next cycle is due; the first one is after a period."""
        self._due_s += self._period_s
        wait_s = self._due_s - self._steady_s()
        if wait_s > 0.0:
            self._sleep(wait_s)
        elif wait_s < -self._period_s:
            self._due_s -= wait_s
        now_s = self._steady_s()
        dt_s, self._last_s = now_s - self._last_s, now_s
        return Cycle(now_s, dt_s, dt_s > _LATE_PERIODS * self._period_s)
