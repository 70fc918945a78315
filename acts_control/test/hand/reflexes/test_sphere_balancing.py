# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Rolling a sphere to the palm's centre, and gripping one that is small, on made contacts."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hand_rig import DT_S, LEAP, NAMES, RigidHand, joints_of, region, sensed
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from acts_control.hand.description import LEAP_RIGHT, HandKinematics
from acts_control.hand.reflexes import HandState, Sensed, Wish
from acts_control.hand.reflexes.base import Reflex
from acts_control.hand.reflexes.sphere_balancing import SphereBalancing, SphereBalancingConfig
from acts_control.hand.reflexes.spheres.aiming import press, turned, unit
from acts_control.hand.reflexes.spheres.ball import Ball, felt_ball
from acts_control.hand.reflexes.spheres.pinching import Pinching
from acts_control.hand.reflexes.spheres.rolling import Phase, Rolling
from acts_core.errors import SettingsError
from acts_core.skin import RegionContact

pytestmark = pytest.mark.slow

PALM = LEAP_RIGHT.regions["palm"]
UP = np.array(PALM.normal)
CENTRE_M = np.array(PALM.centre_m)
# Beside the centre, towards the fingers and to the side.
OFF_M = np.array([0.012, -0.010, 0.0])
ROUND = np.array(LEAP_RIGHT.postures["round"])

numbers = st.floats(-0.05, 0.05)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)


def on_palm(off_m: np.ndarray = OFF_M, spread_m: float = 0.004) -> RegionContact:
    return region("palm", 1.0, centre_m=tuple(CENTRE_M + off_m), normal=PALM.normal, spread_m=spread_m)


def ball(radius_m: float = 0.030, off_m: np.ndarray = OFF_M) -> Ball:
    foot = CENTRE_M + off_m
    return Ball(foot, UP, foot + radius_m * UP, radius_m, -off_m)


def closing(*pressed: RegionContact, q_rad: np.ndarray = ROUND) -> Sensed:
    return sensed(*pressed, state=HandState.CLOSING, q_rad=q_rad, goal_rad=q_rad)


def tip_m(q: np.ndarray, finger: str) -> np.ndarray:
    tip = LEAP_RIGHT.regions[f"{finger}_distal"]
    return LEAP.at(q).point(tip.link, tip.centre_m)


def after(reflex: Reflex, seconds: float, *pressed: RegionContact) -> tuple[Wish | None, np.ndarray]:
    """What it asks for at last, and where that has brought the joints."""
    q, wish = ROUND.copy(), None
    for _ in range(round(seconds / DT_S)):
        now = closing(*pressed, q_rad=q)
        wish = reflex.step(now)
        if wish is not None:
            q = np.clip(q + wish.steps * now.step_rad_s * DT_S, LEAP_RIGHT.lower_rad, LEAP_RIGHT.upper_rad)
    return wish, q


# --- the sphere as it is felt


@settings(max_examples=50)
@given(along=vectors, radius_m=st.floats(0.01, 0.05))
def test_a_rolling_sphere_rests_at_its_foot_and_is_twice_as_fast_on_top(along: np.ndarray, radius_m: float) -> None:
    one = ball(radius_m)
    velocity = along - (along @ UP) * UP
    assert one.surface_velocity(velocity, one.foot_m) == pytest.approx(np.zeros(3))
    assert one.surface_velocity(velocity, one.centre_m) == pytest.approx(velocity)
    assert one.surface_velocity(velocity, one.centre_m + radius_m * UP) == pytest.approx(2.0 * velocity)


def test_height_is_1_on_top_and_0_at_the_equator() -> None:
    one = ball(0.03)
    side = unit(np.cross(UP, [1.0, 0.3, 0.2]))
    assert one.height(one.centre_m + 0.03 * UP) == pytest.approx(1.0)
    assert one.height(one.centre_m + 0.03 * side) == pytest.approx(0.0, abs=1e-9)


def test_the_palm_tells_where_a_sphere_is_and_without_it_the_fingers_do() -> None:
    pose = LEAP.at(ROUND)
    one = felt_ball(pose, PALM, [on_palm()], 0.03)
    assert one.foot_m == pytest.approx(CENTRE_M + OFF_M)
    assert one.radius_m == pytest.approx(0.03)
    assert one.offset_m == pytest.approx(np.linalg.norm(OFF_M))
    thumb = region("thumb_distal", 0.5, normal=(0.0, 0.0, 1.0))
    alone = felt_ball(pose, PALM, [thumb], 0.03)
    assert alone.foot_m == pytest.approx(alone.centre_m - 0.03 * UP)


