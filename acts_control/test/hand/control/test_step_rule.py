# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From steps that reflexes ask for to goals: what is claimed, made at once, limited, or left for the next cycle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_control.hand.control.step_rule import StepRule, StepRuleConfig
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import Wish

DT_S = 1.0 / 60.0
JOINT = 2
STEP_RAD = 0.02 * LEAP_RIGHT.joints[JOINT].step_scale

Array = NDArray[np.float64]


def only(value: float) -> Array:
    """Of all joints one has a value."""
    array = np.zeros(16)
    array[JOINT] = value
    return array


class Moved:
    """A rule, and joints that are where they were sent."""

    def __init__(self, at_rad: float = 0.5, **settings: Any) -> None:
        # A lead that limits nothing.
        self._rule = StepRule(LEAP_RIGHT, StepRuleConfig(max_lead_rad=1.0, **settings))
        self._goal_rad = np.full(16, at_rad)

    def by(self, *wishes: Wish, current_ma: float = 0.0) -> float:
        """How far the joint is moved in a cycle [rad]."""
        before = self._goal_rad
        self._goal_rad = self._rule.goals(before, before, np.full(16, current_ma), wishes, DT_S)
        assert np.delete(self._goal_rad, JOINT) == pytest.approx(np.delete(before, JOINT))
        return float(self._goal_rad[JOINT] - before[JOINT])


def claimed() -> NDArray[np.bool_]:
    return only(1.0) > 0.0


def test_what_is_asked_of_a_joint_that_is_claimed_is_not_left_over_for_the_next_cycle() -> None:
    moved = Moved()
    assert moved.by(Wish(only(-3.0), "opens", claimed(), at_once=True), Wish(only(5.0), "closes")) == pytest.approx(
        -3.0 * STEP_RAD
    )
    assert moved.by() == 0.0


def test_what_is_wanted_at_once_of_a_joint_that_is_claimed_makes_no_step_of_the_other_at_once() -> None:
    moved = Moved(steps_rise_per_s=60.0)
    wishes = [Wish(only(5.0), "closes", claimed()), Wish(only(-9.0), "opens", at_once=True)]
    assert [moved.by(*wishes) for _ in range(3)] == pytest.approx([STEP_RAD, 2.0 * STEP_RAD, 3.0 * STEP_RAD])


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_no_joint_is_moved_by_more_steps_than_allowed(at_once: bool, sign: float) -> None:
    moved = Moved(max_steps=2.0, steps_rise_per_s=1e5)
    wishes = [Wish(only(sign * 90.0), "much", at_once=at_once)] * 2
    assert [moved.by(*wishes) for _ in range(3)] == pytest.approx([sign * 2.0 * STEP_RAD] * 3)


def test_what_is_left_over_of_steps_that_others_overtook_is_no_more_than_allowed() -> None:
    moved = Moved(max_steps=2.0, steps_rise_per_s=6.0)
    wishes: Sequence[Wish] = [Wish(only(1.0), "at once", at_once=True), Wish(only(90.0), "slowly")]
    assert moved.by(*wishes) == pytest.approx(2.0 * STEP_RAD)
    # It fades by 0.1 steps a cycle.
    assert moved.by() == pytest.approx(1.9 * STEP_RAD)


def test_a_motor_at_its_current_limit_does_not_close_on_by_what_was_left_over() -> None:
    moved = Moved(steps_rise_per_s=6.0, max_grip_current_ma=300.0)
    for _ in range(20):
        moved.by(Wish(only(5.0), "closes"))
    assert moved.by(Wish(only(5.0), "closes"), current_ma=301.0) == 0.0
    assert moved.by() == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_no_goal_goes_beyond_the_limits_of_its_joint(sign: float) -> None:
    joint = LEAP_RIGHT.joints[JOINT]
    moved = Moved(at_rad=0.0)
    for _ in range(20):
        moved.by(Wish(only(sign * 20.0), "on and on", at_once=True))
    assert moved._goal_rad[JOINT] == (joint.upper_rad if sign > 0.0 else joint.lower_rad)
