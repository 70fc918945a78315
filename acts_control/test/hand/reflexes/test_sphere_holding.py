# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a hand does with a sphere that it holds, and how one at the centre is gripped, on made contacts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hand_rig import DT_S, LEAP, NAMES, joints_of, region, sensed

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState, Wish
from acts_control.hand.reflexes.sphere_balancing import SphereBalancing, SphereBalancingConfig
from acts_control.hand.reflexes.spheres.aiming import unit
from acts_control.hand.reflexes.spheres.ball import Ball
from acts_control.hand.reflexes.spheres.pinching import Pinching
from acts_control.hand.reflexes.spheres.rolling import Phase, Rolling
from acts_core.skin import RegionContact

pytestmark = pytest.mark.slow

PALM = LEAP_RIGHT.regions["palm"]
UP = np.array(PALM.normal)
CENTRE_M = np.array(PALM.centre_m)
OFF_M = np.array([0.012, -0.010, 0.0])
ROUND = np.array(LEAP_RIGHT.postures["round"])
CONFIG = SphereBalancingConfig()


def on_palm(off_m: np.ndarray | None = None) -> RegionContact:
    """The palm feels a sphere at its centre, or beside it."""
    at = CENTRE_M if off_m is None else CENTRE_M + off_m
    return region("palm", 1.0, centre_m=tuple(at), normal=PALM.normal, spread_m=0.004)


def thumb_on_top(radius_m: float) -> RegionContact:
    """The thumb touches a sphere at the centre nearly on top."""
    pose = LEAP.at(ROUND)
    side = unit(np.cross(UP, [1.0, 0.0, 0.0]))
    at = CENTRE_M + radius_m * (UP + 0.95 * UP + math.sqrt(1.0 - 0.95**2) * side)
    link = LEAP_RIGHT.regions["thumb_distal"].link
    axes = np.array([pose.direction(link, axis) for axis in np.eye(3)])
    return region("thumb_distal", 1.0, centre_m=tuple(axes @ (at - pose.point(link, (0.0, 0.0, 0.0)))))


def closing(reflex: SphereBalancing, seconds: float, *pressed: RegionContact) -> list[Wish | None]:
    """What it asks for while the hand closes."""
    now = sensed(*pressed, state=HandState.CLOSING, q_rad=ROUND, goal_rad=ROUND)
    return [reflex.step(now) for _ in range(round(seconds / DT_S))]


# --- while the hand closes


@pytest.mark.parametrize(("radius_m", "is_small"), [(0.021, True), (0.035, False)])
def test_a_sphere_that_has_come_to_the_centre_is_pinched_where_it_is_small(radius_m: float, is_small: bool) -> None:
    reflex = SphereBalancing(CONFIG)
    reflex.state.rolling = rolling = Rolling("thumb")
    wishes = closing(reflex, 0.25, on_palm(), thumb_on_top(radius_m))
    assert rolling.phase is Phase.CENTRED
    assert (reflex.state.pinching is not None) is is_small
    # Around a larger one the others close: only the thumb's joints are claimed.
    [wish] = wishes[-1:]
    assert wish is not None
    assert wish.claimed is not None
    thumb = [name.startswith("thumb") for name in NAMES]
    assert wish.claimed.all() if is_small else (wish.claimed <= thumb).all()


def pinching_reflex() -> SphereBalancing:
    reflex = SphereBalancing(CONFIG)
    reflex.state.rolling = Rolling("thumb")
    reflex.state.pinching = Pinching(
        Ball(CENTRE_M, UP, CENTRE_M + 0.021 * UP, 0.021, np.zeros(3)), CONFIG.sphere_force_n
    )
    return reflex


def test_a_small_sphere_that_two_fingers_grip_is_held() -> None:
    wishes = closing(pinching_reflex(), 3.0, on_palm(), region("middle_distal", 0.7), region("thumb_distal", 0.7))
    holds = [wish is not None and wish.holds for wish in wishes]
    assert holds == sorted(holds)
    assert (holds[0], holds[-1]) == (False, True)
    assert wishes[0] is not None
    assert wishes[0].claimed is not None
    assert wishes[0].claimed.all()


