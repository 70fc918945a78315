# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Subscribe to topics as they appear, and count their messages."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.subscription import Subscription

from acts_msgs.msg import Contact, TactileSamples
from acts_ros.bags.message_types import message_class
from acts_ros.bags.qos import for_subscription, is_too_strict
from acts_ros.executor import destroy_subscription
from acts_ros.messages import ns_of
from acts_tools.listen.arrivals import Arrivals
from acts_tools.running.near_names import near_topic

_OF_EVERY_FRAME = (TactileSamples, Contact)


class Listener:
    """Subscribes to topics with the quality of service of their publishers.

    Parameters
    ----------
    node : Node
        Node of the subscriptions; the caller spins it.
    topics : sequence of str
        Full names.

    Attributes
    ----------
    arrivals : dict of str to Arrivals
        Statistics of the topics that have appeared, by topic.
    hints : dict of str to str
        Of each topic that has no publisher yet, what may have been meant (`near_topic`).
    complaints : dict of str to str
        Message of every component whose last report on a diagnostics topic is a warning or an error, by its name.
    complained_s : dict of str to float
        When each of these reports came, CLOCK_MONOTONIC [s].
    """

    def __init__(self, node: Node, topics: Sequence[str]) -> None:
        self.arrivals: dict[str, Arrivals] = {}
        self.hints: dict[str, str] = {}
        self.complaints: dict[str, str] = {}
        self.complained_s: dict[str, float] = {}
        self._node = node
        self._topics = topics
        self._subscriptions: dict[str, Subscription] = {}

    def discover(self) -> None:
        """Subscribe to new topics, and again where a publisher joins that offers less; to be called regularly."""
        types = dict(self._node.get_topic_names_and_types())
        for topic in self._topics:
            offers = self._node.get_publishers_info_by_topic(topic)
            if topic not in types or not offers:
                if topic not in self._subscriptions:
                    self.hints[topic] = near_topic(self._node, topic)
                continue
            self.hints.pop(topic, None)
            present = self._subscriptions.get(topic)
            if present is not None:
                if not is_too_strict(present.qos_profile, offers):
                    continue
                destroy_subscription(self._node, present)
            arrivals = self.arrivals.setdefault(topic, Arrivals(time.monotonic()))
            self._subscriptions[topic] = self._node.create_subscription(
                message_class(types[topic][0]), topic, partial(self._note, arrivals), for_subscription(offers)
            )

    def _note(self, arrivals: Arrivals, message: Any) -> None:
        now_ns = time.time_ns()
        header = getattr(message, "header", None)
        # Of a message without a stamp nobody knows how old it is.
        stamp_ns = 0 if header is None else ns_of(header.stamp)
        age_s = (now_ns - stamp_ns) * 1e-9 if stamp_ns else None
        # Of the others that have the number of a frame not every frame has a message.
        number = message.sequence if isinstance(message, _OF_EVERY_FRAME) else None
        arrivals.add(time.monotonic(), number, age_s)
        if isinstance(message, DiagnosticArray):
            self._note_complaints(message)

    def _note_complaints(self, message: DiagnosticArray) -> None:
        for status in message.status:
            if status.level == b"\x00":
                self.complaints.pop(status.name, None)
                self.complained_s.pop(status.name, None)
            else:
                self.complaints[status.name] = status.message
                self.complained_s[status.name] = time.monotonic()
