# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How long the cycles of a hand take, collected between two messages that tell it."""

from __future__ import annotations

from array import array


class CycleTimes:
    """Filled by the thread of the hand's loop, emptied by the one that publishes.

    Attributes
    ----------
    cycles : int
        Since the start.
    """

    def __init__(self) -> None:
        self.cycles = 0
        self._durations = array("f")
        self._latencies = array("f")

    def add(self, duration_s: float, latency_s: float | None) -> None:
        """Count a cycle.

        Parameters
        ----------
        duration_s : float
            From its begin until the goals were sent [s].
        latency_s : float or None
            From the last measurement of the newest touch until then [s]; None without new touch.
        """
        self.cycles += 1
        self._durations.append(duration_s)
        if latency_s is not None:
            self._latencies.append(latency_s)

    def take(self) -> tuple[array[float], array[float]]:
        """Durations and latencies since the last call [s], float32; new arrays each time."""
        durations, self._durations = self._durations, array("f")
        latencies, self._latencies = self._latencies, array("f")
        return durations, latencies
