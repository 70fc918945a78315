# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Clocks of nodes: timers that a change of the clock does not stop, and nodes that refuse simulated time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

_USE_SIM_TIME = "use_sim_time"


def steady_timer(node: Node, period_s: float, callback: Callable[[], Any]) -> Timer:
    """Create a timer on the steady clock.

    Other timers of rclpy use the node's clock. They stop for an hour where that is set back by an hour, and with
    simulated time for as long as nobody publishes `/clock`.

    Parameters
    ----------
    node : rclpy.node.Node
        On whose executor it runs.
    period_s : float
        Time between two calls [s].
    callback : callable
        Called without arguments.
    """
    return node.create_timer(period_s, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))


def keep_system_clock(node: Node, reason: str) -> None:
    """Keep a node on the system's clock even if `use_sim_time` is true, and log that.

    To be called before the node's clock is used. The parameter becomes false and cannot be set to true.

    Parameters
    ----------
    node : rclpy.node.Node
        Its device does not follow simulated time, or its stamps come from such a device.
    reason : str
        Why simulated time is refused, for the log.
    """

    def refuse(parameters: list[Parameter[Any]]) -> SetParametersResult:
        if any(parameter.name == _USE_SIM_TIME and parameter.value for parameter in parameters):
            return SetParametersResult(
                successful=False, reason=f"{node.get_fully_qualified_name()} runs on the system's clock: {reason}"
            )
        return SetParametersResult(successful=True)

    if node.get_parameter(_USE_SIM_TIME).value:
        node.get_logger().warning(
            f"use_sim_time: {node.get_fully_qualified_name()} does not run on simulated time and goes on with the "
            f"system's clock: {reason}"
        )
        node.set_parameters([Parameter(_USE_SIM_TIME, value=False)])
    node.add_on_set_parameters_callback(refuse)
