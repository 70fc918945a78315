# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Simulated Dynamixel motors on a bus, for the unmodified SDK: registers, packets and faults.

In come packets on a pseudo-terminal; out come replies. A drive moves each motor, or a world does.
"""

from acts_sim.dynamixel.bus import Bus
from acts_sim.dynamixel.control import ControlSocket
from acts_sim.dynamixel.control_client import ControlClient
from acts_sim.dynamixel.control_table import MODELS
from acts_sim.dynamixel.drive import RAD_PER_TICK
from acts_sim.dynamixel.faults import MOTOR_FAULTS, do_to_motor, state
from acts_sim.dynamixel.joints import JOINT_DAMPING_NM_S, JOINT_FRICTION_NM, JOINT_INERTIA_KG_M2
from acts_sim.dynamixel.motor import Motor, OverloadLaw
from acts_sim.dynamixel.port import BusPort

__all__ = [
    "JOINT_DAMPING_NM_S",
    "JOINT_FRICTION_NM",
    "JOINT_INERTIA_KG_M2",
    "MODELS",
    "MOTOR_FAULTS",
    "RAD_PER_TICK",
    "Bus",
    "BusPort",
    "ControlClient",
    "ControlSocket",
    "Motor",
    "OverloadLaw",
    "do_to_motor",
    "state",
]
