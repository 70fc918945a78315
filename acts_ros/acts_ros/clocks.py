"""The clocks of nodes: timers that no clock holds up, and nodes that must not run on simulated time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

_USE_SIM_TIME = "use_sim_time"


def steady_timer(node: Node, period_s: float, callback: Callable[[], Any]) -> Timer:
    """A timer by the steady clock.

    Others of rclpy go by the node's clock. Where that is set back by an hour they rest for an hour, and with simulated
    time for as long as nobody publishes `/clock`.

    Parameters
    ----------
    node : rclpy.node.Node
        On whose executor it runs.
    period_s : float
        [s]
    callback : callable
        Called without arguments.
    """
    return node.create_timer(period_s, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))


def keep_system_clock(node: Node, reason: str) -> None:
    """Let a node go on with the system's clock where `use_sim_time` asks for simulated time, and say so.

    To be called before the node's clock is used. The parameter is false then, and cannot be made true.

    Parameters
    ----------
    node : rclpy.node.Node
        Runs something that does not wait for simulated time, or compares stamps with such a thing.
    reason : str
        Why, for a person.
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
