# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Clocks of nodes: timers that a change of the clock does not stop, nodes that refuse simulated time, and stalls."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer

_USE_SIM_TIME = "use_sim_time"

# Who has had no answer for so long may have given up, and may have come near what he wanted to move.
_STALL_S = 1.0
_LOOK_PERIOD_S = 0.1


def boot_time_s() -> float:
    """The steady clock that, unlike `time.monotonic`, also runs while the machine sleeps: CLOCK_BOOTTIME [s]."""
    return time.clock_gettime(time.CLOCK_BOOTTIME)


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


class Stalls:
    """Notices that a node has stood still: what was asked for meanwhile arrives afterwards as if it were new.

    It stands still while its process does: Ctrl-Z, Ctrl-S in its terminal, a debugger, a machine that is too busy or
    sleeps.

    Parameters
    ----------
    node : rclpy.node.Node
        Its executor serves what is asked for.
    longest_s : float
        How long it may stand still without consequences, and how long afterwards requests count as old [s].
    """

    def __init__(self, node: Node, longest_s: float = _STALL_S) -> None:
        self._longest_s = longest_s
        self._looked_s = self._ended_s = -math.inf
        self._stood_still_s = 0.0
        steady_timer(node, _LOOK_PERIOD_S, self._look)

    def begin(self) -> None:
        """Count from now on, where the executor is about to begin; otherwise from the first tenth of a second on."""
        self._look()

    def objection(self) -> str:
        """Why a motion that is asked for now is to be refused, and what to do; empty where it need not be."""
        if self._look() - self._ended_s > self._longest_s:
            return ""
        return f"this program stood still for {self._stood_still_s:.1f} s, and was perhaps asked meanwhile; ask again"

    def since(self, asked_s: float) -> str:
        """That the node has stood still since a moment, in words; empty where it has not. From any thread.

        Parameters
        ----------
        asked_s : float
            When something was asked for that is about to be done, by CLOCK_BOOTTIME [s].
        """
        # Nothing is noted here: the executor has not looked meanwhile, and what waits for it is as old as before. Where
        # it looks just now, it has noted how long it stood still before it says when it has looked.
        now_s, looked_s = boot_time_s(), self._looked_s
        ended_s, stood_still_s = self._ended_s, self._stood_still_s
        if math.isfinite(looked_s) and now_s - looked_s > self._longest_s:
            ended_s, stood_still_s = now_s, now_s - looked_s
        return f"this program stood still for {stood_still_s:.1f} s" if ended_s >= asked_s else ""

    def _look(self) -> float:
        now_s, before_s = boot_time_s(), self._looked_s
        if math.isfinite(before_s) and now_s - before_s > self._longest_s:
            self._ended_s, self._stood_still_s = now_s, now_s - before_s
        self._looked_s = now_s
        return now_s
