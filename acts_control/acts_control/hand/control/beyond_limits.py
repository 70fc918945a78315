# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Joints that are beyond their limits when the torque is to come on."""

from __future__ import annotations

import math

from acts_control.hand.description import HandDescription, Joint
from acts_control.hand.motors import HandReading

RETURN_RAD_S = 0.5
"""A joint that is beyond a limit when the torque comes on is brought back so fast: slowly, for it may be held there."""

# A joint at its limit may read as a little beyond.
_BEYOND_RAD = 0.02


def beyond_reach(hand: HandDescription, reading: HandReading) -> str:
    """Which joint cannot be where it is said to be, in words: bringing it back would drive it into its stop."""
    for joint, q_rad in zip(hand.joints, reading.q_rad, strict=True):
        limits = f"its limits of {joint.lower_rad:g} to {joint.upper_rad:g}"
        if abs(q_rad - joint.clipped(q_rad)) > math.pi:
            why = f"more than half a turn beyond {limits}"
        elif _is_of_another_turn(joint, q_rad):
            why = (
                f"beyond {limits}, and nearer to them by a turn: a motor that starts anew counts from 0 to "
                f"{2.0 * math.pi:.2f} rad, and its joint may need angles beyond that"
            )
        else:
            continue
        return (
            f"{joint.name} is said to be at {q_rad:.2f} rad, {why}: the torque stays off; check zero_rad, direction "
            f"and limits_rad in the description of the hand, and how the motor is mounted; then call enable"
        )
    return ""


def _is_of_another_turn(joint: Joint, q_rad: float) -> bool:
    """Whether a joint is nearer to its limits where a turn is added or taken off.

    Of one that turns by a whole turn or more that cannot be told.
    """
    if joint.upper_rad - joint.lower_rad >= 2.0 * math.pi:
        return False
    beyond_rad = abs(q_rad - joint.clipped(q_rad))
    others = (q_rad - 2.0 * math.pi, q_rad + 2.0 * math.pi)
    return beyond_rad > _BEYOND_RAD and min(abs(one - joint.clipped(one)) for one in others) < beyond_rad


def to_be_brought_back(hand: HandDescription, reading: HandReading) -> list[str]:
    """Joints that are beyond a limit, in a sentence each."""
    return [
        f"{joint.name} is at {q_rad:.2f} rad, beyond its limits of {joint.lower_rad:g} to {joint.upper_rad:g}: it is "
        f"brought back at {RETURN_RAD_S:g} rad/s"
        for joint, q_rad in zip(hand.joints, reading.q_rad, strict=True)
        if abs(q_rad - joint.clipped(q_rad)) > _BEYOND_RAD
    ]
