# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spheres on the palm: where one lies and how large it is, and how fingertips get to it, roll it and get hold of it.

In comes what the hand feels; out come a sphere, and speeds of joints.
"""

from acts_control.hand.reflexes.spheres import aiming
from acts_control.hand.reflexes.spheres.ball import Ball, felt_ball
from acts_control.hand.reflexes.spheres.pinching import Pinching
from acts_control.hand.reflexes.spheres.rolling import Phase, Rolling

__all__ = ["Ball", "Phase", "Pinching", "Rolling", "aiming", "felt_ball"]
