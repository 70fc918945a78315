# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""States of the hand, and what ends or interrupts it."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hand_rig import DT_S, GRIPPED, NAMES, TIP, RigidHand, a_hand, a_holding_hand, region

from acts_control.hand.control import HandSupervisor, SupervisorConfig
from acts_control.hand.description import LEAP_RIGHT, HandKinematics, hand_description
from acts_control.hand.motors import HandReading
from acts_control.hand.nodes.reflexes_node import HandReflexesSettings
from acts_control.hand.reflexes import REFLEXES, HandState, Reflex, Sensed, Wish, make_reflexes
from acts_control.loop_rate import steady_s
from acts_core.skin import RegionContact

pytestmark = pytest.mark.slow

GRIPPER = """
name: gripper
base: body
joints:
  left: {motor: 1, limits_rad: [0, 1.2]}
  right: {motor: 2, limits_rad: [0, 1.2]}
links:
  left_jaw: {parent: body, joint: left, position_m: [0.02, 0, 0], axis: [0, -1, 0]}
  right_jaw: {parent: body, joint: right, position_m: [-0.02, 0, 0], axis: [0, 1, 0]}
fingers:
  left: {closes: {left: 1.0}, tip_link: left_jaw, tip_m: [0, 0, 0.05]}
  right: {closes: {right: 1.0}, tip_link: right_jaw, tip_m: [0, 0, 0.05]}
regions:
  left: {link: left_jaw, finger: left, role: distal}
  right: {link: right_jaw, finger: right, role: distal}
postures: {open: {}, pregrasp: {left: 0.1, right: 0.1}}
"""


def test_its_reflexes_are_told_before_it_has_torque() -> None:
    reflexes = make_reflexes("sharp slip", HandReflexesSettings())
    supervisor = HandSupervisor(HandKinematics(LEAP_RIGHT), reflexes, SupervisorConfig())
    assert supervisor.status.events == {"sharp": 0, "slip": 0}


def test_it_stands_still_until_it_is_told_what_to_do() -> None:
    hand = a_hand()
    assert hand.step([], steps=50) is HandState.STOPPED
    assert not hand.goal.any()


def test_grasp_closes_each_finger_until_it_feels_enough_and_then_holds() -> None:
    hand = a_hand(grip_settle_s=0.02)
    hand.supervisor.grasp()
    assert hand.step([], steps=250) is HandState.CLOSING
    index, ring = hand.angle("index_pip"), hand.angle("ring_pip")
    assert index > LEAP_RIGHT.postures["pregrasp"][2]
    assert hand.step([region("index_distal", 0.8)], steps=25) is HandState.CLOSING
    assert hand.angle("index_pip") == pytest.approx(index, abs=0.03)
    assert hand.angle("ring_pip") > ring + 0.05
    assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    assert "gripped by index, middle, ring, thumb" in hand.supervisor.status.reason
    held = hand.goal.copy()
    hand.step(GRIPPED, steps=100)
    assert hand.goal == pytest.approx(held)


def test_a_hand_that_finds_nothing_opens_again() -> None:
    hand = a_hand(close_speed_rad_s=8.0)
    hand.supervisor.grasp()
    for _ in range(600):
        if hand.step([]) is HandState.OPEN:
            break
    assert hand.supervisor.status.reason == "nothing was gripped"
    hand.step([], steps=600)
    assert hand.goal == pytest.approx(LEAP_RIGHT.postures["open"], abs=1e-3)


@pytest.mark.parametrize(
    ("pressed", "ends"),
    [
        # A finger whose region has its name holds once.
        (("left",), "nothing was gripped"),
        (("left", "right"), "gripped by left, right"),
        (("left", "palm_near"), "gripped by left, palm_near"),
        # What lies on the palm is not held by it.
        (("palm_near", "palm_far"), "nothing was gripped"),
    ],
)
def test_a_finger_and_something_else_hold(tmp_path: Path, pressed: tuple[str, ...], ends: str) -> None:
    path = tmp_path / "gripper.yaml"
    palm = "{link: body, role: palm, centre_m: [0.0, 0.0, 0.0], normal: [0, 0, 1]}"
    path.write_text(GRIPPER.replace("regions:\n", f"regions:\n  palm_near: {palm}\n  palm_far: {palm}\n"))
    gripper = hand_description(str(path))
    supervisor = HandSupervisor(HandKinematics(gripper), {}, SupervisorConfig())
    supervisor.restart(recovered=False)
    q = np.zeros(2)
    for k in range(2000):
        now_s = k * DT_S
        touch = [
            RegionContact(name, one.link, int(name in pressed), 0.8 * (name in pressed), normal=(0.0, 0.0, 1.0))
            for name, one in gripper.regions.items()
        ]
        supervisor.touch(touch, now_s, now_s)
        if k == 1:
            assert supervisor.grasp() == ""
        reading = HandReading(tuple(q), (0.0,) * 2, (0.0,) * 2, (30,) * 2, ("",) * 2)
        q = np.asarray(supervisor.step(reading, q.tolist(), now_s, DT_S))
        if k > 1 and supervisor.status.state is not HandState.CLOSING:
            break
    assert supervisor.status.reason.startswith(ends)


