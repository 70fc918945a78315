# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where fingertips belong on a sphere, and how they get there."""

from __future__ import annotations

import numpy as np
import pytest
from hand_rig import DT_S, NAMES, joints_of, region, sensed

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes.spheres import aiming
from acts_control.hand.reflexes.spheres.aiming import approaches, press, reach

UP = np.array([0.0, 0.0, -1.0])
AT_M = np.array([-0.044, -0.035, -0.0345])


def test_the_finger_in_the_middle_comes_from_above_on_what_is_small_and_the_others_from_the_side_on_all() -> None:
    heights = {
        one.part: [one.on_sphere(UP, radius_m) @ UP for radius_m in (0.005, 0.020, 0.060)]
        for one in approaches(sensed(), AT_M, UP).values()
    }
    assert heights["over"] == sorted(heights["over"], reverse=True)
    assert heights["over"][0] > 0.9
    assert heights["over"][2] < 0.5
    for part in ("beside", "against"):
        assert heights[part] == pytest.approx([heights[part][0]] * 3)
        assert heights[part][0] < 0.6


@pytest.mark.parametrize("finger", ["index", "middle", "thumb"])
@pytest.mark.parametrize("turn", [-0.4, 0.4])
def test_a_fingertip_turns_towards_what_it_is_to_face(finger: str, turn: float) -> None:
    q = np.array(LEAP_RIGHT.postures["cup"])
    tip = LEAP_RIGHT.regions[f"{finger}_distal"]

    def facing(angles: np.ndarray) -> np.ndarray:
        return sensed(q_rad=angles).pose.direction(tip.link, tip.normal)

    # About the axis of the joint at its tip, which can do it.
    bent = q.copy()
    bent[joints_of(finger)[-1]] += turn
    wanted, before = facing(bent), facing(q) @ facing(bent)
    to_m = aiming.pad_m(sensed(q_rad=q), finger)
    for _ in range(500):
        q = q + DT_S * reach(sensed(q_rad=q, goal_rad=q), finger, to_m, wanted, 0.15)
    assert facing(q) @ wanted > before + 0.002
    assert aiming.pad_m(sensed(q_rad=q), finger) == pytest.approx(to_m, abs=1e-3)


@pytest.mark.parametrize("speed_m_s", [0.02, -0.02])
def test_what_a_joint_at_its_limit_cannot_do_the_others_do(speed_m_s: float) -> None:
    q = np.array(LEAP_RIGHT.postures["cup"])
    tip = LEAP_RIGHT.regions["index_distal"]
    held = region("index_distal", 0.5, normal=tip.normal)
    free = sensed(held, q_rad=q, goal_rad=q)
    moves = free.pose.jacobian(tip.link, free.pose.point(tip.link, tip.centre_m))
    along = free.pose.direction(tip.link, tip.normal)
    rates = press(free, held, speed_m_s, 1e-4)
    assert moves @ rates @ along == pytest.approx(speed_m_s, rel=0.02)
    fastest = int(np.argmax(np.abs(rates)))
    goal_rad = q.copy()
    goal_rad[fastest] = (LEAP_RIGHT.upper_rad if rates[fastest] > 0.0 else LEAP_RIGHT.lower_rad)[fastest]
    limited = press(sensed(held, q_rad=q, goal_rad=goal_rad), held, speed_m_s, 1e-4)
    assert limited[fastest] == 0.0, NAMES[fastest]
    assert moves @ limited @ along == pytest.approx(speed_m_s, rel=0.1)
    # At its other end it is free.
    goal_rad[fastest] = (LEAP_RIGHT.lower_rad if rates[fastest] > 0.0 else LEAP_RIGHT.upper_rad)[fastest]
    assert press(sensed(held, q_rad=q, goal_rad=goal_rad), held, speed_m_s, 1e-4) == pytest.approx(rates)
