"""Robots that carry the plate, behind what the control loop knows of them.

In come wanted postures; out come readings of the robot, and motion that ends as defined whatever happens.
"""

from acts_control.robots.robot import Robot, RobotConfig, RobotStoppedError, UrRobot
from acts_control.robots.robot_claim import RobotTakenError
from acts_control.robots.safety import CommandGate, RobotReading, RobotWatch, SafetyConfig, touch_age_s

__all__ = [
    "CommandGate",
    "Robot",
    "RobotConfig",
    "RobotReading",
    "RobotStoppedError",
    "RobotTakenError",
    "RobotWatch",
    "SafetyConfig",
    "UrRobot",
    "touch_age_s",
]
