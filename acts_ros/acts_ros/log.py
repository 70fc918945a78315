# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The logger of a node, for code that does not depend on ROS, and which changes of a node's state are worth a line."""

from __future__ import annotations

import time
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from acts_core.runtime import LogCallback

STEADY = Clock(clock_type=ClockType.STEADY_TIME)
"""The clock of lines that are throttled.

By that of the system, which rclpy takes otherwise, they stay away for an hour where it is set back by an hour.
"""

_BURST = 5
_PERIOD_S = 1.0


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


class LoggedChanges:
    """Tells which states and reasons are to be logged: all new states, and new reasons unless they come and go.

    Of reasons in the same state five may follow each other at once, and one more for each second. The last one is due
    as soon as there may be a line again, if it still holds then.

    Parameters
    ----------
    state, reason
        What need not be logged because everything begins with it.
    """

    def __init__(self, state: Any, reason: str) -> None:
        self._state, self._reason = state, reason
        self._lines = float(_BURST)
        self._counted_s = time.monotonic()

    def is_due(self, state: Any, reason: str) -> bool:
        """Whether to log this, which holds now; it counts as logged then."""
        if (state, reason) == (self._state, self._reason):
            return False
        now_s = time.monotonic()
        self._lines = min(self._lines + (now_s - self._counted_s) / _PERIOD_S, _BURST)
        self._counted_s = now_s
        if state == self._state and self._lines < 1.0:
            return False
        self._lines = max(self._lines - 1.0, 0.0)
        self._state, self._reason = state, reason
        return True
