# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A node of the hand as a process, and a user's node beside it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from peers import Peers
from rclpy.node import Node

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
    user = Peers(domain_id, "user")

    def look() -> None:
        assert process.poll() is None

    try:
        yield process, user.peer, lambda condition: user.until(condition, look)
    finally:
        process.kill()
        process.wait()
        user.close()
