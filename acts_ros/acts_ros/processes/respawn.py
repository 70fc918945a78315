# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How long to wait before a process that has ended is started again."""

from __future__ import annotations

SOON_S = 2.0
"""A process that ran for less than this has failed early [s]."""

LONGEST_WAIT_S = 5.0
"""Upper limit of the doubled wait [s]."""


_LEAST_DOUBLED_S = 0.05


class RespawnWait:
    """Waits before the restarts of one process: exponential backoff while it fails early.

    Parameters
    ----------
    first_s : float
        The wait after the first end, and after every end that was not early [s]. If it exceeds `LONGEST_WAIT_S`, it is
        also the longest wait.
    """

    def __init__(self, first_s: float) -> None:
        self._first_s = first_s
        self._last_s: float | None = None

    def next_s(self, ran_s: float) -> float:
        """The wait before the next start [s], after the process ran for `ran_s` [s]."""
        if self._last_s is None or ran_s > SOON_S:
            self._last_s = self._first_s
        else:
            self._last_s = min(2.0 * max(self._last_s, _LEAST_DOUBLED_S), max(self._first_s, LONGEST_WAIT_S))
        return self._last_s
