# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The reflexes and the step rule, on made contacts; slip prevention is in `test_slip_prevention`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hand_rig import DT_S, GRIPPED, NAMES, RigidHand, joints_of, region, sensed
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_control.hand.control.step_rule import StepRule, StepRuleConfig
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import REFLEXES, HandState, HandToHandConfig, Reflex, Wish
from acts_control.hand.reflexes.hand_to_hand import HandToHand
from acts_control.hand.reflexes.slip_prevention import SlipPrevention, SlipPreventionConfig
from acts_control.hand.reflexes.sphere_balancing import SphereBalancing, SphereBalancingConfig
from acts_control.hand.reflexes.spheres.aiming import approaches, radius_on_palm, reach
from acts_control.hand.reflexes.spheres.ball import fitted_sphere
from acts_control.hand.reflexes.trapping import Trapping, TrappingConfig
from acts_core.skin import RegionContact

pytestmark = pytest.mark.slow

PIP, DIP = NAMES.index("index_pip"), NAMES.index("index_dip")


# --- the step rule


def goals(wishes: list[Wish], goal: float = 0.3, q: float = 0.3, current: float = 0.0, **config: float) -> np.ndarray:
    rule = StepRule(LEAP_RIGHT, StepRuleConfig(**config))
    return rule.goals(np.full(16, goal), np.full(16, q), np.full(16, current), wishes, DT_S)


def test_a_step_moves_a_goal_as_far_as_one_at_60_hz_in_the_same_time() -> None:
    wish = Wish(np.eye(16)[PIP] * 2.0, "", at_once=True)
    moved = goals([wish], base_step_rad=0.02) - 0.3
    assert moved[PIP] == pytest.approx(2.0 * 0.02 * 60.0 * DT_S)
    assert np.count_nonzero(moved) == 1


def test_the_number_of_steps_rises_as_shaped_for_each_motor() -> None:
    rule = StepRule(LEAP_RIGHT, StepRuleConfig(steps_rise_per_s=100.0, base_step_rad=0.01))
    goal, seen = np.zeros(16), []
    for _ in range(4):
        goal = rule.goals(goal, goal, np.zeros(16), [Wish(np.full(16, 1.0), "")], DT_S)
        seen.append(goal[PIP])
    assert np.diff([0.0, *seen]) / (0.01 * 60 * DT_S) == pytest.approx([0.4, 0.8, 1.0, 1.0])


def test_what_began_at_once_ends_at_once_and_leaves_the_others_their_steps() -> None:
    rule = StepRule(LEAP_RIGHT, StepRuleConfig(steps_rise_per_s=100.0, base_step_rad=0.01))
    slow, sudden = Wish(np.full(16, 0.3), ""), Wish(np.full(16, 9.0), "", at_once=True)
    goal, seen = np.zeros(16), []
    for wishes in ([slow], [slow], [slow, sudden], [slow, sudden], [slow], [], []):
        goal = rule.goals(goal, goal, np.zeros(16), wishes, DT_S)
        seen.append(goal[PIP])
    assert np.diff([0.0, *seen]) / (0.01 * 60 * DT_S) == pytest.approx([0.3, 0.3, 9.3, 9.3, 0.3, 0.0, 0.0])


def test_claimed_joints_are_left_alone_by_those_that_come_after() -> None:
    claimed = np.zeros(16, dtype=bool)
    claimed[PIP] = True
    first = Wish(np.eye(16)[PIP] * -1.0, "", claimed, at_once=True)
    moved = goals([first, Wish(np.ones(16), "", at_once=True)]) - 0.3
    assert moved[PIP] < 0.0
    assert moved[DIP] > 0.0


