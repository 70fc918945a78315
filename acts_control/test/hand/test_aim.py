# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Closing on something small that the palm feels: `Aim`, one closing step after the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hand_rig import DT_S, LEAP, region, sensed

from acts_control.hand.control.grasp import Aim, Grasp, GraspConfig
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes.spheres.aiming import SMALL_M
from acts_core.skin import RegionContact

POSTURE = np.array(LEAP_RIGHT.postures["cup"])
UP = np.array(LEAP_RIGHT.regions["palm"].normal)
AT_M = np.array(LEAP_RIGHT.regions["palm"].centre_m)


def on_palm(**more: Any) -> RegionContact:
    """Something small in the middle of the palm."""
    given = {"centre_m": tuple(AT_M), "normal": tuple(UP), "spread_m": 0.003, **more}
    return region("palm", 0.2, 4, **given)


def aimed(seconds: float, *pressed: RegionContact, gripping: tuple[str, ...] = ()) -> tuple[np.ndarray, bool]:
    """Joint angles after aiming for a while, all joints following at once; whether fingers are still on their way."""
    aim, q, on_their_way = Aim(GraspConfig(), AT_M, UP), POSTURE.copy(), True
    for _ in range(round(seconds / DT_S)):
        now = sensed(*pressed, q_rad=q, goal_rad=q)
        steps, on_their_way = aim.step(now, gripping)
        assert np.isfinite(steps).all()
        q = np.clip(q + steps * now.step_rad_s * DT_S, LEAP_RIGHT.lower_rad, LEAP_RIGHT.upper_rad)
    return q, on_their_way


class Moments:
    """Steps of closing or aiming with the joints where they are, at one moment after the other."""

    def __init__(self) -> None:
        self.time_s = 10.0

    def steps(self, closing: Grasp | Aim, seconds: float, *pressed: RegionContact, **more: Any) -> np.ndarray:
        """Those of the last one."""
        steps = np.full(16, np.nan)
        for _ in range(round(seconds / DT_S)):
            self.time_s += DT_S
            now = sensed(*pressed, time_s=self.time_s, q_rad=POSTURE, goal_rad=POSTURE, **more)
            if isinstance(closing, Aim):
                steps, _ = closing.step(now, ())
            else:
                wish = closing.step(now)
                assert wish is not None
                steps = wish.steps
        return steps


def distance_m(q: np.ndarray, finger: str) -> float:
    """How far the pad of a fingertip is from where the palm is touched."""
    tip = LEAP_RIGHT.regions[f"{finger}_distal"]
    return float(np.linalg.norm(LEAP.at(q).point(tip.link, tip.centre_m) - AT_M))


def test_the_middle_finger_comes_down_and_the_others_wait_around() -> None:
    q, _ = aimed(3.0, on_palm())
    assert distance_m(q, "middle") < 0.5 * distance_m(POSTURE, "middle")
    for finger in ("index", "ring", "thumb"):
        assert distance_m(q, finger) > distance_m(q, "middle") + 0.005


def test_it_ends_by_itself_where_no_finger_ever_feels_anything() -> None:
    assert aimed(0.5, on_palm())[1]
    assert not aimed(4.0, on_palm())[1]


def test_a_finger_that_touches_presses_on_until_it_grips() -> None:
    touching = region("middle_distal", 0.1)
    now = sensed(on_palm(), touching, q_rad=POSTURE, goal_rad=POSTURE)
    closes = [k for k, name in enumerate(LEAP_RIGHT.names) if name in LEAP_RIGHT.fingers["middle"].closes]
    pressing, _ = Aim(GraspConfig(), AT_M, UP).step(now, ())
    gripping, _ = Aim(GraspConfig(), AT_M, UP).step(now, ("middle",))
    assert np.abs(pressing[closes]).max() > 0.0
    assert not gripping[closes].any()


