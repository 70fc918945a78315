# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How often the messages of a stream come, and how long a silence of it is nothing unusual."""

from __future__ import annotations

from collections import deque

_INTERVALS = 5
_SLOWEST_S = 1.0


class Pace:
    """The usual interval between the messages of a stream: the median of the last five.

    A limit that suits 1 kHz would call a stream of 5 Hz silent before each of its messages. `limit_s` makes such a
    limit follow the stream.

    Attributes
    ----------
    last_s : float or None
        When the last message came [s]; None before the first.
    """

    def __init__(self) -> None:
        self._intervals_s: deque[float] = deque(maxlen=_INTERVALS)
        self.last_s: float | None = None

    def step(self, time_s: float, messages: int = 1) -> None:
        """Note that messages have come.

        Parameters
        ----------
        time_s : float
            The time of the last of them, on any clock [s].
        messages : int
            How many have come since the last call; at least one.
        """
        if self.last_s is not None:
            self._intervals_s.append((time_s - self.last_s) / messages)
        self.last_s = time_s

    @property
    def interval_s(self) -> float:
        """The usual interval [s]; 0 where none is known, and at most 1, the longest of any board."""
        intervals_s = sorted(self._intervals_s)
        return min(max(intervals_s[(len(intervals_s) - 1) // 2], 0.0), _SLOWEST_S) if intervals_s else 0.0

    def limit_s(self, shortest_s: float, intervals: float = 2.5) -> float:
        """The silence from which on something is wrong [s]: so many usual intervals, and at least `shortest_s`."""
        return max(shortest_s, intervals * self.interval_s)

    def is_silent(self, now_s: float, shortest_s: float = 0.0) -> bool:
        """Whether no message has come for longer than `limit_s`, or none at all, or the clock was set back."""
        return self.last_s is None or not 0.0 <= now_s - self.last_s <= self.limit_s(shortest_s)
