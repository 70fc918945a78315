# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The LEAP hand that is controlled is the one that is simulated: `leap_right.yaml` says the same as `acts_sim.hand`."""

from __future__ import annotations

import numpy as np
import pytest

from acts_control.hand.description import LEAP_RIGHT, HandKinematics
from acts_sim.hand.kinematics import LINKS, PALM, SKIN_THICKNESS_M, SOLIDS, frames

SIMULATED = {link.name: link for link in LINKS}
# The quaternions of the description have five digits.
TURN, LENGTH_M = 2e-5, 1e-6


def test_both_have_the_same_links_joints_motors_and_limits() -> None:
    assert LEAP_RIGHT.base == PALM
    assert [link.name for link in LEAP_RIGHT.links] == list(SIMULATED)
    joints = {joint.name: joint for joint in LEAP_RIGHT.joints}
    for link in LEAP_RIGHT.links:
        simulated, joint = SIMULATED[link.name], joints[link.joint]
        assert (link.parent, joint.name, joint.motor_id) == (simulated.parent, simulated.joint, simulated.motor_id)
        assert (joint.lower_rad, joint.upper_rad) == simulated.limits_rad
        assert link.pose.position_m == simulated.offset_m
    # Angles are given to `frames` in the order of the motors, and to `HandKinematics` in that of the joints.
    assert [joint.motor_id for joint in LEAP_RIGHT.joints] == list(range(16))


@pytest.mark.parametrize("seed", range(5))
def test_at_any_angles_all_links_are_at_the_same_place(seed: int) -> None:
    q_rad = np.random.default_rng(seed).uniform(LEAP_RIGHT.lower_rad, LEAP_RIGHT.upper_rad)
    kinematics = HandKinematics(LEAP_RIGHT)
    pose = kinematics.at(q_rad)
    for name, (origin_m, rotation) in frames(q_rad.tolist()).items():
        number = kinematics.number(name)
        np.testing.assert_allclose(pose.origin[number], origin_m, atol=LENGTH_M)
        np.testing.assert_allclose(pose.rotation[number], rotation, atol=TURN)


@pytest.mark.parametrize("finger", LEAP_RIGHT.fingers)
def test_tips_are_at_the_end_of_the_simulated_fingers(finger: str) -> None:
    (solid,) = (one for one in SOLIDS if one.link == LEAP_RIGHT.fingers[finger].tip_link)
    tip_m = HandKinematics(LEAP_RIGHT).at(np.zeros(16)).tip(finger)
    end_m = np.array(solid.end_m)
    assert np.linalg.norm(tip_m - end_m) <= solid.radius_m + SKIN_THICKNESS_M
