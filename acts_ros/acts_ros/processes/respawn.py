"""How long to wait before a process that has ended is started again."""

from __future__ import annotations

SOON_S = 2.0
"""A process that ends within this time of its start has ended soon [s]."""

LONGEST_WAIT_S = 5.0
"""Waits are doubled up to this [s]."""


class RespawnWait:
    """Waits of one process: short after a crash, longer and longer where it cannot live.

    Parameters
    ----------
    first_s : float
        The wait after the first end, and after every end that was not soon; also the longest one where it is longer
        than `LONGEST_WAIT_S` [s].
    """

    def __init__(self, first_s: float) -> None:
        self._first_s = first_s
        self._last_s: float | None = None

    def next_s(self, ran_s: float) -> float:
        """The wait before the next start, where the process has ended after `ran_s` [s]."""
        if self._last_s is None or ran_s > SOON_S:
            self._last_s = self._first_s
        else:
            self._last_s = min(2.0 * self._last_s, max(self._first_s, LONGEST_WAIT_S))
        return self._last_s
