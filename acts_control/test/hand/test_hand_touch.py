# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the hand does about touch that is late, old, of another skin or cannot be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hand_rig import DT_S, GRIPPED, TIP, RigidHand, a_hand, a_holding_hand, all_regions, region

from acts_control.hand.control import SupervisorConfig
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState, Reflex, Sensed, Wish
from acts_control.hand.reflexes.sharp_avoidance import SharpAvoidance, SharpAvoidanceConfig
from acts_control.hand.reflexes.sphere_balancing import SphereBalancing, SphereBalancingConfig
from acts_core.skin import RegionContact

pytestmark = pytest.mark.slow

FOREIGN = [region("index_distal", 0.8)._replace(name=name, link=name) for name in ("chest_left", "chest_right")]


def test_touch_that_stops_while_closing_stops_the_hand() -> None:
    hand = a_hand()
    hand.supervisor.grasp()
    hand.step([], steps=50)
    assert hand.step(None, steps=60) is HandState.STOPPED
    assert hand.supervisor.status.reason == "touch is stale while closing; grasp anew"
    stood = hand.goal.copy()
    hand.step([], steps=50)
    assert hand.goal == pytest.approx(stood)


def test_touch_that_stops_while_a_hand_that_closes_avoids_a_tip_stops_it() -> None:
    hand = RigidHand(("sharp", SharpAvoidance(SharpAvoidanceConfig())))
    hand.supervisor.restart(recovered=False)
    hand.step([], steps=3)
    hand.supervisor.grasp()
    hand.step([], steps=20)
    assert hand.step([TIP], steps=5) is HandState.AVOIDING
    assert hand.step(None, steps=50) is HandState.STOPPED
    # Nothing was gripped: nothing is held once touch is back.
    assert hand.step([], steps=50) is HandState.STOPPED


def test_touch_that_stops_while_holding_leaves_the_grip_as_it_is_and_comes_back() -> None:
    hand = a_holding_hand()
    held = hand.goal.copy()
    assert hand.step(None, steps=60) is HandState.HOLDING
    assert "no reflex acts" in hand.supervisor.status.reason
    assert hand.supervisor.status.is_stale
    assert hand.goal == pytest.approx(held)
    slips = region("index_distal", 0.8, slip_m=3e-4, slipping=True)
    hand.step([slips, *GRIPPED[1:]], steps=3)
    assert (hand.goal > held + 1e-3).any()


class Squeezing(Reflex):
    """A reflex that closes all joints, as long as it is asked."""

    Config = SupervisorConfig
    priority = 1
    states = frozenset({HandState.HOLDING})

    def reset(self) -> None:
        pass

    def step(self, sensed: Sensed) -> Wish | None:
        return Wish(sensed.steps() + 10.0, "squeezing")


def test_no_step_goes_on_once_touch_is_stale() -> None:
    hand = RigidHand(("squeezing", Squeezing(None)), grip_settle_s=0.02)
    hand.supervisor.restart(recovered=False)
    hand.step([], steps=3)
    hand.supervisor.grasp()
    assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    while not hand.supervisor.status.is_stale:
        before = hand.goal
        hand.step(None)
    assert hand.goal == pytest.approx(before)
    hand.step(None, steps=20)
    assert hand.goal == pytest.approx(before)


def test_without_touch_nothing_is_grasped_but_the_hand_opens() -> None:
    hand = a_hand()
    hand.step(None, steps=60)
    assert "is the skin's topic `regions` published?" in hand.supervisor.grasp()
    assert hand.supervisor.release() == ""
    assert hand.step(None, steps=20) is HandState.OPEN
    assert hand.angle("thumb_cmc") > 0.01


def test_touch_that_is_old_when_it_comes_is_told_as_such_and_as_missing_once_it_stops() -> None:
    hand = a_hand()
    hand.step(None, steps=100)
    for _ in range(50):
        hand.supervisor.touch(all_regions(), hand.now_s - 0.2, hand.now_s)
        hand.step(None)
    told = "touch is 0.2 s old when it comes, as from a recording or a machine whose clock is behind"
    assert hand.supervisor.grasp() == told
    hand.step(None, steps=50)
    assert hand.supervisor.grasp() == "no touch for 0.4 s: is the skin's topic `regions` published?"


AMOUNT, PART = "allowed is 0 to 1e+06", "for each part"


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        (region("index_distal", math.nan), f"force_n = nan: {AMOUNT}"),
        (
            region("index_distal", 0.5, centre_m=(0.0, math.inf, 0.0)),
            f"centre_m = (0.0, inf, 0.0): allowed is -10 to 10 {PART}",
        ),
        (region("index_distal", 0.5, slip_m=math.nan, slipping=True), f"slip_m = nan: {AMOUNT}"),
        (
            region("index_distal", 0.5, centre_m=(0.0, 1e6, 0.0)),
            f"centre_m = (0.0, 1000000.0, 0.0): allowed is -10 to 10 {PART}",
        ),
        (
            region("index_distal", 0.5, normal=(0.0, 0.0, 2.0)),
            f"normal = (0.0, 0.0, 2.0): allowed is -1.01 to 1.01 {PART}",
        ),
        (
            region("index_distal", 0.5, motion_m_s=(math.nan, 0.0, 0.0)),
            f"motion_m_s = (nan, 0.0, 0.0): allowed is -1e+06 to 1e+06 {PART}",
        ),
        # Nothing pulls a skin: fingers would close on and on against such a force.
        (region("index_distal", -5.0), f"force_n = -5: {AMOUNT}"),
        (region("index_distal", 0.5, area_m2=-1e-4), f"area_m2 = -0.0001: {AMOUNT}"),
        (region("index_distal", 0.5, peak_n=-0.1), f"peak_n = -0.1: {AMOUNT}"),
        (region("index_distal", 0.5, spread_m=-0.002), f"spread_m = -0.002: {AMOUNT}"),
        (region("index_distal", 0.5, slip_m=-1e-4), f"slip_m = -0.0001: {AMOUNT}"),
    ],
)
def test_touch_with_numbers_that_cannot_be_counts_as_not_come(broken: RegionContact, told: str) -> None:
    hand = a_holding_hand()
    held = hand.goal.copy()
    hand.step([broken], steps=40)
    assert hand.supervisor.status.refused == 40
    assert hand.supervisor.status.refusal == f"region 'index_distal' cannot have {told}"
    assert hand.supervisor.status.is_stale
    assert hand.goal == pytest.approx(held)


