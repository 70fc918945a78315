# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statistics of a stream of messages: received, missing, and the latency of each."""

from __future__ import annotations

from array import array

from acts_core.runtime.sequence_numbers import SequenceNumbers


class StreamCounter:
    """Counts messages by their sequence numbers and collects latencies.

    Attributes
    ----------
    received : int
        Since the start.
    """

    def __init__(self) -> None:
        self.received = 0
        self._numbers = SequenceNumbers()
        self._latencies = array("f")

    @property
    def lost(self) -> int:
        """Messages missing since the start; see `SequenceNumbers`."""
        return self._numbers.lost

    def step(self, sequence: int, latency_s: float) -> None:
        """Count a message.

        Parameters
        ----------
        sequence : int
            Its number, modulo 2^32.
        latency_s : float
            From its stamp to its reception [s].
        """
        self.received += 1
        self._numbers.step(sequence)
        self._latencies.append(latency_s)

    def take_latencies(self) -> array[float]:
        """Latencies since the last call [s], float32; a new array each time."""
        latencies, self._latencies = self._latencies, array("f")
        return latencies
