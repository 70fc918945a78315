# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A node of the hand as a process, and a user's node beside it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from dynamixel_bus import DEADLINE_S
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from waiting import wait_for

Spin = Callable[[Callable[[], bool]], None]


@contextmanager
def node_and_user(
    domain_id: int, *parameters: str, program: str = "hand"
) -> Iterator[tuple[subprocess.Popen[str], Node, Spin]]:
    """The node as a process, a user's node, and how to wait for something."""
    process = subprocess.Popen(
        [
            *(sys.executable, "-c", f"from acts_control.programs import {program}; raise SystemExit({program}())"),
            "--ros-args",
            *(word for parameter in parameters for word in ("-p", parameter)),
        ],
        env={**os.environ, "ROS_DOMAIN_ID": str(domain_id)},
        stderr=subprocess.PIPE,
        text=True,
    )
    context = Context()
    rclpy.init(context=context, domain_id=domain_id)
    node = rclpy.create_node("user", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)

    def turn() -> None:
        assert process.poll() is None
        executor.spin_once(timeout_sec=0.05)

    def until(condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, meanwhile=turn)

    try:
        yield process, node, until
    finally:
        process.kill()
        process.wait()
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
