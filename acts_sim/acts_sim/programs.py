# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The executables of this package, see setup.py. Imports nothing else, so that signal handlers come first."""

from acts_ros.executables.program import Program

ball_world = Program("acts_sim.ball.ball_world_node")
dynamixel_bus = Program("acts_sim.dynamixel.main")
hand_world = Program("acts_sim.hand.process.main")
ur_controller = Program("acts_sim.ur.main")
