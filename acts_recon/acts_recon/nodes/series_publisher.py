# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``view/contact_series`` of the reconstruction node: every contact in brief, many in a message, for viewers."""

from __future__ import annotations

import time
from array import array

from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.runtime import SequenceNumbers
from acts_msgs.msg import Contact as ContactMessage
from acts_msgs.msg import ContactSeries
from acts_recon.contacts import Contact
from acts_ros import qos

_LONGEST = 1024
_NS_PER_S = 1_000_000_000


class SeriesPublisher:
    """Collects contacts while somebody listens, and publishes them when that is due.

    A subscriber of ``contact`` wakes up for each of a thousand contacts a second; one that only plots them does as well
    with thirty messages a second.

    Parameters
    ----------
    node : Node
    """

    def __init__(self, node: Node) -> None:
        self._publisher = node.create_publisher(ContactSeries, "view/contact_series", **qos.overridable(qos.VIEW))
        self._stamps_ns: list[int] = []
        self._force = array("f")
        self._delay = array("f")
        self._missing = array("I")
        self._newest = Contact()
        self._sequence = 0
        self._numbers = SequenceNumbers()
        self.is_wanted = False
        """Whether somebody listens."""

    def look_for_subscribers(self) -> None:
        """To be called now and then."""
        self.is_wanted = self._publisher.get_subscription_count() > 0
        if not self.is_wanted:
            self._clear()
            self._numbers = SequenceNumbers()

    def add(self, stamp_ns: int, sequence: int, contact: Contact) -> None:
        """Keep a contact that has just been published.

        Parameters
        ----------
        stamp_ns : int
            Of the frame [ns].
        sequence : int
            The frame's number.
        contact : Contact
        """
        if len(self._stamps_ns) == _LONGEST:
            self._clear()
        self._stamps_ns.append(stamp_ns)
        self._force.append(contact.force_n)
        self._delay.append((time.time_ns() - stamp_ns) * 1e-9)
        self._missing.append(self._numbers.step(sequence))
        self._newest, self._sequence = contact, sequence

    def publish(self, header: Header) -> None:
        """Publish what was kept; `header` is that of the newest."""
        if not self._stamps_ns:
            return
        contact, message = self._newest, ContactSeries()
        newest: ContactMessage = message.newest
        newest.header, newest.sequence, newest.in_contact = header, self._sequence, contact.in_contact
        newest.centre_of_pressure.x, newest.centre_of_pressure.y = contact.x_m, contact.y_m
        newest.force, newest.peak, newest.area = contact.force_n, contact.peak_counts, contact.area_m2
        newest.active_taxels, newest.spread = contact.active_taxels, contact.spread_m
        newest.centre_of_pressure_sigma.x, newest.centre_of_pressure_sigma.y = contact.x_sd_m, contact.y_sd_m
        newest.force_sigma, newest.area_sigma, newest.spread_sigma = (
            contact.force_sd_n,
            contact.area_sd_m2,
            contact.spread_sd_m,
        )
        last_ns = self._stamps_ns[-1]
        message.age = array("f", [(last_ns - stamp_ns) / _NS_PER_S for stamp_ns in self._stamps_ns])
        message.force, message.delay, message.missing = self._force, self._delay, self._missing
        self._publisher.publish(message)
        self._clear()

    def _clear(self) -> None:
        self._stamps_ns.clear()
        self._force, self._delay, self._missing = array("f"), array("f"), array("I")