def test_it_follows_what_the_palm_feels_and_remembers_it_where_that_is_lost() -> None:
    aim = Aim(GraspConfig(), AT_M, UP)
    moved = tuple(np.add(AT_M, (0.004, -0.003, 0.0)).tolist())
    there, _ = aim.step(sensed(on_palm(centre_m=moved), q_rad=POSTURE, goal_rad=POSTURE), ())
    lost, _ = aim.step(sensed(q_rad=POSTURE, goal_rad=POSTURE), ())
    fresh, _ = Aim(GraspConfig(), AT_M, UP).step(sensed(q_rad=POSTURE, goal_rad=POSTURE), ())
    assert lost == pytest.approx(there, abs=0.02)
    assert np.abs(lost - fresh).max() > 0.02


def test_what_held_a_moment_ago_counts_when_closing_ends() -> None:
    """Thumb and palm feel a light object in turns; the other fingers never meet it."""

    def ended(*turns: list[RegionContact]) -> str:
        grasp = Grasp(GraspConfig(grasp_posture="cup", close_timeout_s=0.5, grip_settle_s=0.2))
        for k in range(round(1.0 / DT_S)):
            grasp.step(sensed(*turns[k % len(turns)], q_rad=POSTURE, goal_rad=POSTURE))
            if grasp.ended:
                break
        return grasp.ended

    thumb, palm = region("thumb_distal", 0.8), on_palm(spread_m=0.008)
    assert ended([thumb, palm]) == ended([thumb], [palm], [], []) == "gripped by thumb, palm"
    assert ended([thumb]) == ended([], []) == "nothing was gripped"


def test_what_turns_out_to_be_large_is_closed_upon_by_all_fingers() -> None:
    """A tip on top of something tall, whose palm contact looked like that of something small."""
    tip = region("middle_distal", 0.1, centre_m=LEAP_RIGHT.regions["middle_distal"].centre_m)
    grasp = Grasp(GraspConfig(grasp_posture="cup", aim_shrink_m_s=0.001))
    straight = Grasp(GraspConfig(grasp_posture="cup")).step(sensed(tip, q_rad=POSTURE, goal_rad=POSTURE))
    assert straight is not None
    assert distance_m(POSTURE, "middle") > 2 * SMALL_M
    begin = Moments()
    assert not np.allclose(begin.steps(grasp, 0.3, on_palm()), straight.steps), "it aims"
    assert begin.steps(grasp, 0.1, on_palm(), tip) == pytest.approx(straight.steps)
    # It stays large where the finger comes off again.
    without = Grasp(GraspConfig(grasp_posture="cup")).step(sensed(q_rad=POSTURE, goal_rad=POSTURE))
    assert without is not None
    assert begin.steps(grasp, 0.3, on_palm()) == pytest.approx(without.steps)


@pytest.mark.parametrize("turns", [1, 4])
def test_a_moment_does_not_make_what_is_touched_large(turns: int) -> None:
    """One image tells no more while no other comes, and each new one that says otherwise begins it anew."""
    tip = region("middle_distal", 0.1, centre_m=LEAP_RIGHT.regions["middle_distal"].centre_m)
    aim, begin = Aim(GraspConfig(), AT_M, UP), Moments()
    for _ in range(turns):
        begin.steps(aim, DT_S, on_palm(), tip)
        begin.steps(aim, 0.08, on_palm(), tip, is_new=False)
        begin.steps(aim, DT_S, on_palm())
        assert not aim.is_large
    begin.steps(aim, 0.08, on_palm(), tip)
    assert aim.is_large


def test_closing_aims_only_at_what_is_small_and_only_while_no_finger_touches() -> None:
    def first_way(palm: RegionContact, *pressed: RegionContact) -> bool:
        """Whether closing with this touch has begun to aim."""
        grasp = Grasp(GraspConfig(grasp_posture="cup"))
        steps = np.zeros(16)
        for _ in range(round(0.3 / DT_S)):
            wish = grasp.step(sensed(palm, *pressed, q_rad=POSTURE, goal_rad=POSTURE))
            assert wish is not None
            steps = wish.steps
        straight = Grasp(GraspConfig(grasp_posture="cup")).step(sensed(*pressed, q_rad=POSTURE, goal_rad=POSTURE))
        assert straight is not None
        return not np.allclose(steps, straight.steps)

    assert first_way(on_palm())
    assert not first_way(on_palm(spread_m=0.006))
    assert not first_way(on_palm(), region("index_distal", 0.1))
