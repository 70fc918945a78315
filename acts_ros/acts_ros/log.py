# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The logger of a node, for code that does not depend on ROS."""

from __future__ import annotations

from rclpy.node import Node

from acts_core.runtime import LogCallback


def log_of(node: Node) -> LogCallback:
    """Return a function that logs a sentence at a level ("info", "warning" or "error"), from any thread."""

    def log(level: str, sentence: str) -> None:
        # A line each: rclpy refuses a line that changes its severity.
        if level == "error":
            node.get_logger().error(sentence)
        elif level == "warning":
            node.get_logger().warning(sentence)
        else:
            node.get_logger().info(sentence)

    return log
