# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics of a stream of messages: received, missing, and the latency of each."""

from __future__ import annotations

from array import array

_MODULUS = 1 << 32


class StreamCounter:
    """Counts messages by their sequence numbers and collects latencies.

    Attributes
    ----------
    received, lost : int
        Since the start. A number that goes back is a source that began anew, not a loss.
    """

    def __init__(self) -> None:
        self.received = 0
        self.lost = 0
        self._next = -1
        self._latencies = array("f")

    def step(self, sequence: int, latency_s: float) -> None:
        """Count a message.

        Parameters
        ----------
        sequence : int
            Its number, modulo 2^32.
        latency_s : float
            From its stamp to its reception [s].
        """
        if self.received:
            missing = (sequence - self._next) % _MODULUS
            if missing < _MODULUS // 2:
                self.lost += missing
        self.received += 1
        self._next = sequence + 1
        self._latencies.append(latency_s)

    def take_latencies(self) -> array[float]:
        """Latencies since the last call [s], float32; a new array each time."""
        latencies, self._latencies = self._latencies, array("f")
        return latencies
