# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Configures and activates a lifecycle node by itself."""

from __future__ import annotations

from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.timer import Timer

from acts_driver.nodes.transitions import attempt
from acts_ros.clocks import steady_timer


class Autostart:
    """Tries to configure a node at once and then again and again; where that succeeds, the node is activated.

    Parameters
    ----------
    node : LifecycleNode
        Spun by an executor, on which the transitions run: a signal in a constructor would meet a half-made node.
    period_s : float
        Time between two attempts [s].
    waits_for : str
        What is missing where an attempt fails, for the log.
    """

    def __init__(self, node: LifecycleNode, period_s: float, waits_for: str) -> None:
        self._node = node
        self._waits_for = waits_for
        self._is_waiting = False
        self._first: Timer = steady_timer(node, 0.001, self._try_first)
        self._again: Timer = steady_timer(node, period_s, self._try)
        self._is_over = False

    def stop(self) -> None:
        """Stop changing the node's state. May be called again, also from a transition."""
        self._is_over = True
        # Not destroyed: this may be called from one of them.
        self._first.cancel()
        self._again.cancel()

    def _try_first(self) -> None:
        self._first.cancel()
        self._try()

    def _try(self) -> None:
        if self._is_over:
            return
        if attempt(self._node, self._node.trigger_configure) == TransitionCallbackReturn.SUCCESS:
            self.stop()
            attempt(self._node, self._node.trigger_activate)
        elif not self._is_waiting:
            self._is_waiting = True
            self._node.get_logger().info(f"waiting for {self._waits_for}")
