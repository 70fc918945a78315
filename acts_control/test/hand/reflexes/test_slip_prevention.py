# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Slip prevention, on made contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hand_rig import DT_S, RigidHand, joints_of, region, sensed

from acts_control.hand.control.step_rule import StepRuleConfig
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState
from acts_control.hand.reflexes.slip_prevention import SlipPrevention, SlipPreventionConfig
from acts_core.skin import RegionContact

pytestmark = pytest.mark.slow


def slipping(name: str, distance_m: float) -> RegionContact:
    return region(name, 0.5, slip_m=distance_m, slipping=True)


def test_all_fingers_that_touch_grip_up_while_the_object_moves_and_not_longer() -> None:
    reflex = SlipPrevention(SlipPreventionConfig(slip_quiet_s=0.01))
    held = [region("thumb_distal", 0.5), region("middle_distal", 0.5)]
    assert reflex.step(sensed(region("index_distal", 0.5), *held)) is None
    wish = reflex.step(sensed(slipping("index_distal", 2e-4), *held, time_s=0.004))
    assert wish is not None
    assert wish.at_once
    for finger in ("index", "middle", "thumb"):
        assert (wish.steps[joints_of(finger)] > 0.0).all()
    assert not wish.steps[joints_of("ring")].any()
    # It is told on, for the window still holds the motion, but nothing moves any more.
    assert reflex.step(sensed(slipping("index_distal", 2e-4), *held, time_s=0.010)) is not None
    assert reflex.step(sensed(slipping("index_distal", 2e-4), *held, time_s=0.020)) is None
    assert reflex.events == 1


def test_the_added_grip_is_eased_slowly_to_a_share_and_above_where_it_slipped_again() -> None:
    reflex = SlipPrevention(SlipPreventionConfig(slip_keep_s=0.5, slip_kept_share=0.5, slip_ease_steps=0.2))
    reflex.step(sensed(slipping("index_distal", 2e-4)))
    time_s = 0.0
    while time_s < 3.0:
        time_s += DT_S
        wish = reflex.step(sensed(region("index_distal", 0.5), time_s=time_s))
        if 0.02 < time_s < 0.5:
            assert wish is None
    assert reflex.state.added == pytest.approx(0.5 * reflex.state.peak)
    eased = reflex.state.added
    reflex.step(sensed(slipping("index_distal", 2e-4), time_s=time_s))
    assert reflex.events == 2
    assert reflex.state.floor == pytest.approx(eased)
    while time_s < 6.0:
        time_s += DT_S
        reflex.step(sensed(region("index_distal", 0.5), time_s=time_s))
    assert reflex.state.peak > eased
    assert reflex.state.added == pytest.approx((eased + reflex.state.peak) / 2)


def test_no_joint_is_eased_to_where_it_did_not_hold() -> None:
    """Of the last 0.1 rad that were added since it slipped again half is kept, and of the 0.2 rad before that all."""
    reflex = SlipPrevention(SlipPreventionConfig(slip_keep_s=0.1, slip_kept_share=0.5))

    def steps(time_s: float, goal_rad: float, felt: RegionContact) -> np.ndarray | None:
        wish = reflex.step(sensed(felt, time_s=time_s, goal_rad=np.full(16, goal_rad)))
        return None if wish is None else wish.steps[joints_of("index")]

    held = region("index_distal", 0.5)
    steps(0.0, 0.0, slipping("index_distal", 2e-4))
    steps(0.03, 0.2, held)
    steps(0.05, 0.2, slipping("index_distal", 2e-4))
    steps(0.07, 0.3, held)
    for time_s, goal_rad, is_eased in ((0.2, 0.26, True), (0.21, 0.24, False)):
        eased = steps(time_s, goal_rad, held)
        assert eased is not None
        assert (eased < 0.0).all() == is_eased
        assert eased.any() == is_eased


def test_no_more_is_eased_than_was_added_where_the_goals_could_not_follow() -> None:
    hand = RigidHand(("slip", SlipPrevention(SlipPreventionConfig())))
    hand.supervisor.restart(recovered=False)
    held = [region(f"{finger}_distal", 0.8) for finger in LEAP_RIGHT.fingers]
    hand.step(held)
    hand.supervisor.grasp()
    assert hand.step(held, steps=100) is HandState.HOLDING
    # Something firm: the joints stay, and press by how far their goals are ahead.
    hand.stops = {name: hand.angle(name) - 0.06 for name in LEAP_RIGHT.names}
    before, firmest = hand.goal.copy(), hand.goal.copy()
    for k in range(1000):
        hand.step([slipping("index_distal", 1e-4 * (k + 1)), *held[1:]] if k < 5 else held)
        firmest = np.maximum(firmest, hand.goal)
    # By the limits of lead and current, less than the 11 steps of 0.02 rad that were asked for.
    assert 0.02 < (firmest - before).max() < 0.1
    share = SlipPreventionConfig().slip_kept_share
    assert (hand.goal - before >= share * (firmest - before) - 1e-3).all()
    assert hand.goal.max() < firmest.max(), "eased"


