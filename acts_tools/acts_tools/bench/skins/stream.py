# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Counts and latencies of the contacts of one skin."""

from __future__ import annotations

import time

import numpy as np

from acts_core.runtime import StreamCounter
from acts_msgs.msg import Contact
from acts_ros.messages import ns_of
from acts_tools.percentiles import percentiles


class ContactStream:
    """Receives the contacts of a skin like an ordinary subscriber, and stores four bytes of each.

    Attributes
    ----------
    received, lost : int
        Contacts, and frame numbers missing between them, since `begin`.
    silent_s : float
        Time since the last contact, at the last call of `look` [s].
    """

    def __init__(self) -> None:
        self._counter = StreamCounter()
        self._received_before = 0
        self._lost_before = 0
        self._received_at_look = 0
        self._looked_s = 0.0
        self.silent_s = 0.0

    def take(self, message: Contact) -> None:
        """Count a contact: the callback of a subscription."""
        now_ns = time.time_ns()
        self._counter.step(message.sequence, (now_ns - ns_of(message.header.stamp)) * 1e-9)

    def begin(self, now_s: float) -> None:
        """Start counting."""
        self._received_before, self._lost_before = self._counter.received, self._counter.lost
        self._counter.take_latencies()
        self._received_at_look, self._looked_s, self.silent_s = self._counter.received, now_s, 0.0

    def look(self, now_s: float) -> float:
        """Contacts per second since the last call; updates `silent_s`."""
        passed_s, new = now_s - self._looked_s, self._counter.received - self._received_at_look
        self._received_at_look, self._looked_s = self._counter.received, now_s
        self.silent_s = 0.0 if new else self.silent_s + passed_s
        return new / max(passed_s, 1e-9)

    @property
    def ever_received(self) -> int:
        """Number of contacts since construction."""
        return self._counter.received

    @property
    def received(self) -> int:
        """Number of contacts since `begin`."""
        return self._counter.received - self._received_before

    @property
    def lost(self) -> int:
        """Number of frame numbers missing between contacts since `begin`."""
        return self._counter.lost - self._lost_before

    def take_latencies_ms(self) -> dict[str, float | None]:
        """``median``, ``p99``, ``p999`` and ``max`` from stamp to callback since `begin` [ms]; to be called once."""
        latencies_ms = np.asarray(self._counter.take_latencies(), dtype=np.float64) * 1e3
        summed = percentiles(latencies_ms)
        summed["max"] = round(float(latencies_ms.max()), 3) if latencies_ms.size else None
        return summed