@settings(max_examples=100, deadline=None)
@given(
    steps=st.lists(st.floats(allow_nan=True, allow_infinity=True), min_size=16, max_size=16),
    q=st.floats(-0.3, 1.5),
    goal=st.floats(-3.0, 3.0),
    current=st.floats(-2000.0, 2000.0),
)
def test_goals_are_finite_within_limits_and_near_their_joints_whatever_is_asked(
    steps: list[float], q: float, goal: float, current: float
) -> None:
    moved = goals([Wish(np.array(steps), "", at_once=True)], goal, q, current, max_lead_rad=0.1)
    for joint, angle in zip(LEAP_RIGHT.joints, moved, strict=True):
        assert joint.clipped(angle) == angle
        assert abs(angle - joint.clipped(q)) <= 0.1 / joint.gain_scale + 1e-12


def test_a_goal_gets_as_far_ahead_of_a_joint_that_is_blocked_as_it_may() -> None:
    ahead = goals([Wish(np.full(16, 20.0), "", at_once=True)], goal=0.42, max_lead_rad=0.1) - 0.3
    assert ahead == pytest.approx([0.1 / joint.gain_scale for joint in LEAP_RIGHT.joints])


def test_a_motor_at_its_current_limit_is_closed_no_further_but_may_open() -> None:
    closing, opening = Wish(np.ones(16), "", at_once=True), Wish(-np.ones(16), "", at_once=True)
    assert goals([closing], current=349.0) == pytest.approx(np.full(16, 0.3))
    assert (goals([opening], current=349.0) < 0.3).all()


# --- sphere


def test_a_sphere_is_fitted_to_places_and_normals() -> None:
    centre, radius = np.array([0.01, -0.02, -0.07]), 0.031
    normals = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 0.6, 0.8]])
    points = centre - radius * normals
    found, size = fitted_sphere(points, normals, np.array([1.0, 0.5, 2.0]), 0.03)
    assert size == pytest.approx(radius, abs=5e-4)
    assert found == pytest.approx(centre, abs=5e-4)


def test_contacts_that_say_nothing_of_the_size_leave_the_usual_one() -> None:
    normals = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, -1.0]])
    _, size = fitted_sphere(np.zeros((2, 3)), normals, np.ones(2), 0.03)
    assert size == pytest.approx(0.03)


@settings(max_examples=50, deadline=None)
@given(
    radius_m=st.floats(0.006, 0.045),
    angles=st.lists(st.tuples(st.floats(-3.1, 3.1), st.floats(-0.5, 1.5)), min_size=1, max_size=4),
)
def test_the_palm_and_one_finger_tell_how_large_a_sphere_is(radius_m: float, angles: list[tuple]) -> None:
    at, up = np.array([-0.04, -0.03, -0.0345]), np.array([0.0, 0.0, -1.0])
    away = [np.array([np.cos(a) * np.cos(h), np.sin(a) * np.cos(h), -np.sin(h)]) for a, h in angles]
    points = [at + radius_m * (up + direction) for direction in away]
    assert radius_on_palm(at, up, points) == pytest.approx(radius_m, rel=1e-6)


def test_a_finger_that_touches_the_palms_height_says_nothing_of_a_radius() -> None:
    at, up = np.array([-0.04, -0.03, -0.0345]), np.array([0.0, 0.0, -1.0])
    assert radius_on_palm(at, up, [at + np.array([0.03, 0.0, 0.0])]) is None


@pytest.mark.parametrize("off_m", [-0.02, 0.0, 0.02])
def test_the_side_on_which_the_palm_is_touched_tells_from_where_fingers_come(off_m: float) -> None:
    at, up = np.array([-0.044, -0.037 + off_m, -0.0345]), np.array([0.0, 0.0, -1.0])
    found = approaches(sensed(), at, up)
    assert {finger: one.part for finger, one in found.items()} == {
        "index": "beside",
        "middle": "over",
        "ring": "beside",
        "thumb": "against",
    }
    for one in found.values():
        assert one.side @ up == pytest.approx(0.0)
        assert np.linalg.norm(one.on_sphere(up, 0.02)) == pytest.approx(1.0)
    assert found["index"].side[1] > 0.0 > found["ring"].side[1]
    assert found["thumb"].side @ found["middle"].side < -0.5
    # The thumb turns to the side on which it lies.
    assert found["thumb"].side[1] * off_m >= 0.0


