# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Joints that move freely between stops: the mechanics of motors that touch nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence

from acts_sim.dynamixel.motor import Motor

JOINT_INERTIA_KG_M2 = 1e-3
"""Of every joint: that of a finger of the LEAP hand about its root, with the gearbox."""

JOINT_DAMPING_NM_S = 0.03
"""Torque against the motion of every joint per speed, of its gearbox [N m s/rad]."""

JOINT_FRICTION_NM = 0.01
"""Torque against the motion of every joint at any speed."""


class FreeJoints:
    """One joint per motor, each with inertia, friction and two stops.

    Parameters
    ----------
    motors : sequence of Motor
    limits_rad : sequence of (float, float)
        Stops of each joint, in the motor's angle [rad].

    Attributes
    ----------
    blocked : set of int
        Indices of blocked joints.
    """

    def __init__(self, motors: Sequence[Motor], limits_rad: Sequence[tuple[float, float]]) -> None:
        self.blocked: set[int] = set()
        self._motors = motors
        self._limits_rad = limits_rad
        for motor, (low, high) in zip(motors, limits_rad, strict=True):
            motor.shaft.position_rad = min(max(math.pi, low), high)

    def step(self, dt_s: float) -> None:
        """Advance motors and joints by `dt_s`."""
        for index, motor in enumerate(self._motors):
            torque = motor.step(dt_s)
            shaft = motor.shaft
            if index in self.blocked:
                shaft.velocity_rad_s = 0.0
                continue
            # Implicit Euler for both kinds of friction, which is stable for any step.
            speed = (shaft.velocity_rad_s * JOINT_INERTIA_KG_M2 + torque * dt_s) / (
                JOINT_INERTIA_KG_M2 + JOINT_DAMPING_NM_S * dt_s
            )
            brake = JOINT_FRICTION_NM * dt_s / JOINT_INERTIA_KG_M2
            speed = math.copysign(max(abs(speed) - brake, 0.0), speed)
            low, high = self._limits_rad[index]
            position = shaft.position_rad + speed * dt_s
            if not low <= position <= high:
                position, speed = min(max(position, low), high), 0.0
            shaft.position_rad, shaft.velocity_rad_s = position, speed
