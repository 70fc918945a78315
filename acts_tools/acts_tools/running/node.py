# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""ROS in a command, from its initialisation to its end, and the node of one that has a single one."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from acts_ros import middleware
from acts_ros.executables.middleware_watch import watch_middleware
from acts_ros.executor import make_executor


@contextmanager
def ros() -> Iterator[None]:
    """ROS for the length of a block. Signals are left to the command.

    Raises
    ------
    SettingsError
        As of `acts_ros.middleware.init`.
    """
    middleware.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    try:
        yield
    finally:
        rclpy.try_shutdown()


@contextmanager
def command_node(name: str, make: Callable[[], Executor] = make_executor) -> Iterator[tuple[Node, Executor]]:
    """A node without parameters and log topic, and the executor that calls it back, within `ros`.

    Parameters
    ----------
    name : str
        Of the node.
    make : callable
        Makes the executor; by default the one for 1 kHz.
    """
    with ros():
        node = rclpy.create_node(name, start_parameter_services=False, enable_rosout=False)
        executor = make()
        executor.add_node(node)
        watch_middleware(os.environ)
        try:
            yield node, executor
        finally:
            executor.shutdown()
            node.destroy_node()