@pytest.mark.parametrize("finger", ["index", "middle", "thumb"])
def test_a_fingertip_reaches_a_point_within_its_limits(finger: str) -> None:
    q, up = np.array(LEAP_RIGHT.postures["cup"]), np.array([0.0, 0.0, -1.0])
    at = np.array([-0.044, -0.035, -0.0345])
    approach = approaches(sensed(), at, up)[finger]
    away = approach.on_sphere(up, 0.035)
    to = at + 0.035 * (up + away)
    region_of = LEAP_RIGHT.regions[f"{finger}_distal"]
    lower, upper = (
        np.array([getattr(joint, name) for joint in LEAP_RIGHT.joints]) for name in ("lower_rad", "upper_rad")
    )
    for _ in range(1500):
        now = sensed(q_rad=q)
        q = np.clip(q + DT_S * reach(now, finger, to, -away, 0.15), lower, upper)
    left = sensed(q_rad=q).pose.point(region_of.link, region_of.centre_m) - to
    assert np.linalg.norm(left) < 0.006


def test_a_small_sphere_is_pressed_where_it_is_and_slip_has_no_say() -> None:
    reflex = Trapping(TrappingConfig())
    pose = sensed().pose
    tip = LEAP_RIGHT.regions["middle_distal"]
    # The tip is 20 mm above where the palm is touched: on a sphere of 10 mm.
    at = pose.point(tip.link, tip.centre_m)
    held = region("middle_distal", 0.3, centre_m=tip.centre_m, normal=tip.normal)
    palm = region("palm", 0.2, centre_m=(at[0], at[1], at[2] + 0.020), normal=(0.0, 0.0, -1.0))
    wish = reflex.step(sensed(palm, held))
    assert wish is not None
    assert reflex.radius_m == pytest.approx(0.010, abs=1e-6)
    assert {NAMES[k].split("_")[0] for k in np.flatnonzero(wish.steps)} == {"middle"}
    assert wish.claimed is not None
    assert wish.claimed.all()
    # Also where the palm does not feel it just now; where no finger touches it any more the others have their say.
    assert reflex.step(sensed(held)) is not None
    assert reflex.step(sensed(palm)) is None


@pytest.mark.parametrize(("force_n", "side"), [(0.3, 1.0), (2.0, 0.0), (4.0, -1.0)])
def test_a_finger_presses_a_small_sphere_harder_or_yields_until_it_presses_as_it_should(
    force_n: float, side: float
) -> None:
    reflex = Trapping(TrappingConfig(trap_force_n=2.0))
    tip = LEAP_RIGHT.regions["middle_distal"]
    pose = sensed().pose
    at = pose.point(tip.link, tip.centre_m)
    held = region("middle_distal", force_n, centre_m=tip.centre_m, normal=tip.normal)
    now = sensed(region("palm", 0.2, centre_m=(at[0], at[1], at[2] + 0.020), normal=(0.0, 0.0, -1.0)), held)
    wish = reflex.step(now)
    assert wish is not None
    moves = pose.jacobian(tip.link, at) @ (wish.steps * now.step_rad_s)
    assert np.sign(moves @ pose.direction(tip.link, tip.normal)) == side


def test_what_is_larger_or_was_not_felt_by_the_palm_is_not_trapped() -> None:
    reflex = Trapping(TrappingConfig())
    assert reflex.step(sensed(region("middle_distal", 0.3))) is None
    tip = LEAP_RIGHT.regions["middle_distal"]
    at = sensed().pose.point(tip.link, tip.centre_m)
    palm = region("palm", 1.0, centre_m=(at[0], at[1], at[2] + 0.060), normal=(0.0, 0.0, -1.0))
    assert reflex.step(sensed(palm, region("middle_distal", 0.3, centre_m=tip.centre_m, normal=tip.normal))) is None


def at_times(reflex: Reflex, times_s: Sequence[float], *pressed: RegionContact) -> int:
    """How often it counts as set off, after it was asked at these times."""
    for time_s in times_s:
        assert reflex.step(sensed(*pressed, time_s=time_s)) is not None
    return reflex.events