def test_a_small_sphere_that_is_not_gripped_is_left_to_closing() -> None:
    reflex = pinching_reflex()
    wishes = closing(reflex, 3.0, on_palm())
    assert not any(wish is not None and wish.holds for wish in wishes)
    assert wishes[0] is not None
    assert wishes[-1] is None
    assert reflex.state.rolling is not None
    assert reflex.state.rolling.phase is Phase.GIVEN_UP


def test_a_fingers_speed_is_asked_for_in_steps() -> None:
    """The same motion, whatever a step of the hand is."""

    def speeds(step_rad_s: float) -> np.ndarray:
        now = sensed(
            on_palm(), state=HandState.CLOSING, q_rad=ROUND, goal_rad=ROUND, step_rad_s=np.full(16, step_rad_s)
        )
        wish = pinching_reflex().step(now)
        assert wish is not None
        assert wish.steps.any()
        return wish.steps * step_rad_s

    assert speeds(0.5) == pytest.approx(speeds(1.2))


# --- while it holds


def held(*pressed: RegionContact) -> Wish | None:
    return SphereBalancing(CONFIG).step(sensed(*pressed, q_rad=ROUND, goal_rad=ROUND))


def test_fingers_that_do_not_touch_the_sphere_look_for_it() -> None:
    now = sensed()
    wish = held(on_palm(), region("index_distal", CONFIG.sphere_force_n))
    assert wish is not None
    for finger in ("middle", "ring", "thumb"):
        joints = joints_of(finger)
        expected = CONFIG.sphere_search_rad_s * now.closing(finger)[joints]
        assert (wish.steps * now.step_rad_s)[joints] == pytest.approx(expected)
    # At the centre it is only held: others may move what they like.
    assert not wish.steps[joints_of("index")].any()
    assert wish.claimed is None


def test_a_finger_that_touches_with_another_part_brings_its_tip_to_the_sphere() -> None:
    now = sensed()
    wish = held(on_palm(), region("index_medial", CONFIG.sphere_force_n))
    assert wish is not None
    moved = [NAMES[k] for k in joints_of("index") if wish.steps[k]]
    assert moved == ["index_dip"]
    dip = NAMES.index("index_dip")
    assert (wish.steps * now.step_rad_s)[dip] == pytest.approx(CONFIG.sphere_search_rad_s)


@pytest.mark.parametrize(("share", "side"), [(0.5, 1.0), (0.7, 0.0), (1.3, 0.0), (3.0, -1.0)])
def test_a_finger_presses_a_sphere_harder_or_yields_where_it_is_far_from_what_it_should(
    share: float, side: float
) -> None:
    tip = LEAP_RIGHT.regions["index_distal"]
    wish = held(on_palm(), region("index_distal", share * CONFIG.sphere_force_n, normal=tip.normal))
    assert wish is not None
    now = sensed(q_rad=ROUND)
    jacobian = now.pose.jacobian(tip.link, now.pose.point(tip.link, tip.centre_m))
    moves = jacobian @ (wish.steps * now.step_rad_s * np.isin(np.arange(16), joints_of("index")))
    assert np.sign(moves @ now.pose.direction(tip.link, tip.normal)) == side


def test_of_a_sphere_beside_the_centre_the_joints_that_lead_it_are_claimed() -> None:
    wish = held(on_palm(OFF_M), region("index_distal", CONFIG.sphere_force_n))
    assert wish is not None
    assert wish.steps[joints_of("index")].any()
    assert wish.claimed is not None
    assert (wish.claimed == (wish.steps != 0.0)).all()


@pytest.mark.parametrize("pressed", [(), (on_palm(),), (region("index_distal", 0.5),)], ids=["no", "palm", "finger"])
def test_one_contact_alone_is_no_sphere_that_is_held(pressed: tuple[RegionContact, ...]) -> None:
    assert held(*pressed) is None
