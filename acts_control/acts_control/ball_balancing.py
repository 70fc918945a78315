"""`ball_balancing`: state, trajectory and control in one process."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial

from acts_control.ball_control_node import BallControlNode, BallControlSettings
from acts_control.ball_state_node import BallStateNode, BallStateSettings
from acts_control.ball_trajectory_node import BallTrajectoryNode, BallTrajectorySettings
from acts_core.stop_signals import StopSignals
from acts_ros.composition import parameters_from
from acts_ros.executor import run

_NODES = {
    "ball_state": (BallStateNode, BallStateSettings),
    "ball_trajectory": (BallTrajectoryNode, BallTrajectorySettings),
    "ball_control": (BallControlNode, BallControlSettings),
}


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the three nodes; the exit code."""
    words = list(sys.argv if args is None else args)
    settings = {name: settings_class for name, (_, settings_class) in _NODES.items()}
    given = parameters_from(words, "State, trajectory and control of ball balancing in one process.", settings)
    factories = [partial(node_class, parameter_overrides=given[name]) for name, (node_class, _) in _NODES.items()]
    return run(factories, words, signals)