@settings(max_examples=100)
@given(a=vectors, b=vectors, most_rad=st.floats(0.01, 2.0))
def test_a_direction_turns_no_farther_than_asked_and_arrives(a: np.ndarray, b: np.ndarray, most_rad: float) -> None:
    assume(np.linalg.norm(a) > 1e-3 and np.linalg.norm(b) > 1e-3)
    start, to = unit(a), unit(b)
    assume(start @ to > -0.999)
    way = turned(start, to, most_rad)
    between = lambda u, v: math.acos(float(np.clip(u @ v, -1.0, 1.0)))  # noqa: E731
    assert np.linalg.norm(way) == pytest.approx(1.0, abs=1e-6)
    assert between(start, way) <= most_rad + 1e-6
    assert between(way, to) == pytest.approx(max(0.0, between(start, to) - most_rad), abs=1e-3)


# --- rolling


def rolled(rolling: Rolling, seconds: float, touching: RegionContact | None, *, is_off: bool = True) -> Phase:
    one = ball()
    for _ in range(round(seconds / DT_S)):
        rolling.step(closing(on_palm()), one, touching, is_off=is_off)
    return rolling.phase


def thumb_at(height: float) -> RegionContact:
    """The thumb touches the sphere: 1 on top, 0 at the equator."""
    one = ball()
    pose = LEAP.at(ROUND)
    side = unit(np.cross(UP, [1.0, 0.0, 0.0]))
    at = one.centre_m + one.radius_m * (height * UP + math.sqrt(1.0 - height**2) * side)
    link = LEAP_RIGHT.regions["thumb_distal"].link
    # Back into the frame of the link.
    origin = pose.point(link, (0.0, 0.0, 0.0))
    axes = np.array([pose.direction(link, axis) for axis in np.eye(3)])
    return region("thumb_distal", 1.0, centre_m=tuple(axes @ (at - origin)))


def test_a_sphere_is_at_the_centre_once_it_has_been_there_for_a_while() -> None:
    rolling = Rolling("thumb")
    assert rolled(rolling, 0.1, thumb_at(0.95), is_off=False) is Phase.ROLLING
    assert rolled(rolling, 0.2, thumb_at(0.95), is_off=False) is Phase.CENTRED
    # Where no finger touches it, it may roll on.
    assert rolled(Rolling("thumb"), 0.3, None, is_off=False) is Phase.ROLLING


@pytest.mark.parametrize(
    ("touching", "seconds"),
    [(thumb_at(0.3), 0.2), (None, 3.0), (thumb_at(0.95), 4.5)],
    ids=["too low", "finds nothing", "takes too long"],
)
def test_rolling_is_given_up(touching: RegionContact | None, seconds: float) -> None:
    rolling = Rolling("thumb")
    assert rolled(rolling, 0.4 * seconds, touching) is Phase.ROLLING
    assert rolled(rolling, 0.6 * seconds, touching) is Phase.GIVEN_UP


# --- the reflex while the hand closes


@pytest.mark.parametrize(
    ("pressed", "begins"),
    [
        ([on_palm()], True),
        ([on_palm(spread_m=0.003)], False),
        ([on_palm(spread_m=0.009)], False),
        ([on_palm(), region("index_distal", 0.2)], False),
        ([], False),
    ],
    ids=["round", "small", "wide", "a finger touches", "nothing"],
)
def test_the_thumb_comes_only_down_on_something_round_that_no_finger_touches(pressed: list, begins: bool) -> None:
    wish, _ = after(SphereBalancing(SphereBalancingConfig()), 0.3, *pressed)
    assert (wish is not None) == begins


def test_the_thumb_waits_until_the_hand_is_in_shape() -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    for _ in range(round(0.5 / DT_S)):
        assert reflex.step(replace(closing(on_palm()), is_shaped=False)) is None
    wish, _ = after(reflex, 0.3, on_palm())
    assert wish is not None


