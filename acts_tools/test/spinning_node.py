# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A node that runs beside a test, in a thread and a context of its own."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node


@contextmanager
def spinning_node(name: str, namespace: str, domain_id: int, furnish: Callable[[Node], None]) -> Iterator[Node]:
    """A node of which `furnish` has made parameters and services before it spins."""
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    node = Node(name, namespace=namespace, context=context)
    furnish(node)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    is_over = threading.Event()

    def spin() -> None:
        while not is_over.is_set():
            executor.spin_once(timeout_sec=0.05)

    spinning = threading.Thread(target=spin)
    spinning.start()
    try:
        yield node
    finally:
        is_over.set()
        spinning.join()
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown(context=context)
