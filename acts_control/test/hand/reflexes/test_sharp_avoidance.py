# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sharp-object avoidance, on made contacts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hand_rig import DT_S, joints_of, region, sensed

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes.sharp_avoidance import SharpAvoidance, SharpAvoidanceConfig
from acts_core.skin import RegionContact

FELT_FOR_7_MS = SharpAvoidanceConfig(sharp_min_sharpness=3.0, sharp_felt_s=0.007)


def tip_in(name: str) -> RegionContact:
    """What a region feels of a tip."""
    return region(name, 0.5, 1, sharpness=10.0)


def test_only_what_is_surely_a_tip_is_avoided() -> None:
    reflex = SharpAvoidance(FELT_FOR_7_MS)
    # 2.9 is no tip, and a break begins anew.
    for k, sharpness in enumerate((2.9, 3.1, 3.1, 2.9, 3.1, 3.1)):
        assert reflex.step(sensed(region("index_distal", 0.5, 1, sharpness=sharpness), time_s=k * DT_S)) is None
    assert reflex.step(sensed(region("index_distal", 0.5, 1, sharpness=3.1), time_s=6 * DT_S)) is not None


@pytest.mark.parametrize(("rate_hz", "cycles"), [(60.0, 2), (250.0, 3), (500.0, 5)])
def test_a_tip_is_felt_for_as_long_at_any_rate(rate_hz: float, cycles: int) -> None:
    reflex = SharpAvoidance(FELT_FOR_7_MS)
    opens = [reflex.step(sensed(tip_in("index_distal"), time_s=k / rate_hz)) is not None for k in range(6)]
    assert opens == [k >= cycles - 1 for k in range(6)]


@pytest.mark.parametrize("rate_hz", [60.0, 250.0])
def test_unless_told_otherwise_one_cycle_is_not_enough_and_two_are(rate_hz: float) -> None:
    reflex = SharpAvoidance(SharpAvoidanceConfig())
    opens = [reflex.step(sensed(tip_in("index_distal"), time_s=k / rate_hz)) is not None for k in range(3)]
    assert opens == [False, True, True]


def test_the_finger_at_a_tip_opens_at_once_and_the_others_keep_what_they_have() -> None:
    reflex = SharpAvoidance(SharpAvoidanceConfig())
    felt = (tip_in("index_distal"), region("middle_distal", 0.8))
    assert reflex.step(sensed(*felt)) is None  # one image may deceive
    wish = reflex.step(sensed(*felt, time_s=0.007))
    assert wish is not None
    assert wish.at_once
    assert wish.avoids
    assert (wish.steps[joints_of("index")] < 0.0).all()
    others = [k for k in range(16) if k not in joints_of("index")]
    assert not wish.steps[others].any()
    assert wish.claimed is not None
    assert np.flatnonzero(wish.claimed).tolist() == joints_of("index")
    # It stays away for a while, then is free again.
    assert reflex.step(sensed(time_s=0.4)) is not None
    assert reflex.step(sensed(time_s=0.6)) is None
    assert reflex.events == 1


def test_what_lifts_off_is_no_tip() -> None:
    reflex = SharpAvoidance(FELT_FOR_7_MS)
    forces_n = (0.8, 0.6, 0.4, 0.3, 0.2, 0.19, 0.19, 0.19)
    opens = [
        reflex.step(sensed(region("index_distal", force_n, 1, sharpness=10.0), time_s=k * DT_S)) is not None
        for k, force_n in enumerate(forces_n)
    ]
    assert opens == 7 * [False] + [True]


def test_of_a_region_that_was_left_out_nothing_is_known_in_between() -> None:
    reflex = SharpAvoidance(SharpAvoidanceConfig())
    for time_s in (0.0, 20.0):
        assert reflex.step(sensed(tip_in("index_distal"), time_s=time_s)) is None
        assert reflex.step(replace(sensed(time_s=time_s + DT_S), regions={})) is None


def test_a_finger_opens_so_far_and_no_farther() -> None:
    reflex = SharpAvoidance(SharpAvoidanceConfig(sharp_open_rad=0.2, sharp_felt_s=0.0))
    reflex.step(sensed(tip_in("index_distal")))
    wish = reflex.step(sensed(tip_in("index_distal"), goal_rad=np.full(16, 0.05), time_s=0.1))
    assert wish is not None
    assert not wish.steps.any()


def test_a_tip_in_the_palm_opens_all_fingers() -> None:
    reflex = SharpAvoidance(SharpAvoidanceConfig(sharp_felt_s=0.0))
    wish = reflex.step(sensed(tip_in("palm")))
    assert wish is not None
    for finger in LEAP_RIGHT.fingers:
        assert (wish.steps[joints_of(finger)] < 0.0).all()
