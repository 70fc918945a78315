# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a hand is: joints, links, regions of skin, and where they are at given joint angles.

In comes a YAML file; out come `HandDescription` and `HandKinematics`. Another hand is another file.
"""

from acts_control.hand.description.description import HandDescription, Joint, Region, Role
from acts_control.hand.description.description_file import LEAP_RIGHT, hand_description
from acts_control.hand.description.kinematics import HandKinematics, HandPose

__all__ = ["LEAP_RIGHT", "HandDescription", "HandKinematics", "HandPose", "Joint", "Region", "Role", "hand_description"]
