# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Subscribe to a topic as soon as it appears, and print its messages."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from acts_ros.bags.message_types import message_class
from acts_ros.bags.qos import for_subscription
from acts_tools.echo.message_text import message_text


class Printer:
    """Prints the messages of a topic to standard output.

    Parameters
    ----------
    node : Node
        Node of the subscription; the caller spins it.
    topic : str
        Full name.
    number : int or None
        Of messages to print; None for all.

    Attributes
    ----------
    is_found : bool
        Whether the topic has appeared.
    printed : int
        Number of messages that were printed.
    """

    def __init__(self, node: Node, topic: str, number: int | None) -> None:
        self.is_found = False
        self.printed = 0
        self._node = node
        self._topic = topic
        self._number = number

    @property
    def is_done(self) -> bool:
        """Whether all messages that are wanted have been printed."""
        return self.printed == self._number

    def discover(self) -> None:
        """Subscribe once the topic has a publisher; to be called regularly.

        Raises
        ------
        RecordingError
            Its type is not installed.
        """
        if self.is_found:
            return
        offers = self._node.get_publishers_info_by_topic(self._topic)
        if offers:
            self.is_found = True
            kind = message_class(offers[0].topic_type)
            self._node.create_subscription(kind, self._topic, self._print, for_subscription(offers))

    def _print(self, message: Any) -> None:
        if not self.is_done:
            self.printed += 1
            print(f"{message_text(message)}---", flush=True)
