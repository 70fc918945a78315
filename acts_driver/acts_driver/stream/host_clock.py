# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Detects that the system's clock was set, by comparing it with the steady clock."""

from __future__ import annotations

import time
from collections.abc import Callable

# Time synchronisation that does not set the clock makes it run faster or slower by 500 ppm: in a minute less than this.
_STEP_NS = 40_000_000

# Two clocks that were not read at once are not compared.
_AT_ONCE_NS = 1_000_000


def since_boot_ns() -> int:
    """The steady clock that goes on while the machine is suspended [ns]."""
    return time.clock_gettime_ns(time.CLOCK_BOOTTIME)


class HostClock:
    """Compares the system's clock, by which arrivals and stamps are told, with the steady one.

    The steady clock goes on while the machine is suspended, as the system's does: that is no setting of the clock, and
    frames that a board measured before it, and that are read after it, are as old as they are.

    Parameters
    ----------
    system_ns, steady_ns : callable
        The clocks [ns].

    Attributes
    ----------
    step_ns : int
        By how much the system's clock was set when `was_set` last told so [ns].
    """

    def __init__(
        self, system_ns: Callable[[], int] = time.time_ns, steady_ns: Callable[[], int] = since_boot_ns
    ) -> None:
        self._system_ns = system_ns
        self._steady_ns = steady_ns
        self._difference_ns: int | None = None
        self.step_ns = 0

    def now_ns(self) -> int:
        """Time of the system's clock [ns]."""
        return self._system_ns()

    def was_set(self) -> bool:
        """Whether the system's clock was set by more than 40 ms since the last call. Call it regularly."""
        before_ns = self._steady_ns()
        system_ns = self._system_ns()
        if self._steady_ns() - before_ns > _AT_ONCE_NS:
            return False
        last_ns, self._difference_ns = self._difference_ns, system_ns - before_ns
        if last_ns is None or abs(self._difference_ns - last_ns) <= _STEP_NS:
            return False
        self.step_ns = self._difference_ns - last_ns
        return True