@pytest.mark.parametrize("reflexes", ["none", "sharp slip sphere"])
def test_a_hand_that_says_nothing_of_its_fingertips_closes_on_what_is_small(tmp_path: Path, reflexes: str) -> None:
    """A tip can be aimed with only where its last region has a centre and a normal, which the example's have not."""
    path = tmp_path / "gripper.yaml"
    palm = "palm: {link: body, role: palm, centre_m: [0, 0, 0.01], normal: [0, 0, 1]}"
    path.write_text(GRIPPER.replace("regions:\n", f"regions:\n  {palm}\n"))
    gripper = hand_description(str(path))
    made = make_reflexes(reflexes, HandReflexesSettings())
    supervisor = HandSupervisor(HandKinematics(gripper), made, SupervisorConfig())
    supervisor.restart(recovered=False)
    q = np.zeros(2)
    for k in range(1000):
        # Both jaws touch it at 0.8 rad.
        pressed = {"palm": 0.5, **{name: 0.8 for name, angle in zip(gripper.names, q, strict=True) if angle > 0.8}}
        touch = [
            RegionContact(
                *(name, one.link, 4 * (name in pressed), pressed.get(name, 0.0), one.centre_m),
                normal=(0.0, 0.0, 1.0),
                spread_m=0.003,
            )
            for name, one in gripper.regions.items()
        ]
        supervisor.touch(touch, k * DT_S, k * DT_S)
        if k == 1:
            assert supervisor.grasp() == ""
        reading = HandReading(tuple(q), (0.0,) * 2, (0.0,) * 2, (30,) * 2, ("",) * 2)
        q = np.asarray(supervisor.step(reading, q.tolist(), k * DT_S, DT_S))
        if k > 1 and supervisor.status.state is not HandState.CLOSING:
            break
    assert supervisor.status.reason == "gripped by left, right, palm"


def test_all_reflexes_bear_a_finger_that_feels_only_where_closing_it_moves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "gripper.yaml"
    palm = "palm: {link: body, role: palm, centre_m: [0, 0, 0], normal: [0, 0, 1]}"
    root = GRIPPER.replace("{link: left_jaw, finger: left, role: distal}", "{link: body, finger: left, role: proximal}")
    path.write_text(root.replace("regions:\n", f"regions:\n  {palm}\n"))
    gripper = hand_description(str(path))
    reflexes = make_reflexes(" ".join(REFLEXES), HandReflexesSettings())
    supervisor = HandSupervisor(HandKinematics(gripper), reflexes, SupervisorConfig())
    supervisor.restart(recovered=False)
    touch = [RegionContact(name, one.link, 4, 0.8, normal=(0.0, 0.0, 1.0)) for name, one in gripper.regions.items()]
    q, seen = np.zeros(2), set()
    for k in range(400):
        supervisor.touch(touch, k * DT_S, k * DT_S)
        if k == 1:
            assert supervisor.grasp() == ""
        reading = HandReading(tuple(q), (0.0,) * 2, (0.0,) * 2, (30,) * 2, ("",) * 2)
        q = np.asarray(supervisor.step(reading, q.tolist(), k * DT_S, DT_S))
        assert np.isfinite(q).all()
        seen.add(supervisor.status.state)
    assert HandState.HOLDING in seen


def test_release_opens_and_stop_stands_still_at_any_time() -> None:
    hand = a_holding_hand()
    hand.supervisor.release()
    assert hand.step([], steps=5) is HandState.OPEN
    hand.supervisor.stop()
    assert hand.step([]) is HandState.STOPPED
    stood = hand.goal.copy()
    hand.step([], steps=50)
    assert hand.goal == pytest.approx(stood)


def test_a_tip_is_avoided_while_the_other_fingers_hold_and_then_the_hand_holds_on() -> None:
    hand = a_holding_hand()
    before = hand.goal.copy()
    assert hand.step([TIP, *GRIPPED[1:]], steps=10) is HandState.AVOIDING
    assert hand.supervisor.status.active == ("sharp",)
    opened = [k for k, joint in enumerate(LEAP_RIGHT.joints) if joint.name in LEAP_RIGHT.fingers["index"].closes]
    assert (hand.goal[opened] < before[opened] - 0.02).all()
    others = [k for k in range(16) if k not in opened]
    assert hand.goal[others] == pytest.approx(before[others])
    assert hand.step(GRIPPED[1:], steps=200) is HandState.HOLDING


