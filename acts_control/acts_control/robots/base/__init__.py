# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What every robot that tilts a plate has in common: its interface, and what ends its motion.

In come tilts and readings; out come reasons not to go on. Nothing here knows a robot's joints or how it is reached.
"""

from acts_control.robots.base.robot import (
    CommandRefusedError,
    Robot,
    RobotConfig,
    RobotReading,
    RobotStoppedError,
    TiltLimits,
)
from acts_control.robots.base.robot_claim import RobotClaim, RobotTakenError
from acts_control.robots.base.safety import RobotWatch, SafetyConfig, TiltGate, touch_age_s

__all__ = [
    "CommandRefusedError",
    "Robot",
    "RobotClaim",
    "RobotConfig",
    "RobotReading",
    "RobotStoppedError",
    "RobotTakenError",
    "RobotWatch",
    "SafetyConfig",
    "TiltGate",
    "TiltLimits",
    "touch_age_s",
]
