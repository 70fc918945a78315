# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Publish diagnostics in the standard form: one status per component on /diagnostics, once a second."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from acts_ros.clocks import steady_timer
from acts_ros.publishers import OnlyPublishers, TolerantPublisher

OK = 0
WARN = 1
ERROR = 2

Report = tuple[int, str, Mapping[str, object]]
"""Level (OK, WARN, ERROR), a sentence, and named values."""


class DiagnosticsReporter:
    """Calls `report` again and again, and publishes what it returns.

    Parameters
    ----------
    node : rclpy.node.Node
        Its full name is the name of the status.
    hardware_id : str
        What the status is about, for example the port.
    report : callable
        Returns the present `Report`.
    only_publishers : sequence of str
        Topics that one node is meant to publish, this one or one that it listens to; with a second one the level is at
        least WARN.
    period_s : float
        From one report to the next [s].

    Attributes
    ----------
    hardware_id : str
        As given; may be changed.
    """

    def __init__(
        self,
        node: Node,
        hardware_id: str,
        report: Callable[[], Report],
        *,
        only_publishers: Sequence[str] = (),
        period_s: float = 1.0,
    ) -> None:
        self._node = node
        self.hardware_id = hardware_id
        self._report = report
        self._only = OnlyPublishers(node, only_publishers)
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10, publisher_class=TolerantPublisher)
        self._timer = steady_timer(node, period_s, self.publish)

    def publish(self) -> None:
        """Publish the present report at once."""
        level, message, values = self._report()
        problem = self._only.problem()
        if problem:
            level, message = max(level, WARN), f"{message}; {problem}" if level else problem
        self._send(level, message, values)

    @contextmanager
    def busy(self, message: str, *, period_s: float = 1.0) -> Iterator[None]:
        """Publish one warning again and again, from a thread of its own, while the block runs and the node cannot spin.

        The first one is published after `period_s`, so that a start that takes no longer warns of nothing.

        Parameters
        ----------
        message : str
            What takes so long.
        period_s : float
            From one warning to the next [s].
        """
        is_over = threading.Event()

        def warn() -> None:
            while not is_over.wait(period_s):
                self._send(WARN, message, {})

        thread = threading.Thread(target=warn, name="acts_busy", daemon=True)
        thread.start()
        try:
            yield
        finally:
            is_over.set()
            thread.join()

    def destroy(self) -> None:
        """Stop reporting."""
        self._node.destroy_timer(self._timer)
        self._node.destroy_publisher(self._publisher)

    def _send(self, level: int, message: str, values: Mapping[str, object]) -> None:
        status = DiagnosticStatus(
            level=bytes([level]),
            name=self._node.get_fully_qualified_name().lstrip("/"),
            message=message,
            hardware_id=self.hardware_id,
            values=[KeyValue(key=key, value=_text(value)) for key, value in values.items()],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(array)


def _text(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
