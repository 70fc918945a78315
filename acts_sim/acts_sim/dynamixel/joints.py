# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Joints that move freely between stops: the mechanics of motors that touch nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence

from acts_sim.dynamixel.motor import Motor


class FreeJoints:
    """One joint per motor, each with inertia, friction and two stops.

    Parameters
    ----------
    motors : sequence of Motor
    limits_rad : sequence of (float, float)
        Stops of each joint, in the motor's angle [rad].
    inertia_kg_m2, damping_nm_s, friction_nm : float
        Values of every joint; by default of a finger of the LEAP hand about its root, with the gearbox.

    Attributes
    ----------
    blocked : set of int
        Indices of blocked joints.
    """

    def __init__(
        self,
        motors: Sequence[Motor],
        limits_rad: Sequence[tuple[float, float]],
        inertia_kg_m2: float = 1e-3,
        damping_nm_s: float = 0.03,
        friction_nm: float = 0.01,
    ) -> None:
        self.blocked: set[int] = set()
        self._motors = motors
        self._limits_rad = limits_rad
        self._inertia = inertia_kg_m2
        self._damping = damping_nm_s
        self._friction = friction_nm
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
            speed = (shaft.velocity_rad_s * self._inertia + torque * dt_s) / (self._inertia + self._damping * dt_s)
            brake = self._friction * dt_s / self._inertia
            speed = math.copysign(max(abs(speed) - brake, 0.0), speed)
            low, high = self._limits_rad[index]
            position = shaft.position_rad + speed * dt_s
            if not low <= position <= high:
                position, speed = min(max(position, low), high), 0.0
            shaft.position_rad, shaft.velocity_rad_s = position, speed
