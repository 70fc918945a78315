# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What limits a hand whatever is asked for, what counts as touch that is new or missing, and what begins anew."""

from __future__ import annotations

import numpy as np
import pytest
from hand_rig import DT_S, GRIPPED, NAMES, RigidHand, a_hand, a_holding_hand, all_regions, joints_of, region

from acts_control.hand.control import SupervisorConfig
from acts_control.hand.control.step_rule import STEP_RATE_HZ
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState, Reflex, Sensed, Wish

CONFIG = SupervisorConfig()


class Noted(Reflex):
    """A reflex that notes what it is asked."""

    Config = SupervisorConfig
    priority = 1
    states = frozenset(HandState)

    def __init__(self) -> None:
        self.resets = 0
        self.is_new: list[bool] = []
        super().__init__(None)

    def reset(self) -> None:
        self.resets += 1

    def step(self, sensed: Sensed) -> Wish | None:
        self.is_new.append(sensed.is_new)
        return None


def test_a_finger_gives_way_as_soon_as_it_presses_with_more_than_is_allowed_and_not_before() -> None:
    hand = a_holding_hand()
    before = hand.goal.copy()
    hand.step([region("index_distal", CONFIG.max_force_n)], steps=3)
    assert np.array_equal(hand.goal, before)
    hand.step([region("index_distal", CONFIG.max_force_n + 0.1)])
    moved = before - hand.goal
    # At once, and no farther afterwards.
    k = NAMES.index("index_pip")
    steps = 0.2 * CONFIG.max_steps * LEAP_RIGHT.fingers["index"].closes["index_pip"]
    most = max(LEAP_RIGHT.fingers["index"].closes.values())
    expected_rad = steps / most * CONFIG.base_step_rad * STEP_RATE_HZ * LEAP_RIGHT.joints[k].step_scale * DT_S
    assert moved[k] == pytest.approx(expected_rad)
    others = [j for j in range(16) if j not in joints_of("index")]
    assert not moved[others].any()
    after = hand.goal.copy()
    hand.step([region("index_distal", CONFIG.max_force_n)], steps=3)
    assert np.array_equal(hand.goal, after)


def test_a_finger_does_not_give_way_to_what_was_felt_before_touch_went_missing() -> None:
    hand = a_hand(grip_settle_s=0.02, touch_stale_after_s=0.01)
    assert hand.supervisor.grasp() == ""
    assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    before = hand.goal.copy()
    hand.step([region("index_distal", 60.0)])
    assert hand.angle("index_pip") < before[NAMES.index("index_pip")]
    hand.step(None, steps=5)
    assert hand.supervisor.status.is_stale
    stood = hand.goal.copy()
    hand.step(None, steps=20)
    assert np.array_equal(hand.goal, stood)


def test_touch_is_new_in_one_step_alone() -> None:
    noted = Noted()
    hand = RigidHand(("noted", noted))
    for _ in range(3):
        hand.step([])
        hand.step(None, steps=2)
    # The first is of a hand that has just begun to feel.
    assert noted.is_new == [True, False, False] * 3


def test_each_grasp_begins_with_reflexes_that_remember_nothing() -> None:
    noted = Noted()
    hand = RigidHand(("noted", noted), grip_settle_s=0.02)
    hand.supervisor.restart(recovered=False)
    hand.step([])
    for _ in range(2):
        resets = noted.resets
        assert hand.supervisor.grasp() == ""
        assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
        assert noted.resets == resets + 1


def test_a_slow_loop_is_not_told_to_have_stood_still() -> None:
    hand = a_hand(touch_stale_after_s=0.05)
    assert hand.supervisor.grasp() == ""
    for _ in range(5):
        # As with rate_hz 10.
        hand.now_s += 0.1
        hand.supervisor.touch(all_regions(), hand.now_s - 0.002, hand.now_s)
        hand.goal = np.asarray(hand.supervisor.step(hand.reading(), hand.goal.tolist(), hand.now_s, 0.1))
        hand.q = hand.goal.copy()
        assert hand.supervisor.status.state is HandState.CLOSING


def test_a_grasp_whose_touch_has_gone_before_the_torque_came_back_does_not_begin_when_touch_returns() -> None:
    hand = RigidHand()
    hand.supervisor.touch(all_regions(), hand.now_s, hand.now_s)
    hand.supervisor.watch(hand.now_s)
    # While a motor is started anew.
    assert hand.supervisor.grasp() == ""
    hand.supervisor.restart(recovered=True)
    hand.now_s += 1.0
    assert hand.step(None) is HandState.STOPPED
    assert hand.supervisor.status.reason == "touch is stale while closing; grasp anew"
    goal = hand.goal.copy()
    assert hand.step([], steps=50) is HandState.STOPPED
    assert np.array_equal(hand.goal, goal)


def test_a_grasp_that_is_asked_for_while_a_motor_takes_long_to_start_anew_is_done() -> None:
    hand = a_hand()
    hand.step([], steps=5)
    assert hand.supervisor.grasp() == ""
    hand.now_s += 3.0
    hand.supervisor.restart(recovered=True)
    assert hand.step([], steps=5) is HandState.CLOSING
