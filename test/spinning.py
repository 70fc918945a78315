# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes of a test whose callbacks run in a thread."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from waiting import wait_for


class Spinning:
    """Runs the callbacks of nodes from now until `end`.

    Parameters
    ----------
    context : Context
    nodes : Node
    """

    def __init__(self, context: Context, *nodes: Node) -> None:
        self.executor = SingleThreadedExecutor(context=context)
        for node in nodes:
            self.executor.add_node(node)
        self._ended: Future[None] = Future()
        # Not in slices: where they are shorter than what is due, Jazzy's executor begins anew with the first of it.
        self._thread = threading.Thread(
            target=self.executor.spin_until_future_complete, args=(self._ended,), daemon=True
        )
        self._thread.start()

    def do(self, work: Callable[[], object]) -> None:
        """Do something on the thread that spins, where it meets no callback, and wait for its end."""
        task = self.executor.create_task(work)
        wait_for(task.done, "the executor")
        task.result()

    def end(self) -> None:
        """Let the thread end first: an executor that is shut down while it spins may fail."""
        self._ended.set_result(None)
        self._thread.join()
        self.executor.shutdown()


@contextmanager
def spinning_node(name: str, namespace: str, domain_id: int, furnish: Callable[[Node], None]) -> Iterator[Node]:
    """A node with a context of its own, of which `furnish` has made parameters and services before it spins."""
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    node = Node(name, namespace=namespace, context=context)
    furnish(node)
    spinning = Spinning(context, node)
    try:
        yield node
    finally:
        spinning.end()
        node.destroy_node()
        rclpy.try_shutdown(context=context)
