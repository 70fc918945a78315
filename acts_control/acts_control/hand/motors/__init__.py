# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The motors of a hand, behind what the hand's loop knows of them.

In come goals of joints; out come their angles and currents. `HandBus` is the interface, `DynamixelHand` that of the
LEAP hand.
"""

from acts_control.hand.motors.bus import HandBus, HandError, HandLostError, HandReading
from acts_control.hand.motors.dynamixel import DynamixelConfig, DynamixelHand

__all__ = ["DynamixelConfig", "DynamixelHand", "HandBus", "HandError", "HandLostError", "HandReading"]