def test_the_thumb_comes_over_the_sphere_and_everything_else_waits() -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    wish, q = after(reflex, 0.8, on_palm())
    assert wish is not None
    assert wish.claimed is not None
    assert wish.claimed.all()
    above = lambda angles: np.linalg.norm(np.cross(tip_m(angles, "thumb") - CENTRE_M - OFF_M, UP))  # noqa: E731
    assert above(q) < 0.5 * above(ROUND)
    others = [k for k, name in enumerate(NAMES) if not name.startswith("thumb")]
    assert q[others] == pytest.approx(ROUND[others])


def test_a_touched_sphere_is_led_towards_the_centre() -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    after(reflex, 0.3, on_palm())
    now = closing(on_palm(), thumb_at(0.95))
    wish = reflex.step(now)
    assert wish is not None
    link = LEAP_RIGHT.regions["thumb_distal"].link
    at = now.pose.point(link, thumb_at(0.95).centre_m)
    velocity = now.pose.jacobian(link, at) @ (wish.steps * now.step_rad_s)
    assert unit(velocity - (velocity @ UP) * UP) @ unit(-OFF_M) > 0.8


def test_what_is_given_up_is_left_to_closing() -> None:
    wish, _ = after(SphereBalancing(SphereBalancingConfig()), 6.0, on_palm())
    assert wish is None


def test_a_spread_of_nothing_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"sphere_min_spread_m = 0\.01: allowed is sphere_max_spread_m = 0\.007"):
        SphereBalancingConfig(sphere_min_spread_m=0.01)


# --- pinching


def pinched(
    *pressed: RegionContact, seconds: float, off_m: np.ndarray | tuple[float, ...] = (0.0, 0.0, 0.0)
) -> tuple[Pinching, np.ndarray]:
    """A sphere that was at the centre when it began to be gripped, and is felt at `off_m` from there."""
    pinching, q = Pinching(ball(0.021, np.zeros(3)), 0.6), ROUND.copy()
    for _ in range(round(seconds / DT_S)):
        now = closing(on_palm(np.array(off_m)), *pressed, q_rad=q)
        q = np.clip(q + pinching.step(now) * DT_S, LEAP_RIGHT.lower_rad, LEAP_RIGHT.upper_rad)
    return pinching, q


def test_the_middle_finger_comes_over_a_small_sphere_and_those_beside_it_stay() -> None:
    _, q = pinched(seconds=1.5)
    top = CENTRE_M + 0.042 * UP
    assert np.linalg.norm(tip_m(q, "middle") - top) < 0.3 * np.linalg.norm(tip_m(ROUND, "middle") - top)
    beside = [k for k, name in enumerate(NAMES) if name.startswith(("index", "ring"))]
    assert q[beside] == pytest.approx(ROUND[beside])


def test_the_thumb_waits_beside_a_small_sphere_until_the_finger_over_it_touches_and_then_comes_against_it() -> None:
    middle_m = CENTRE_M + 0.021 * UP
    _, q = pinched(seconds=1.4)
    assert np.linalg.norm(tip_m(q, "thumb") - middle_m) == pytest.approx(0.035, abs=0.001)
    _, q = pinched(region("middle_distal", 0.3), seconds=1.4)
    assert np.linalg.norm(tip_m(q, "thumb") - middle_m) < 0.016
    # One that touches nothing goes 8 mm into where the sphere should be, and no farther.
    _, q = pinched(seconds=2.4)
    assert np.linalg.norm(tip_m(q, "middle") - middle_m) == pytest.approx(0.013, abs=0.001)


def test_a_small_sphere_is_followed_where_the_palm_feels_it() -> None:
    off_m = np.array([0.006, 0.0, 0.0])
    _, q = pinched(seconds=2.4, off_m=off_m)
    middle_m = CENTRE_M + off_m + 0.021 * UP
    assert np.linalg.norm(tip_m(q, "middle") - middle_m) == pytest.approx(0.013, abs=0.001)


def test_a_finger_that_touches_a_small_sphere_presses_with_its_tip_until_it_grips() -> None:
    pinching = Pinching(ball(0.021, np.zeros(3)), 0.6)
    felt = [region("middle_medial", 0.1), region("middle_distal", 0.2), region("thumb_distal", 0.7)]
    now = closing(on_palm(np.zeros(3)), *felt)
    # The thumb makes room first.
    pinching._has_room = True
    assert pinching.step(now) == pytest.approx(press(now, felt[1], 0.010))
    # Both parts of the finger together are enough.
    now = closing(on_palm(np.zeros(3)), region("middle_medial", 0.5), *felt[1:])
    assert not pinching.step(now).any()