def test_what_acts_for_as_long_as_something_lasts_has_been_set_off_once_until_it_has_paused() -> None:
    tip = LEAP_RIGHT.regions["middle_distal"]
    at = sensed().pose.point(tip.link, tip.centre_m)
    held = region("middle_distal", 0.3, centre_m=tip.centre_m, normal=tip.normal)
    palm = region("palm", 0.2, centre_m=(at[0], at[1], at[2] + 0.020), normal=(0.0, 0.0, -1.0))
    for reflex in (
        Trapping(TrappingConfig()),
        HandToHand(HandToHandConfig()),
        SphereBalancing(SphereBalancingConfig()),
    ):
        assert reflex.events == 0
        assert at_times(reflex, (7.0, 7.004, 7.4), palm, held) == 1
        assert at_times(reflex, (8.0, 8.004), palm, held) == 2


# --- hand to hand


def test_force_goes_from_phalanges_with_much_to_those_with_little() -> None:
    reflex = HandToHand(HandToHandConfig(hand_to_hand_force_n=1.0))
    wish = reflex.step(sensed(region("index_proximal", 3.0), region("index_medial", 0.2)))
    assert wish is not None
    assert wish.steps[NAMES.index("index_mcp_forward")] < 0.0
    assert wish.steps[PIP] > 0.0
    assert wish.steps[DIP] > 0.0  # looks for touch
    assert not wish.steps[joints_of("ring")].any()


@pytest.mark.parametrize(
    ("force_n", "steps"),
    [(0.45, 0.33), (0.85, 0.0), (1.15, 0.0), (1.5, -0.3), (5.5, -2.0)],
)
def test_a_phalanx_closes_or_opens_by_what_it_lacks_or_presses_too_much(force_n: float, steps: float) -> None:
    """Not by little, and never by more than is allowed at once."""
    reflex = HandToHand(
        HandToHandConfig(
            hand_to_hand_force_n=1.0,
            hand_to_hand_steps_per_n=0.6,
            hand_to_hand_deadband_n=0.2,
            hand_to_hand_max_steps=2.0,
        )
    )
    # The second one asks for a step in each case.
    wish = reflex.step(sensed(region("index_medial", force_n), region("middle_medial", 0.5)))
    assert wish is not None
    assert wish.steps[PIP] == pytest.approx(steps)
    assert wish.steps[DIP] == pytest.approx(0.3 * LEAP_RIGHT.fingers["index"].closes["index_dip"]), "looks for touch"
    assert wish.why == "force shared among 2 phalanges"
    assert wish.claimed is not None
    assert not wish.claimed.any()


@pytest.mark.parametrize(
    "contact",
    [
        region("ring_medial", 12.0),
        # 3 N on a taxel of 9 mm^2 are 3.3e5 N/m^2.
        region("ring_medial", 4.0, 4, peak_n=3.0),
    ],
)
def test_a_finger_gives_way_above_the_comfort_limit_of_force_or_pressure(contact: RegionContact) -> None:
    reflex = HandToHand(HandToHandConfig(hand_to_hand_max_force_n=10.0, hand_to_hand_max_pressure_n_m2=3e5))
    wish = reflex.step(sensed(contact))
    assert wish is not None
    # As fast as is allowed, whatever its other phalanges look for; nobody else closes it.
    fastest = HandToHandConfig().hand_to_hand_max_steps * sensed().closing("ring")
    assert wish.steps == pytest.approx(-fastest)
    assert wish.claimed is not None
    assert np.flatnonzero(wish.claimed).tolist() == joints_of("ring")
    assert wish.why == "ring gives way"