def test_touch_that_names_a_region_twice_counts_as_not_come() -> None:
    hand = a_holding_hand()
    hand.step(None)
    assert not hand.supervisor.touch([*all_regions(*GRIPPED), region("palm")], hand.now_s, hand.now_s)
    hand.step(None)
    assert hand.supervisor.status.refused == 1
    assert hand.supervisor.status.refusal == "touch names 'palm' more than once"


def test_old_touch_is_not_taken_for_new() -> None:
    hand = a_holding_hand()
    late_s = hand.now_s - 0.05
    for _ in range(5):
        late_s += DT_S
        hand.supervisor.touch(all_regions(TIP), late_s, hand.now_s)
        assert hand.step(None) is HandState.HOLDING


def test_patches_that_the_hand_does_not_have_are_left_out() -> None:
    hand = a_hand()
    hand.step([region("index_distal", 0.1)._replace(name="little_distal", slipping=True)])
    assert np.isfinite(hand.goal).all()


@pytest.mark.parametrize(("foreign", "told"), [(FOREIGN, "chest_left, chest_right"), ([], "no region at all")])
def test_touch_of_another_skin_counts_as_not_come_and_is_told(foreign: list[RegionContact], told: str) -> None:
    hand = a_holding_hand()
    for _ in range(40):
        hand.step(None)
        assert not hand.supervisor.touch(foreign, hand.now_s, hand.now_s)
    hand.step(None)
    status = hand.supervisor.status
    assert status.is_stale
    assert "no reflex acts" in status.reason
    assert status.refused == 40
    assert told in status.refusal
    assert "palm, index_proximal, index_medial and 10 more" in status.refusal


def test_touch_that_names_other_patches_besides_is_used() -> None:
    hand = a_holding_hand()
    hand.step(None)
    assert hand.supervisor.touch([*FOREIGN, region("index_distal", 0.8)], hand.now_s, hand.now_s)
    hand.step(None)
    assert hand.supervisor.status.refused == 0
    assert hand.supervisor.status.touch_age_s < 0.01


def test_the_order_of_patches_in_a_layout_changes_nothing() -> None:
    """A sphere is moved by the region nearest to each fingertip, whichever patch the layout names first."""
    palm = LEAP_RIGHT.regions["palm"]
    beside_m = (palm.centre_m[0] + 0.015, *palm.centre_m[1:])
    on_palm = region("palm", 1.0, centre_m=beside_m, normal=palm.normal, spread_m=0.004)
    felt = all_regions(on_palm, *GRIPPED, region("index_medial", 0.8), region("thumb_proximal", 0.8))
    goals = []
    for regions in (felt, felt[::-1]):
        hand = RigidHand(("sphere", SphereBalancing(SphereBalancingConfig())), grip_settle_s=0.02)
        hand.supervisor.restart(recovered=False)
        hand.step(GRIPPED)
        assert hand.supervisor.grasp() == ""
        assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
        for _ in range(20):
            hand.supervisor.touch(regions, hand.now_s, hand.now_s)
            hand.step(None)
        assert hand.supervisor.status.active == ("sphere",)
        goals.append(hand.goal)
    np.testing.assert_array_equal(goals[0], goals[1])


def test_regions_of_which_touch_says_nothing_are_told() -> None:
    hand = a_holding_hand()
    before = hand.supervisor.status.unfelt
    without = [one for one in all_regions(*GRIPPED) if one.name not in ("palm", "ring_distal")]
    assert hand.supervisor.touch(without, hand.now_s, hand.now_s)
    hand.step(None)
    assert (before, hand.supervisor.status.unfelt) == ((), ("palm", "ring_distal"))
    hand.step(GRIPPED)
    assert hand.supervisor.status.unfelt == ()


@pytest.mark.parametrize("ahead_s", [0.5, 3600.0, math.inf, math.nan])
def test_touch_from_the_future_counts_as_not_come_and_keeps_none_that_follows_from_counting(ahead_s: float) -> None:
    hand = a_holding_hand()
    hand.supervisor.touch(all_regions(TIP), hand.now_s + ahead_s, hand.now_s)
    assert hand.step(GRIPPED, steps=5) is HandState.HOLDING
    assert hand.supervisor.status.refused == 1
    assert hand.supervisor.status.touch_age_s < 0.01
    assert hand.step([TIP, *GRIPPED[1:]], steps=5) is HandState.AVOIDING
