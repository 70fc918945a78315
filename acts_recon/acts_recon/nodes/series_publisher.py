# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``view/contact_series`` of the reconstruction node: every contact in brief, many in a message, for viewers."""

from __future__ import annotations

import time

import numpy as np
from rclpy.node import Node

from acts_core.runtime import NS_PER_S, SequenceNumbers
from acts_msgs.msg import ContactSeries
from acts_recon.contacts import Contact
from acts_ros import qos
from acts_ros.messages import ContactFields, SeriesFields, write_series
from acts_ros.publishers import published

LONGEST = 1024
"""Contacts in a message at most."""

# A minute is what viewers take. Longer after one another are contacts of a stream that stood still, or of a clock that
# was set.
_LENGTH_MAX_NS = 60 * NS_PER_S

# What the message holds: a stream whose numbers are no count of its frames, as of nanoseconds, misses more.
_MOST_MISSING = 2**32 - 1


class SeriesPublisher:
    """Collects contacts while somebody listens, and publishes them when that is due.

    A subscriber of ``contact`` wakes up for each of a thousand contacts a second; one that only plots them does as well
    with thirty messages a second.

    It has a length, that of what is kept; `LONGEST` is the most that a message holds.

    Parameters
    ----------
    node : Node
    """

    def __init__(self, node: Node) -> None:
        self._publisher = node.create_publisher(ContactSeries, "view/contact_series", **published(qos.VIEW))
        self._stamps_ns: list[int] = []
        self._force_n: list[float] = []
        self._delay_s: list[float] = []
        self._missing: list[int] = []
        self._newest = Contact()
        self._sequence = 0
        self._numbers = SequenceNumbers()
        self._begins_anew = False
        self.is_wanted = False
        """Whether somebody listens."""

    def __len__(self) -> int:
        return len(self._stamps_ns)

    def look_for_subscribers(self) -> None:
        """To be called now and then."""
        is_wanted = self._publisher.get_subscription_count() > 0
        # What is kept belongs to the thread that adds to it.
        self._begins_anew = self._begins_anew or (is_wanted and not self.is_wanted)
        self.is_wanted = is_wanted

    def takes(self, stamp_ns: int) -> bool:
        """Whether a contact of this time [ns] goes with what is kept; if not, `publish` that first."""
        stamps_ns = self._stamps_ns
        if not stamps_ns or self._begins_anew:
            # What was kept for others is forgotten with the next contact.
            return True
        return stamps_ns[-1] <= stamp_ns and stamp_ns - stamps_ns[0] <= _LENGTH_MAX_NS

    def add(self, stamp_ns: int, sequence: int, contact: Contact) -> None:
        """Keep a contact that has just been published; with one too many those before are dropped, and missing.

        Parameters
        ----------
        stamp_ns : int
            Of the frame [ns].
        sequence : int
            The frame's number.
        contact : Contact
        """
        if self._begins_anew:
            self._begins_anew = False
            self._numbers = SequenceNumbers()
            self._clear()
        dropped = 0
        if len(self) == LONGEST:
            dropped = LONGEST + sum(self._missing)
            self._clear()
        self._stamps_ns.append(stamp_ns)
        self._force_n.append(contact.force_n)
        self._delay_s.append((time.time_ns() - stamp_ns) * 1e-9)
        self._missing.append(min(dropped + self._numbers.step(sequence), _MOST_MISSING))
        self._newest, self._sequence = contact, sequence

    def publish(self, frame_id: str) -> None:
        """Publish what was kept, on a skin of this frame."""
        if not self._stamps_ns:
            return
        newest_ns = self._stamps_ns[-1]
        age_s = (newest_ns - np.array(self._stamps_ns, np.int64)) / NS_PER_S
        series = SeriesFields(
            newest=ContactFields(newest_ns, frame_id, self._sequence, *self._newest),
            age_s=age_s.astype(np.float32),
            force_n=np.array(self._force_n, np.float32),
            delay_s=np.array(self._delay_s, np.float32),
            missing=np.array(self._missing, np.uint32),
        )
        self._publisher.publish(write_series(series))
        self._clear()

    def _clear(self) -> None:
        for column in (self._stamps_ns, self._force_n, self._delay_s, self._missing):
            column.clear()
