# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Observe a running ROS graph in a test: wait for publishers and messages, with deadlines and without sleeps."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

from acts_ros.bags.qos import for_subscription

_TURN_S = 0.05


class Probe:
    """A node in its own context, so that tests with different domain ids do not affect each other.

    Parameters
    ----------
    domain_id : int
        ROS domain.
    while_waiting : callable
        Called repeatedly while waiting; may raise to end a useless wait.
    """

    def __init__(self, domain_id: int, while_waiting: Callable[[], None] = lambda: None) -> None:
        self._while_waiting = while_waiting
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain_id)
        self.node = rclpy.create_node("probe", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)

    def close(self) -> None:
        """Destroy the node and its context."""
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()

    def __enter__(self) -> Probe:
        """Nothing more to set up."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close."""
        self.close()

    def wait_for(self, predicate: Callable[[], bool], timeout_s: float, what: str) -> None:
        """Run callbacks until a condition is true.

        Raises
        ------
        AssertionError
            It is not true within `timeout_s` [s]; the message contains `what`.
        """
        deadline_s = time.monotonic() + timeout_s
        while not predicate():
            self._while_waiting()
            assert time.monotonic() < deadline_s, f"waited {timeout_s:g} s in vain for {what}"
            self._executor.spin_once(timeout_sec=_TURN_S)

    def wait_for_publisher(self, topic: str, timeout_s: float = 30.0) -> None:
        """Wait until a topic has a publisher."""
        self.wait_for(lambda: self.node.count_publishers(topic) > 0, timeout_s, f"a publisher of {topic}")

    def wait_for_node(self, name: str, timeout_s: float = 30.0) -> None:
        """Wait until there is a node with a full name, such as ``/plate/driver``."""
        namespace, _, short = name.rpartition("/")
        wanted = (short, namespace or "/")
        # A node is announced separately from its topics, often after the first messages.
        self.wait_for(lambda: wanted in self.node.get_node_names_and_namespaces(), timeout_s, f"the node {name}")

    def wait_for_messages(
        self,
        topic: str,
        message_type: type,
        count: int,
        timeout_s: float = 30.0,
        is_wanted: Callable[[Any], bool] = lambda _message: True,
    ) -> list[Any]:
        """Subscribe with the quality of service of the publishers, and wait for some messages that are wanted.

        Where several nodes publish on a topic, wait with `is_wanted`, not by calls one after the other: each call
        subscribes anew, and may then always miss the same publisher.
        """
        self.wait_for_publisher(topic, timeout_s)
        received: list[Any] = []

        def take(message: Any) -> None:
            if is_wanted(message):
                received.append(message)

        offers = self.node.get_publishers_info_by_topic(topic)
        subscription = self.node.create_subscription(message_type, topic, take, for_subscription(offers))
        try:
            self.wait_for(lambda: len(received) >= count, timeout_s, f"{count} messages on {topic}")
        finally:
            self.node.destroy_subscription(subscription)
        return received[:count]

    def wait_for_message(
        self,
        topic: str,
        message_type: type,
        timeout_s: float = 30.0,
        is_wanted: Callable[[Any], bool] = lambda _message: True,
    ) -> Any:
        """The first message on a topic that is wanted."""
        return self.wait_for_messages(topic, message_type, 1, timeout_s, is_wanted)[0]
