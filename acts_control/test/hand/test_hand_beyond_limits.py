# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Joints of a hand that are beyond their limits, or only seem to be."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hand_loop_rig import MadeBus
from waiting import wait_for

from acts_control.hand.control import HandLoop, HandLoopConfig, HandPhase
from acts_control.hand.control.beyond_limits import beyond_reach, to_be_brought_back
from acts_control.hand.description import LEAP_RIGHT, HandDescription
from acts_control.hand.motors import HandReading

# A hand whose joints, on motors with their zero in the middle, are between -2 and 2 rad.
HAND = replace(LEAP_RIGHT, joints=tuple(replace(one, lower_rad=-2.0, upper_rad=2.0) for one in LEAP_RIGHT.joints))


def limited_to(lower_rad: float, upper_rad: float) -> HandDescription:
    """A hand of two joints."""
    return replace(
        HAND, joints=tuple(replace(one, lower_rad=lower_rad, upper_rad=upper_rad) for one in HAND.joints[:2])
    )


def reading(*q_rad: float) -> HandReading:
    return HandReading(q_rad, (0.0,) * len(q_rad), (0.0,) * len(q_rad), (30,) * len(q_rad), ("",) * len(q_rad))


def loop_of(bus: MadeBus, upper_rad: float = 2.0) -> HandLoop:
    joints = tuple(replace(one, upper_rad=upper_rad) for one in HAND.joints)
    hand = replace(HAND, joints=joints)
    return HandLoop(hand, bus, HandLoopConfig(connect_retry_s=0.05), lambda _level, _sentence: None)


@pytest.mark.parametrize("turn_rad", [2.0 * math.pi, -2.0 * math.pi])
def test_a_joint_whose_motor_counts_from_another_turn_is_not_brought_back(turn_rad: float) -> None:
    bus = MadeBus()
    # Within its limits, near the one or the other: a motor that has started anew has forgotten how often it had turned.
    bus.q_rad = bus.moves_to_rad = [math.copysign(1.9, -turn_rad) + turn_rad] * 16
    loop = loop_of(bus)
    loop.launch()
    try:
        wait_for(lambda: loop.status.phase in (HandPhase.GIVEN_UP, HandPhase.ENABLED), "torque, or none")
        assert loop.status.phase is HandPhase.GIVEN_UP
        assert f"is said to be at {bus.q_rad[0]:.2f} rad" in loop.status.reason
        assert not bus.has_torque
        assert bus.sent == []
    finally:
        loop.close()


@pytest.mark.parametrize(("q_rad", "upper_rad"), [(2.9, 2.0), (-2.9, 2.0), (2.1, 2.0), (7.0, 5.0)])
def test_a_joint_that_is_nearest_to_the_limit_beyond_which_it_is_said_to_be_is_brought_back(
    q_rad: float, upper_rad: float
) -> None:
    bus = MadeBus()
    bus.q_rad = bus.moves_to_rad = [q_rad] * 16
    loop = loop_of(bus, upper_rad)
    loop.launch()
    try:
        wait_for(lambda: len(bus.sent) > 2, lambda: f"goals, {loop.status}")
        assert abs(bus.sent[-1][0]) < abs(q_rad)
    finally:
        loop.close()


def test_only_joints_that_are_beyond_a_limit_are_told_to_be_brought_back() -> None:
    bus, told = MadeBus(), []
    # A joint at its limit may read as a little beyond.
    bus.q_rad = bus.moves_to_rad = [2.1, 2.01, 1.5, *[0.0] * 13]
    loop = HandLoop(HAND, bus, HandLoopConfig(connect_retry_s=0.05), lambda _level, sentence: told.append(sentence))
    loop.launch()
    try:
        wait_for(lambda: len(bus.sent) > 2, lambda: f"goals, {loop.status}")
        assert [sentence for sentence in told if "brought back" in sentence] == [
            f"{HAND.joints[0].name} is at 2.10 rad, beyond its limits of -2 to 2: it is brought back at 0.5 rad/s"
        ]
    finally:
        loop.close()


@pytest.mark.parametrize(
    ("limits_rad", "q_rad", "why"),
    [
        # Of a joint that turns by more than a turn only how far it is beyond can be told.
        ((-2.0, 5.0), 8.2, "more than half a turn beyond its limits of -2 to 5"),
        ((-2.0, 5.0), -5.2, "more than half a turn beyond its limits of -2 to 5"),
        ((-2.0, 5.0), 8.1, ""),
        ((-2.0, 5.0), -5.1, ""),
        # From 3.15 rad on it is nearer to the lower limit by a turn.
        ((-2.0, 2.0), 3.2, "beyond its limits of -2 to 2, and nearer to them by a turn"),
        ((-2.0, 2.0), -3.2, "beyond its limits of -2 to 2, and nearer to them by a turn"),
        ((-2.0, 2.0), 3.1, ""),
        ((-2.0, 2.0), -3.1, ""),
        # A joint at its limit may read as a little beyond, though this is its other limit by a turn.
        ((-3.13, 3.13), 3.145, ""),
    ],
)
def test_of_all_joints_the_one_that_cannot_be_where_it_is_said_to_be_is_told(
    limits_rad: tuple[float, float], q_rad: float, why: str
) -> None:
    hand = limited_to(*limits_rad)
    for joint, angles_rad in zip(hand.joints, [(q_rad, 0.0), (0.0, q_rad)], strict=True):
        said = beyond_reach(hand, reading(*angles_rad))
        if why:
            assert said.startswith(f"{joint.name} is said to be at {q_rad:.2f} rad, {why}")
        else:
            assert said == ""


def test_joints_are_told_to_be_brought_back_from_beyond_either_limit() -> None:
    hand = limited_to(-2.0, 1.0)
    first, second = (joint.name for joint in hand.joints)
    assert to_be_brought_back(hand, reading(1.03, -2.03)) == [
        f"{first} is at 1.03 rad, beyond its limits of -2 to 1: it is brought back at 0.5 rad/s",
        f"{second} is at -2.03 rad, beyond its limits of -2 to 1: it is brought back at 0.5 rad/s",
    ]
    assert to_be_brought_back(hand, reading(1.01, -2.01)) == []