def test_a_tip_after_a_stop_is_a_new_one() -> None:
    hand = a_holding_hand()
    hand.step([TIP, *GRIPPED[1:]], steps=10)
    hand.supervisor.stop()
    hand.step([], steps=3000)
    hand.q = hand.goal = np.full(16, 1.0)
    hand.supervisor.release()
    hand.step([TIP])
    assert hand.supervisor.status.events["sharp"] == 1, "one image may deceive"
    hand.step([TIP], steps=10)
    assert hand.supervisor.status.events["sharp"] == 2
    assert hand.angle("index_pip") < hand.angle("middle_pip") - 0.1


def test_a_finger_that_presses_with_more_than_is_allowed_gives_way_whatever_is_asked() -> None:
    hand = a_holding_hand()
    before = hand.goal.copy()
    slips = region("index_distal", 60.0, slip_m=3e-4, slipping=True)
    hand.step([slips], steps=3)
    assert hand.angle("index_pip") < before[2]


@pytest.mark.parametrize("besides", [[], [region("index_distal", 60.0)]])
def test_a_palm_that_feels_more_than_is_allowed_opens_all_fingers(besides: list[RegionContact]) -> None:
    hand = a_holding_hand()
    before = hand.goal.copy()
    hand.step([region("palm", 60.0), *besides], steps=3)
    for finger in LEAP_RIGHT.fingers.values():
        assert all(hand.angle(joint) < before[NAMES.index(joint)] for joint in finger.closes)


@pytest.mark.parametrize("share", ["0.01", "40"])
def test_how_fast_a_finger_gives_way_does_not_depend_on_the_unit_of_the_shares_in_closing_it(
    tmp_path: Path, share: str
) -> None:
    """The joint that takes most part has all steps that are asked for, as where its share is 1."""

    def opened(share: str) -> float:
        path = tmp_path / f"gripper_{share}.yaml"
        path.write_text(GRIPPER.replace("{left: 1.0}", f"{{left: {share}}}"))
        gripper = hand_description(str(path))
        supervisor = HandSupervisor(HandKinematics(gripper), {}, SupervisorConfig())
        supervisor.restart(recovered=False)
        presses = RegionContact("left", "left_jaw", 4, 60.0)
        q = np.array([0.8, 0.8])
        for k in range(10):
            supervisor.touch([presses], k * DT_S, k * DT_S)
            reading = HandReading(tuple(q), (0.0,) * 2, (0.0,) * 2, (30,) * 2, ("",) * 2)
            q = np.asarray(supervisor.step(reading, q.tolist(), k * DT_S, DT_S))
        return 0.8 - float(q[0])

    assert opened("1.0") > 0.1
    assert opened(share) == pytest.approx(opened("1.0"))


class Broken(Reflex):
    """A reflex whose sums have gone wrong, and which claims the hand."""

    Config = SupervisorConfig
    priority = 90
    states = frozenset({HandState.CLOSING, HandState.HOLDING})

    def reset(self) -> None:
        pass

    def step(self, sensed: Sensed) -> Wish | None:
        everything = np.ones(16, dtype=bool)
        return Wish(sensed.steps() + math.nan, "broken", everything, avoids=True, holds=True)


def test_of_a_reflex_whose_steps_are_not_finite_nothing_counts() -> None:
    hand = RigidHand(("broken", Broken(None)), grip_settle_s=0.02)
    hand.supervisor.restart(recovered=False)
    hand.step([])
    assert hand.supervisor.grasp() == ""
    assert hand.step([], steps=250) is HandState.CLOSING
    # Its claim of all joints did not keep the hand from closing.
    assert hand.angle("index_pip") > LEAP_RIGHT.postures["pregrasp"][2]
    assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    status = hand.supervisor.status
    assert status.reason.startswith("gripped by")
    assert status.active == ()
    assert status.refused == 270
    assert status.refusal == "broken asks for steps that are not finite"


@pytest.mark.parametrize("recovered", [True, False])
@pytest.mark.parametrize("before", [HandState.CLOSING, HandState.HOLDING, HandState.AVOIDING])
def test_a_hand_whose_motors_had_stopped_does_not_close_before_somebody_asks_for_it(
    recovered: bool, before: HandState
) -> None:
    hand = a_holding_hand()
    if before is HandState.CLOSING:
        hand.supervisor.grasp()
        hand.step([], steps=5)
    elif before is HandState.AVOIDING:
        hand.step([TIP, *GRIPPED[1:]], steps=10)
    assert hand.supervisor.status.state is before
    hand.supervisor.restart(recovered=recovered)
    goal = hand.goal.copy()
    # What was held may have been taken away meanwhile.
    for touch in ([], GRIPPED):
        assert hand.step(touch, steps=250) is HandState.STOPPED
        assert np.array_equal(hand.goal, goal)
    assert hand.supervisor.grasp() == ""
    assert hand.step(GRIPPED) is HandState.CLOSING


