# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics of the messages of one topic: received, missing, and their delay. Does not depend on ROS."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from acts_core.runtime import Pace, StreamCounter


@dataclass(frozen=True)
class Interval:
    """Statistics of a topic since the previous interval.

    Attributes
    ----------
    seconds : float
        Length of the interval [s].
    received : int
        Messages received.
    lost : int or None
        Messages missing by their sequence numbers; None for messages without numbers.
    median_ms, largest_ms : float or None
        Age of the messages at arrival, by their stamps [ms]; None without stamps.
    total_received, total_lost
        The same counts since the start.
    silent_s : float or None
        Time since the last message [s]; None before the first.
    is_silent : bool
        Whether that is longer than usual, see `acts_core.runtime.Pace`.
    """

    seconds: float
    received: int
    lost: int | None
    median_ms: float | None
    largest_ms: float | None
    total_received: int
    total_lost: int | None
    silent_s: float | None
    is_silent: bool


@dataclass
class Arrivals:
    """Counts the messages of one topic.

    Attributes
    ----------
    begin_s : float
        Start, on the same clock as all other times [s].
    """

    begin_s: float
    _received: int = 0
    _reported: int = 0
    _reported_lost: int = 0
    _pace: Pace = field(default_factory=Pace)
    _counter: StreamCounter = field(default_factory=StreamCounter)
    _ages_s: list[float] = field(default_factory=list)

    def add(self, now_s: float, sequence: int | None, age_s: float | None) -> None:
        """Add a message; `sequence` and `age_s` [s] are None where it has none."""
        self._received += 1
        self._pace.step(now_s)
        if age_s is not None:
            self._ages_s.append(age_s)
        if sequence is not None:
            self._counter.step(sequence, 0.0)

    def take(self, now_s: float) -> Interval:
        """Statistics since the last call."""
        self._counter.take_latencies()
        is_numbered = self._counter.received > 0
        ages_ms = np.array(self._ages_s) * 1e3
        interval = Interval(
            seconds=now_s - self.begin_s,
            received=self._received - self._reported,
            lost=self._counter.lost - self._reported_lost if is_numbered else None,
            median_ms=round(float(np.median(ages_ms)), 3) if ages_ms.size else None,
            largest_ms=round(float(ages_ms.max()), 3) if ages_ms.size else None,
            total_received=self._received,
            total_lost=self._counter.lost if is_numbered else None,
            silent_s=None if self._pace.last_s is None else now_s - self._pace.last_s,
            is_silent=self._pace.is_silent(now_s),
        )
        self.begin_s = now_s
        self._reported, self._reported_lost = self._received, self._counter.lost
        self._ages_s.clear()
        return interval
