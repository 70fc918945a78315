# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes of a test whose callbacks run in a thread."""

from __future__ import annotations

import threading

from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


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

    def end(self) -> None:
        """Let the thread end first: an executor that is shut down while it spins may fail."""
        self._ended.set_result(None)
        self._thread.join()
        self.executor.shutdown()
