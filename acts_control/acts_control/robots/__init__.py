# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Robots that carry the plate: `base` says what the control loop asks of one, `ur` is the UR5e.

In comes a name with settings; out comes a robot that tilts the plate, reports its state and stops.
"""

from acts_control.robots.registry import ROBOTS, RobotKind, make_robot, with_robots

__all__ = ["ROBOTS", "RobotKind", "make_robot", "with_robots"]
