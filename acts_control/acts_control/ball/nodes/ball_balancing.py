# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`ball_balancing`: state, trajectory and control in one process.

Nothing is sent between the three: the control loop asks the other two when its step is due, in its own thread.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rclpy.node import Node

from acts_control.ball.nodes.ball_control_node import BallControlNode, BallControlSettings
from acts_control.ball.nodes.ball_state_node import BallStateNode, BallStateSettings
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode, BallTrajectorySettings
from acts_core.stop_signals import StopSignals
from acts_ros.composition import run_nodes

SETTINGS: dict[str, type] = {
    "ball_state": BallStateSettings,
    "ball_trajectory": BallTrajectorySettings,
    "ball_control": BallControlSettings,
}
"""The settings classes of the nodes, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the three nodes; the exit code."""
    states: list[BallStateNode] = []
    trajectories: list[BallTrajectoryNode] = []

    def make_state(**given: Any) -> Node:
        states.append(BallStateNode(is_driven=True, **given))
        return states[0]

    def make_trajectory(**given: Any) -> Node:
        trajectories.append(BallTrajectoryNode(is_driven=True, **given))
        return trajectories[0]

    def make_control(**given: Any) -> Node:
        control = BallControlNode(subscribes=False, **given)
        control.follow(states[0], trajectories[0])
        return control

    # Control last: it is closed first, while what it asks is still there.
    nodes = {"ball_state": make_state, "ball_trajectory": make_trajectory, "ball_control": make_control}
    return run_nodes(nodes, SETTINGS, signals, args)
