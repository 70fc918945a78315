# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The UR5e: the only place that knows its joints, their limits, its controller's registers, and `ur_rtde`.

In come tilts of the plate; out come joint angles for the controller, and the robot's state as a `RobotReading`.
"""

from acts_control.robots.ur.config import UrConfig
from acts_control.robots.ur.robot import UrRobot

__all__ = ["UrConfig", "UrRobot"]