def test_the_comfort_limit_holds_while_the_hand_closes_and_nothing_is_shared_before_it_holds() -> None:
    reflex = HandToHand(HandToHandConfig())
    light, hard = region("index_medial", 0.2), region("ring_medial", 12.0)
    assert HandState.CLOSING in reflex.states
    assert reflex.step(sensed(light, state=HandState.CLOSING)) is None
    wish = reflex.step(sensed(light, hard, state=HandState.CLOSING))
    assert wish is not None
    assert (wish.steps[joints_of("ring")] < 0.0).all()
    assert not wish.steps[joints_of("index")].any()


@pytest.mark.parametrize("state", [HandState.CLOSING, HandState.HOLDING])
def test_all_fingers_give_way_where_the_palm_is_pressed_too_hard_also_before_they_touch(state: HandState) -> None:
    reflex = HandToHand(HandToHandConfig())
    wish = reflex.step(sensed(region("palm", 12.0), state=state))
    assert wish is not None
    for finger in LEAP_RIGHT.fingers:
        assert (wish.steps[joints_of(finger)] < 0.0).all(), finger


def test_a_finger_above_the_comfort_limit_gives_way_also_while_something_slips() -> None:
    reflexes = ("slip", SlipPrevention(SlipPreventionConfig())), ("hand_to_hand", HandToHand(HandToHandConfig()))
    hand = RigidHand(*reflexes, grip_settle_s=0.02)
    hand.supervisor.restart(recovered=False)
    hand.step([])
    assert hand.supervisor.grasp() == ""
    assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    before = hand.goal.copy()
    active: set[str] = set()
    hard, slips = region("ring_distal", 12.0), region("index_distal", 0.8, slip_m=3e-4, slipping=True)
    for _ in range(30):
        hand.step([slips, hard])
        active |= set(hand.supervisor.status.active)
        assert (hand.goal[joints_of("ring")] <= before[joints_of("ring")]).all()
    assert active == {"slip", "hand_to_hand"}
    assert (hand.goal[joints_of("ring")] < before[joints_of("ring")] - 0.02).all()
    # Who does not press too hard grips harder.
    assert (hand.goal[joints_of("index")] > before[joints_of("index")]).all()


def test_a_finger_that_has_lost_all_touch_looks_for_it_until_what_was_held_is_gone() -> None:
    reflex = HandToHand(HandToHandConfig(hand_to_hand_search_steps=0.3, hand_to_hand_search_s=0.5))
    held = region("index_medial", 0.8)
    reflex.step(sensed(held, region("ring_medial", 0.8), time_s=1.0))
    # The index finger still touches, for longer than a search lasts.
    for time_s in (1.1, 2.0):
        wish = reflex.step(sensed(held, time_s=time_s))
        assert wish is not None
        assert (wish.steps[joints_of("ring")] > 0.0).all()
        # It never touched.
        assert not wish.steps[joints_of("middle")].any()
    wish = reflex.step(sensed(time_s=2.4))
    assert wish is not None
    assert (wish.steps[joints_of("ring")] > 0.0).all()
    assert (wish.steps[joints_of("index")] > 0.0).all()
    assert reflex.step(sensed(time_s=2.6)) is None


# --- all of them


@settings(max_examples=60, deadline=None)
@given(
    data=st.lists(
        st.tuples(
            st.sampled_from(list(LEAP_RIGHT.regions)),
            st.floats(0.0, 200.0),
            st.integers(1, 64),
            st.tuples(*[st.floats(-0.2, 0.2)] * 3),
            st.floats(0.0, 0.02),
        ),
        max_size=13,
    ),
    q=st.lists(st.floats(-0.3, 1.8), min_size=16, max_size=16),
)
def test_no_reflex_answers_with_what_is_not_finite(data: list[tuple], q: list[float]) -> None:
    pressed = [
        region(name, force, taxels, centre_m=centre, slip_m=slip, slipping=slip > 0.0)
        for name, force, taxels, centre, slip in data
    ]
    for name, kind in REFLEXES.items():
        reflex = kind(kind.Config())
        for k in range(3):
            wish = reflex.step(sensed(*pressed, time_s=k * DT_S, q_rad=np.array(q)))
            assert wish is None or np.isfinite(wish.steps).all(), name
