# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Grasping and holding: from what the hand feels to the goals of its joints.

In come regions and readings of the motors; out come goals, limited in step, rate and lead. `HandSupervisor` decides
between closing, holding and avoiding; the reflexes say what they want.
"""

from acts_control.hand.control.behaviour import Behaviour
from acts_control.hand.control.loop import HandLoop
from acts_control.hand.control.loop_config import HandLoopConfig
from acts_control.hand.control.status import HandPhase
from acts_control.hand.control.supervisor import HandSupervisor, SupervisorConfig, SupervisorStatus
from acts_control.hand.control.torque_wish import PendingAnswer
from acts_control.hand.control.touch import no_touch

__all__ = [
    "Behaviour",
    "HandLoop",
    "HandLoopConfig",
    "HandPhase",
    "HandSupervisor",
    "PendingAnswer",
    "SupervisorConfig",
    "SupervisorStatus",
    "no_touch",
]
