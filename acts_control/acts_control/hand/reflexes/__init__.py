# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reflexes: each answers what the hand feels with steps of its joints.

In comes `Sensed`, out comes a `Wish` or nothing. `registry` names them all; another one is a file and a line there.
`base` is what they have in common, `spheres` what several need that handle a sphere.
"""

from acts_control.hand.reflexes.base import HandState, Reflex, Sensed, Wish
from acts_control.hand.reflexes.hand_to_hand import HandToHandConfig
from acts_control.hand.reflexes.registry import REFLEXES, make_reflexes, with_reflexes

__all__ = ["REFLEXES", "HandState", "HandToHandConfig", "Reflex", "Sensed", "Wish", "make_reflexes", "with_reflexes"]
