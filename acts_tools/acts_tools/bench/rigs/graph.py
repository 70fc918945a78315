# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A ROS node that spins in short slices, so that a measurement can be stopped."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType

import rclpy
from rclpy.signals import SignalHandlerOptions

from acts_core.errors import LaunchError
from acts_ros import middleware
from acts_ros.executor import make_executor, spin_for
from acts_ros.polled import PollingNode
from acts_tools.bench.rigs.processes import NAMESPACE
from acts_tools.bench.workbench import Workbench

_SLICE_S = 0.05


class Graph:
    """Context in which ROS is initialised.

    Parameters
    ----------
    workbench : Workbench
        Stop flag: ends the spinning when the user wants to stop.

    Attributes
    ----------
    node : PollingNode
        Named "bench", in the skin's namespace; the executor calls it back.
    """

    def __init__(self, workbench: Workbench) -> None:
        self._workbench = workbench

    def __enter__(self) -> Graph:
        """Initialise ROS and make the node."""
        middleware.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        self.node = PollingNode("bench", namespace=NAMESPACE)
        self._executor = make_executor()
        self._executor.add_node(self.node)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Destroy the node and shut ROS down."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()

    def spin_until(
        self, condition: Callable[[], object], timeout_s: float, what: str, check: Callable[[], None] | None = None
    ) -> None:
        """Run callbacks until a condition is true.

        Parameters
        ----------
        condition : callable
            Checked every twentieth of a second.
        timeout_s : float
            Longest wait [s].
        what : str
            Description of the condition, for the error.
        check : callable or None
            Raises an error when waiting is useless.

        Raises
        ------
        LaunchError
            When the time is over.
        """
        deadline_s = time.monotonic() + timeout_s
        while not condition():
            self._workbench.check_stop()
            if check is not None:
                check()
            if time.monotonic() > deadline_s:
                raise LaunchError(f"waited {timeout_s:g} s in vain for {what}")
            self.spin_slice(_SLICE_S)

    def spin_slice(self, seconds: float) -> None:
        """Run callbacks for a while [s], without checking the stop flag."""
        spin_for(self._executor, seconds)

    def spin_for(self, seconds: float, check: Callable[[], None] | None = None) -> None:
        """Run callbacks for a while [s]; `check` as of `spin_until`."""
        end_s = time.monotonic() + seconds
        self.spin_until(lambda: time.monotonic() >= end_s, seconds + 60.0, "time to pass", check)
