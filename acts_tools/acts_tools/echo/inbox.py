# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Subscribe to a topic as soon as it appears, and keep its messages until they are taken."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import Any

from rclpy.node import Node
from rclpy.subscription import Subscription

from acts_ros.bags.message_types import message_class
from acts_ros.bags.qos import for_subscription, is_too_strict
from acts_ros.executor import destroy_subscription


class Inbox:
    """The messages of a topic that nobody has taken yet.

    Parameters
    ----------
    node : Node
        Node of the subscription; the caller spins it.
    topic : str
        Full name.
    """

    def __init__(self, node: Node, topic: str) -> None:
        self._subscription: Subscription | None = None
        self._node = node
        self._topic = topic
        self._messages: deque[Any] = deque()

    @property
    def is_found(self) -> bool:
        """Whether the topic has appeared."""
        return self._subscription is not None

    def discover(self) -> None:
        """Subscribe once the topic has a publisher, and again once one joins that offers less; to be called regularly.

        Raises
        ------
        RecordingError
            Its type is not installed.
        """
        offers = self._node.get_publishers_info_by_topic(self._topic)
        if not offers:
            return
        if self._subscription is not None:
            if not is_too_strict(self._subscription.qos_profile, offers):
                return
            destroy_subscription(self._node, self._subscription)
        kind = message_class(offers[0].topic_type)
        self._subscription = self._node.create_subscription(kind, self._topic, self._keep, for_subscription(offers))

    def take(self) -> Iterator[Any]:
        """The messages, the oldest first."""
        while self._messages:
            yield self._messages.popleft()

    def _keep(self, message: Any) -> None:
        self._messages.append(message)
