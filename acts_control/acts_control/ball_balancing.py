"""`ball_balancing`: state, trajectory and control in one process, on one executor."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from rclpy.parameter import Parameter

from acts_control.ball_control_node import BallControlNode
from acts_control.ball_state_node import BallStateNode
from acts_control.ball_trajectory_node import BallTrajectoryNode
from acts_ros.executor import run


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """The command line; what stands from ``--ros-args`` on is ROS's.

    ``-p name:=value`` there goes to all three nodes, which refuse what they do not know, and ``-p node:name:=value``
    reaches no node in a namespace. So the two parameters that a launch file sets are arguments of their own.
    """
    parser = argparse.ArgumentParser(
        prog="ball_balancing", description="Ball balancing: state, trajectory and control in one process."
    )
    parser.add_argument("--robot-ip", help="parameter robot_ip of ball_control")
    parser.add_argument("--trajectory", help="parameter trajectory of ball_trajectory")
    own = list(arguments)
    if "--ros-args" in own:
        del own[own.index("--ros-args") :]
    return parser.parse_args(own)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the three nodes."""
    given = sys.argv if arguments is None else ["ball_balancing", *arguments]
    options = parse(given[1:])

    def overrides(name: str, value: str | None) -> list[Parameter]:
        return [] if value is None else [Parameter(name, value=value)]

    return run(
        [
            BallStateNode,
            lambda: BallTrajectoryNode(parameter_overrides=overrides("trajectory", options.trajectory)),
            lambda: BallControlNode(parameter_overrides=overrides("robot_ip", options.robot_ip)),
        ],
        given,
    )


if __name__ == "__main__":
    sys.exit(main())
