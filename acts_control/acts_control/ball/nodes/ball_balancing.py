# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`ball_balancing`: state, trajectory and control in one process.

Nothing is sent between the three: the control loop asks the other two when its step is due, in its own thread.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from rclpy.node import Node

from acts_control.ball.nodes.ball_control_node import BallControlNode, BallControlSettings
from acts_control.ball.nodes.ball_state_node import BallStateNode, BallStateSettings
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode, BallTrajectorySettings
from acts_core.stop_signals import StopSignals
from acts_ros.composition import parameters_from
from acts_ros.executor import run

SETTINGS: dict[str, type] = {
    "ball_state": BallStateSettings,
    "ball_trajectory": BallTrajectorySettings,
    "ball_control": BallControlSettings,
}
"""The settings classes of the nodes, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the three nodes; the exit code."""
    words = list(sys.argv if args is None else args)
    given = parameters_from(words, SETTINGS)
    states: list[BallStateNode] = []
    trajectories: list[BallTrajectoryNode] = []

    def make_state() -> Node:
        states.append(BallStateNode(is_driven=True, parameter_overrides=given["ball_state"]))
        return states[0]

    def make_trajectory() -> Node:
        trajectories.append(BallTrajectoryNode(is_driven=True, parameter_overrides=given["ball_trajectory"]))
        return trajectories[0]

    def make_control() -> Node:
        control = BallControlNode(subscribes=False, parameter_overrides=given["ball_control"])
        control.follow(states[0], trajectories[0])
        return control

    # Control last: it is closed first, while what it asks is still there.
    return run([make_state, make_trajectory, make_control], words, signals)