def test_pinching_ends_with_a_grip_of_both_or_after_a_while_without() -> None:
    both = [region("middle_distal", 0.7), region("thumb_distal", 0.7)]
    gripped, _ = pinched(*both, seconds=0.2)
    assert gripped.has_gripped
    assert gripped.has_ended
    one, _ = pinched(both[0], seconds=2.0)
    assert not one.has_ended
    one, _ = pinched(both[0], seconds=3.0)
    assert one.has_ended
    assert not one.has_gripped


# --- the supervisor


class Asks(Reflex):
    """Claims what it is told, and counts the hand as holding when it is told."""

    Config = SphereBalancingConfig
    priority = 90
    states = frozenset({HandState.CLOSING})

    def reset(self) -> None:
        self.claims, self.holds = np.ones(16, dtype=bool), False

    def step(self, sensed: Sensed) -> Wish | None:
        return Wish(sensed.steps(), "asked", self.claims, holds=self.holds)


def test_closing_waits_while_a_reflex_claims_all_joints_and_the_hand_holds_when_it_says_so() -> None:
    reflex: Any = Asks(SphereBalancingConfig())
    hand = RigidHand(("asks", reflex), grasp_posture="open")
    hand.step()
    hand.supervisor.grasp()
    assert hand.step(steps=round(5.0 / DT_S)) is HandState.CLOSING
    assert not hand.goal.any()
    reflex.claims = np.zeros(16, dtype=bool)
    hand.step(steps=50)
    assert hand.goal.any()
    reflex.holds = True
    hand.step()
    assert hand.step() is HandState.HOLDING


@pytest.mark.parametrize("out_m", [0.0, 1e-9, 1e3])
def test_no_place_of_a_contact_makes_steps_that_are_not_finite(out_m: float) -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    after(reflex, 0.3, on_palm())
    pressed = region("thumb_distal", 1.0, centre_m=(out_m, 0.0, 0.0))
    wish = reflex.step(closing(on_palm(), pressed))
    assert wish is not None
    assert np.isfinite(wish.steps).all()


@pytest.mark.parametrize(("spread_m", "acts"), [(0.004, True), (0.0075, True), (0.02, False)])
def test_what_is_held_and_no_sphere_is_left_to_the_other_reflexes(spread_m: float, acts: bool) -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    tips = [region(f"{finger}_distal", 0.2) for finger in LEAP_RIGHT.fingers]
    assert (reflex.step(sensed(on_palm(spread_m=spread_m), *tips)) is not None) is acts


# --- a finger without skin


def without_skin(finger: str, now: Sensed) -> Sensed:
    """The same moment of a hand whose description gives a finger no region."""
    kept = {name: one for name, one in LEAP_RIGHT.regions.items() if one.finger != finger}
    felt = {name: one for name, one in now.regions.items() if name in kept}
    return replace(now, kinematics=HandKinematics(replace(LEAP_RIGHT, regions=kept)), regions=felt)


@pytest.mark.parametrize(("finger", "comes"), [("thumb", False), ("ring", True)])
def test_a_thumb_without_skin_does_not_come_down_on_a_sphere(finger: str, comes: bool) -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    now = without_skin(finger, closing(on_palm()))
    wishes = [reflex.step(now) for _ in range(round(0.3 / DT_S))]
    assert (wishes[-1] is not None) is comes


@pytest.mark.parametrize("finger", ["index", "ring"])
def test_a_finger_without_skin_stays_where_it_is_while_two_others_hold_a_small_sphere(finger: str) -> None:
    reflex = SphereBalancing(SphereBalancingConfig())
    reflex.state.pinching = Pinching(ball(0.021, np.zeros(3)), 0.6)
    pair = [region("middle_distal", 0.2), region("thumb_distal", 0.2)]
    wish = reflex.step(without_skin(finger, sensed(on_palm(np.zeros(3)), *pair)))
    assert wish is not None
    assert not wish.steps[joints_of(finger)].any()
