# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The motors of a hand, behind the one interface that the hand's loop uses.

In come goals of joints; out come their angles and currents. `HandBus` is the interface, `DynamixelHand` implements it
for the LEAP hand; a make of motors is a module here and a line in `registry`.
"""

from acts_control.hand.motors.bus import BusConfig, HandBus, HandError, HandLostError, HandReading, finite_angles
from acts_control.hand.motors.dynamixel import DynamixelHand
from acts_control.hand.motors.dynamixel_config import DynamixelConfig
from acts_control.hand.motors.registry import MOTORS, MotorKind, make_motors, with_motors

__all__ = [
    "MOTORS",
    "BusConfig",
    "DynamixelConfig",
    "DynamixelHand",
    "HandBus",
    "HandError",
    "HandLostError",
    "HandReading",
    "MotorKind",
    "finite_angles",
    "make_motors",
    "with_motors",
]
