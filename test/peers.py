# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes of a test whose callbacks run while it waits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import rclpy
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher
from waiting import wait_for

from acts_ros.publishers import TolerantPublisher

Added = TypeVar("Added", bound=Node)


class _Speaker(Node):
    """Speaks on where the middleware does not take a message, as on a machine without CPU time for its threads."""

    def create_publisher(self, *arguments: Any, **options: Any) -> Publisher[Any]:
        return super().create_publisher(*arguments, **{"publisher_class": TolerantPublisher, **options})


class Peers:
    """Nodes in a context and on an executor of their own, whose callbacks run while the test waits.

    The first of them is `peer`, which speaks and listens for the test.

    Parameters
    ----------
    domain_id : int
    name, namespace : str
        Of `peer`.
    make_executor : callable
    """

    timeout_s = 30.0
    """How long `until` waits at most."""

    turn_s = 0.05
    """How long a turn waits for something to do."""

    def __init__(
        self,
        domain_id: int,
        name: str = "peer",
        namespace: str = "",
        make_executor: Callable[..., Executor] = SingleThreadedExecutor,
    ) -> None:
        self.context = Context()
        rclpy.init(args=[], context=self.context, domain_id=domain_id)
        self.executor = make_executor(context=self.context)
        self._nodes: list[Node] = []
        self.peer = self.add(_Speaker(name, namespace=namespace, context=self.context))

    def add(self, node: Added) -> Added:
        """Run another node's callbacks too, and destroy it at the end."""
        self._nodes.append(node)
        self.executor.add_node(node)
        return node

    def listen(self, kind: type, topic: str, profile: Any) -> list[Any]:
        """What comes on a topic from now on."""
        messages: list[Any] = []
        self.peer.create_subscription(kind, topic, messages.append, profile)
        return messages

    def turn(self) -> None:
        """Run what is due, or wait for it a little."""
        self.executor.spin_once(timeout_sec=self.turn_s)

    def situation(self) -> object:
        """What a wait in vain tells of how things stand."""
        return ""

    def until(
        self, condition: Callable[[], object], meanwhile: Callable[[], object] = lambda: None, what: str = ""
    ) -> None:
        """Run callbacks until a condition holds, and do something before each turn."""

        def turn() -> None:
            meanwhile()
            self.turn()

        wait_for(condition, what, self.timeout_s, turn, self.situation)

    def close(self) -> None:
        """Destroy all nodes."""
        self.executor.shutdown()
        for node in self._nodes:
            node.destroy_node()
        rclpy.try_shutdown(context=self.context)
