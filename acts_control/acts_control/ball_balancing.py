"""`ball_balancing`: state, trajectory and control in one process, on one executor.

``ball_balancing [--robot-ip ADDRESS] [--trajectory LIST] [--ros-args ...]``. A ROS parameter on the command line of a
process goes to all its nodes, and those that do not have it refuse it; hence these options of its own.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial

from rclpy.parameter import Parameter
from rclpy.utilities import remove_ros_args

from acts_control.ball_control_node import BallControlNode
from acts_control.ball_state_node import BallStateNode
from acts_control.ball_trajectory_node import BallTrajectoryNode
from acts_core.stop_signals import StopSignals
from acts_ros.executor import run


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the three nodes; the exit code."""
    parser = argparse.ArgumentParser(prog="ball_balancing", description="State, trajectory and control in one process.")
    parser.add_argument("--robot-ip", help="parameter robot_ip of ball_control")
    parser.add_argument("--trajectory", help="parameter trajectory of ball_trajectory")
    words = list(sys.argv if args is None else args)
    options = parser.parse_args(remove_ros_args(words)[1:])
    return run(
        [
            BallStateNode,
            partial(BallTrajectoryNode, parameter_overrides=_given("trajectory", options.trajectory)),
            partial(BallControlNode, parameter_overrides=_given("robot_ip", options.robot_ip)),
        ],
        words,
        signals,
    )


def _given(name: str, value: str | None) -> list[Parameter]:
    return [] if value is None else [Parameter(name, value=value)]
