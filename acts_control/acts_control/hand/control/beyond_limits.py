# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Joints that are beyond their limits when the torque is to come on."""

from __future__ import annotations

import math

from acts_control.hand.description import HandDescription
from acts_control.hand.motors import HandReading

RETURN_RAD_S = 0.5
"""A joint that is beyond a limit when the torque comes on is brought back so fast: slowly, for it may be held there."""

# A joint at its limit may read as a little beyond.
_BEYOND_RAD = 0.02


def beyond_reach(hand: HandDescription, reading: HandReading) -> str:
    """Which joint cannot be where it is said to be, in words: bringing it back would drive it into its stop."""
    for joint, q_rad in zip(hand.joints, reading.q_rad, strict=True):
        if abs(q_rad - joint.clipped(q_rad)) > math.pi:
            return (
                f"{joint.name} is said to be at {q_rad:.2f} rad, more than half a turn beyond its limits of "
                f"{joint.lower_rad:g} to {joint.upper_rad:g}: the torque stays off; check zero_rad, direction and "
                f"limits_rad in the description of the hand, and how the motor is mounted; then call enable"
            )
    return ""


def to_be_brought_back(hand: HandDescription, reading: HandReading) -> list[str]:
    """Joints that are beyond a limit, in a sentence each."""
    return [
        f"{joint.name} is at {q_rad:.2f} rad, beyond its limits of {joint.lower_rad:g} to {joint.upper_rad:g}: it is "
        f"brought back at {RETURN_RAD_S:g} rad/s"
        for joint, q_rad in zip(hand.joints, reading.q_rad, strict=True)
        if abs(q_rad - joint.clipped(q_rad)) > _BEYOND_RAD
    ]
