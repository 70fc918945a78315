# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated UR5e with its controller; `ports` serves clients such as the unmodified ur_rtde.

In come commands and programs; out come the robot's state in every cycle, and its joints in a ring.
"""

from acts_sim.ur.commands import COMMANDS, MOTION_COMMANDS
from acts_sim.ur.config import ACCELERATION_LIMIT_RAD_S2, CYCLE_HZ, VERSION, UrControllerConfig
from acts_sim.ur.controller import COMMAND_REGISTERS, Controller, RobotMode, RuntimeState, SafetyMode
from acts_sim.ur.joints import JointState, Servo
from acts_sim.ur.program import ControlProgram

__all__ = [
    "ACCELERATION_LIMIT_RAD_S2",
    "COMMANDS",
    "COMMAND_REGISTERS",
    "CYCLE_HZ",
    "MOTION_COMMANDS",
    "VERSION",
    "ControlProgram",
    "Controller",
    "JointState",
    "RobotMode",
    "RuntimeState",
    "SafetyMode",
    "Servo",
    "UrControllerConfig",
]