def test_after_a_failed_motor_without_touch_the_hand_stops() -> None:
    hand = a_holding_hand()
    assert hand.step(None, steps=100) is HandState.HOLDING
    hand.supervisor.restart(recovered=True)
    assert hand.step(None, steps=2) is HandState.STOPPED
    goal = hand.goal.copy()
    assert hand.step([], steps=50) is HandState.STOPPED
    assert np.array_equal(hand.goal, goal)


@pytest.mark.parametrize(
    ("wanted", "then"),
    [("stop", HandState.STOPPED), ("release", HandState.OPEN), ("grasp", HandState.CLOSING)],
)
@pytest.mark.parametrize("make", [a_hand, a_holding_hand])
def test_what_is_asked_for_while_a_motor_starts_anew_is_done_when_it_is_back(
    make: Callable[[], RigidHand], wanted: str, then: HandState
) -> None:
    hand = make()
    assert getattr(hand.supervisor, wanted)() == ""
    hand.supervisor.restart(recovered=True)
    assert hand.step(GRIPPED) is then


def test_a_closing_hand_whose_program_stood_still_stops_though_touch_is_new() -> None:
    hand = a_hand()
    hand.supervisor.grasp()
    assert hand.step([], steps=50) is HandState.CLOSING
    hand.now_s += 0.05
    assert hand.step([]) is HandState.CLOSING, "less than touch_stale_after_s"
    hand.now_s += 3.0
    goal = hand.goal.copy()
    assert hand.step([], steps=50) is HandState.STOPPED
    assert hand.supervisor.status.reason == "this program stood still while closing; grasp anew"
    assert np.array_equal(hand.goal, goal)


def test_a_closing_hand_whose_motors_did_not_answer_for_a_moment_closes_on() -> None:
    hand = a_hand()
    hand.supervisor.grasp()
    assert hand.step([], steps=50) is HandState.CLOSING
    # One lost answer, waited for by answer_timeout_ms 60.
    hand.now_s += 0.122
    hand.supervisor.waited(0.122)
    assert hand.step([], steps=5) is HandState.CLOSING


def test_a_holding_hand_whose_program_stood_still_holds_on_and_its_reflexes_begin_anew() -> None:
    hand = a_holding_hand()
    slips = [region("index_distal", 0.8, slip_m=3e-4, slipping=True), *GRIPPED[1:]]
    hand.step(slips, steps=2)
    assert hand.supervisor.status.active == ("slip",)
    hand.now_s += 3.0
    goal = hand.goal.copy()
    assert hand.step(slips) is HandState.HOLDING
    assert np.array_equal(hand.goal, goal)
    assert hand.step(GRIPPED, steps=50) is HandState.HOLDING
    assert np.array_equal(hand.goal, goal), "what it had added to the grip is forgotten"


def test_no_reflex_is_told_to_act_in_a_hand_that_has_just_got_its_torque_back() -> None:
    hand = a_holding_hand()
    hand.step([TIP, *GRIPPED[1:]], steps=5)
    before = hand.supervisor.status.active
    hand.supervisor.restart(recovered=False)
    assert (before, hand.supervisor.status.active) == (("sharp",), ())


def test_what_was_asked_for_before_the_hand_was_lost_is_not_done_when_it_is_back() -> None:
    hand = a_hand()
    assert hand.supervisor.grasp() == ""
    hand.supervisor.restart(recovered=False)
    assert hand.step([], steps=50) is HandState.STOPPED


def test_a_grasp_from_before_the_program_stood_still_is_not_done_afterwards() -> None:
    hand = a_hand()
    still_at_s = -math.inf
    hand.supervisor.stood_still = lambda asked_s: "it stood still for 3.0 s" if still_at_s >= asked_s else ""
    assert hand.supervisor.grasp() == ""
    # A motor is being started anew.
    still_at_s = steady_s()
    hand.supervisor.restart(recovered=True)
    goal = hand.goal.copy()
    assert hand.step([], steps=50) is HandState.STOPPED
    assert np.array_equal(hand.goal, goal)
    assert hand.supervisor.status.reason == "it stood still for 3.0 s before it began to close; grasp anew"
    assert hand.supervisor.grasp() == ""
    assert hand.step([]) is HandState.CLOSING


def test_a_finger_that_cannot_come_into_its_shape_does_not_keep_the_hand_from_closing() -> None:
    hand = a_hand()
    hand.stops["thumb_cmc"] = 0.2
    hand.supervisor.grasp()
    hand.step([], steps=600)
    assert hand.angle("ring_pip") > LEAP_RIGHT.postures["pregrasp"][10] + 0.2