def test_the_grip_that_is_added_has_an_end() -> None:
    reflex = SlipPrevention(SlipPreventionConfig(slip_max_added_steps=3.0))
    for k in range(100):
        reflex.step(sensed(slipping("index_distal", 1e-4 * (k + 1)), time_s=k * DT_S))
    assert reflex.state.added == pytest.approx(3.0)
    # It is one slip, and what held before is what there was when it began.
    assert (reflex.events, reflex.state.floor) == (1, 0.0)


ANSWERS = SlipPreventionConfig(
    slip_first_steps=1.0, slip_max_added_steps=11.0, slip_soon_m=1e-4, slip_soon_s=0.013, slip_far_m=6e-4
)


def added(reflex: SlipPrevention, distances_m: Sequence[float], begin_s: float = 0.0, dt_s: float = DT_S) -> float:
    """What has been added to the grip when a pattern has moved like this, from cycle to cycle."""
    for k, distance_m in enumerate(distances_m):
        pressed = slipping("palm", distance_m) if distance_m else region("palm", 0.5)
        reflex.step(replace(sensed(pressed, time_s=begin_s + k * dt_s), dt_s=dt_s))
    return reflex.state.added


@pytest.mark.parametrize(
    ("distances_mm", "steps"),
    [
        # All that moves is told at once, however far: it may be an object that settles.
        ([0.7, 0.7, 0.7, 0.7], 1.0),
        ([0.3, 0.32, 0.34, 0.36, 0.38], 1.0),
        ([0.3, 0.38, 0.46, 0.46, 0.46], 11.0),
        # As much, but later.
        ([0.3, 0.3, 0.3, 0.3, 0.38, 0.46, 0.46], 1.0),
        # Slow, and far.
        ([0.3 + 0.02 * k for k in range(40)], 11.0),
    ],
)
def test_all_of_the_grip_is_for_a_slip_that_goes_on(distances_mm: list[float], steps: float) -> None:
    assert added(SlipPrevention(ANSWERS), [1e-3 * one for one in distances_mm]) == pytest.approx(steps)


def test_a_sign_is_a_first_one_again_after_a_while_without_motion() -> None:
    for quiet_s, steps in ((0.1, 1.0), (0.3, 2.0)):
        reflex = SlipPrevention(replace(ANSWERS, slip_settle_s=0.2))
        assert added(reflex, [3e-4, 3e-4]) == pytest.approx(1.0)
        assert added(reflex, [0.0, 3e-4, 3e-4], begin_s=quiet_s) == pytest.approx(steps)


def test_without_a_first_answer_of_its_own_a_slip_gets_all_of_the_grip_at_once() -> None:
    reflex = SlipPrevention(SlipPreventionConfig(slip_max_added_steps=20.0, slip_grip_steps=50.0))
    assert added(reflex, [3e-4, 3e-4]) == pytest.approx(20.0)


def test_a_loop_that_looks_again_too_late_answers_at_once() -> None:
    assert added(SlipPrevention(ANSWERS), [3e-4], dt_s=1.0 / 60.0) == pytest.approx(11.0)


@pytest.mark.parametrize("most", [0.1, 1.0, 3.0])
def test_the_goals_move_no_farther_than_the_grip_that_may_be_added(most: float) -> None:
    hand = RigidHand(("slip", SlipPrevention(SlipPreventionConfig(slip_max_added_steps=most))), max_lead_rad=1.0)
    hand.supervisor.restart(recovered=False)
    held = [region(f"{finger}_distal", 0.8) for finger in LEAP_RIGHT.fingers]
    hand.step(held)
    hand.supervisor.grasp()
    hand.step(held, steps=100)
    before = hand.goal.copy()
    for k in range(100):
        hand.step([slipping("index_distal", 1e-4 * (k + 1)), *held[1:]])
    added = (hand.goal - before) / StepRuleConfig().base_step_rad
    assert added.max() == pytest.approx(most)
    assert added.min() >= -1e-9
