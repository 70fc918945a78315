# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The executables of this package, see setup.py. Nothing else is imported here: signals come first."""

from acts_ros.executables.program import Program

ball_balancing = Program("acts_control.ball.nodes.ball_balancing")
ball_control = Program("acts_control.ball.nodes.ball_control_node")
ball_state = Program("acts_control.ball.nodes.ball_state_node")
ball_trajectory = Program("acts_control.ball.nodes.ball_trajectory_node")
hand = Program("acts_control.hand.nodes.hand_node")
hand_reflexes = Program("acts_control.hand.nodes.reflexes_node")
