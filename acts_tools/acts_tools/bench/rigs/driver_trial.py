# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver node on the virtual board, in two processes, observed over /diagnostics."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node

from acts_msgs.msg import TactileSamples
from acts_ros.messages import seconds_of
from acts_ros.qos import STREAM
from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.rigs.processes import NAMESPACE, START_TIMEOUT_S, check_alive, driver, virtual_board
from acts_tools.bench.rigs.trial import Status, Trial, observe
from acts_tools.bench.workbench import Workbench
from acts_tools.driver.status import driver_values


def driver_trial(workbench: Workbench, asked_hz: float, seconds: float, board_options: Sequence[str]) -> Trial:
    """Run the driver at a frame rate.

    It has one subscriber in another process, so that sending is part of its work. The subscriber leaves the messages in
    the middleware, because processing them would take CPU time that is not the driver's.

    Parameters
    ----------
    workbench : Workbench
        Folder and stop flag.
    asked_hz : float
        Frame rate of the board.
    seconds : float
        How long to measure [s].
    board_options : sequence of str
        More options of the virtual board.
    """
    with (
        virtual_board(workbench.folder, "--rate-hz", str(asked_hz), *board_options) as board,
        Graph(workbench) as graph,
        driver(workbench.folder, board.link) as process,
    ):
        received: deque[Status] = deque()

        def keep(message: DiagnosticArray) -> None:
            values = driver_values(message, NAMESPACE)
            if values is not None and values["state"] == "active":
                received.append(
                    Status(
                        seconds_of(message.header.stamp),
                        int(values["frames"]),
                        int(values["lost"]),
                        int(values["overruns"]),
                    )
                )

        def statuses() -> Iterator[Status]:
            while True:
                graph.spin_until(
                    lambda: received,
                    START_TIMEOUT_S,
                    "a report of the driver",
                    lambda: check_alive(process, workbench.folder / "driver.log"),
                )
                yield received.popleft()

        graph.node.create_subscription(DiagnosticArray, "/diagnostics", keep, 10)
        # Hidden from the executor.
        sink = Node("sink", namespace=NAMESPACE)
        sink.create_subscription(TactileSamples, "samples", lambda message: None, STREAM)
        try:
            return observe(statuses(), asked_hz, seconds)
        finally:
            sink.destroy_node()
