# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated hand is the LEAP hand: joints where its URDF has them, skin where its solids are."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from acts_core.skin import layout
from acts_sim.hand import SOLIDS, kinematics, model
from acts_sim.hand.kinematics import FINGERS, LINKS, PALM_SURFACE_Z_M, SKIN_THICKNESS_M

# Motor, anchor [m] and axis of its joint in the palm's frame with all joints at 0, from the published body offsets.
PUBLISHED = [
    (1, (-0.0070, 0.0230, -0.0187), (0, 1, 0)),
    (0, (0.0311, 0.0085, -0.0065), (0, 0, -1)),
    (2, (0.0461, 0.0228, -0.0195), (0, 1, 0)),
    (3, (0.0822, 0.0226, -0.0195), (0, 1, 0)),
    (4, (0.0310, -0.0369, -0.0065), (0, 0, -1)),
    (6, (0.0460, -0.0226, -0.0195), (0, 1, 0)),
    (7, (0.0821, -0.0228, -0.0195), (0, 1, 0)),
    (8, (0.0310, -0.0823, -0.0065), (0, 0, -1)),
    (10, (0.0460, -0.0680, -0.0195), (0, 1, 0)),
    (11, (0.0821, -0.0682, -0.0195), (0, 1, 0)),
    (12, (-0.0693, -0.0012, -0.0216), (-1, 0, 0)),
    (13, (-0.0823, 0.0131, -0.0216), (0, 1, 0)),
    (14, (-0.0823, 0.0301, -0.0071), (0, 0, -1)),
    (15, (-0.0823, 0.0767, -0.0069), (0, 0, -1)),
]
# Fingertips in the frames of their links, and in the palm's with all joints at 0 [m].
TIPS_ON_LINKS = {
    **{f"{finger}_distal": (0.0, -0.0480, 0.0150) for finger in FINGERS},
    "thumb_distal": (0.0, -0.0600, -0.0150),
}
TIPS = {
    "index_distal": (0.1302, 0.0076, -0.0195),
    "middle_distal": (0.1301, -0.0378, -0.0195),
    "ring_distal": (0.1301, -0.0832, -0.0195),
    "thumb_distal": (-0.0823, 0.1367, -0.0219),
}
# Where the tip goes when a joint turns towards its positive side.
CLOSING = {1: (0, 0, -1), 2: (0, 0, -1), 3: (0, 0, -1), 0: (0, -1, 0), 12: (0, 0, -1), 14: (1, 0, 0), 15: (1, 0, 0)}


@pytest.fixture(scope="module")
def hand() -> tuple[mujoco.MjModel, mujoco.MjData]:
    made = model.build(None, 0.001)
    data = mujoco.MjData(made)
    mujoco.mj_forward(made, data)
    return made, data


def test_joints_are_where_they_are_published(hand: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    made, data = hand
    names = {link.motor_id: link.joint for link in LINKS}
    for motor_id, anchor_m, axis in PUBLISHED:
        joint = mujoco.mj_name2id(made, mujoco.mjtObj.mjOBJ_JOINT, names[motor_id])
        assert data.xanchor[joint] == pytest.approx(anchor_m, abs=1.5e-4)
        assert data.xaxis[joint] == pytest.approx(axis, abs=1e-6)


def test_tips_are_where_they_are_published_and_close_towards_the_palm(
    hand: tuple[mujoco.MjModel, mujoco.MjData],
) -> None:
    made, data = hand
    for link, tip_m in TIPS.items():
        body = mujoco.mj_name2id(made, mujoco.mjtObj.mjOBJ_BODY, link)
        there = data.xpos[body] + data.xmat[body].reshape(3, 3) @ TIPS_ON_LINKS[link]
        assert there == pytest.approx(tip_m, abs=1.5e-4)
        for one in LINKS:
            if one.name.split("_")[0] == link.split("_")[0] and one.motor_id in CLOSING:
                joint = mujoco.mj_name2id(made, mujoco.mjtObj.mjOBJ_JOINT, one.joint)
                moves = np.cross(data.xaxis[joint], there - data.xanchor[joint])
                assert moves @ CLOSING[one.motor_id] > 0.5 * np.linalg.norm(moves)


def test_limits_are_those_of_the_hand(hand: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    made, _ = hand
    for link in LINKS:
        joint = mujoco.mj_name2id(made, mujoco.mjtObj.mjOBJ_JOINT, link.joint)
        assert tuple(made.jnt_range[joint]) == pytest.approx(link.limits_rad)


def test_the_kinematics_are_those_of_the_model(hand: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    made, _ = hand
    data = mujoco.MjData(made)
    q_rad = [0.1 + 0.05 * k for k in range(16)]
    for link in LINKS:
        data.joint(link.joint).qpos[0] = q_rad[link.motor_id]
    mujoco.mj_kinematics(made, data)
    for name, (origin_m, rotation) in kinematics.frames(q_rad).items():
        assert data.body(name).xpos == pytest.approx(origin_m, abs=1e-9)
        assert data.body(name).xmat.reshape(3, 3) == pytest.approx(rotation, abs=1e-9)


def test_the_skin_lies_on_the_solids_of_its_links(hand: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    made, data = hand
    patches = layout("leap_right").patches
    assert len(patches) == 13
    for patch in patches:
        body = mujoco.mj_name2id(made, mujoco.mjtObj.mjOBJ_BODY, patch.link)
        turn = data.xmat[body].reshape(3, 3)
        points = patch.points_m().reshape(-1, 3) @ turn.T + data.xpos[body]
        normals = patch.normals().reshape(-1, 3) @ turn.T
        if patch.name == "palm":
            assert points[:, 2] == pytest.approx(PALM_SURFACE_Z_M, abs=1e-6)
            assert normals[:, 2] == pytest.approx(-1.0)
            continue
        (solid,) = (one for one in SOLIDS if one.link == patch.link)
        start, end = np.array(solid.start_m), np.array(solid.end_m)
        along = (end - start) / np.linalg.norm(end - start)
        out = (points - start) - np.outer((points - start) @ along, along)
        radius_m = solid.radius_m + SKIN_THICKNESS_M
        assert np.linalg.norm(out, axis=1) == pytest.approx(radius_m, abs=2e-5)
        assert (out * normals).sum(axis=1) == pytest.approx(radius_m, abs=2e-5)
        inwards = (1, 0, 0) if patch.name.startswith("thumb") else (0, 0, -1)
        middle = normals.mean(axis=0) / np.linalg.norm(normals.mean(axis=0))
        assert middle == pytest.approx(inwards, abs=1e-6)


def test_fingers_collide_with_one_another_but_not_with_themselves() -> None:
    made = model.build(None, 0.001)
    data = mujoco.MjData(made)
    data.joint("index_mcp_side").qpos[0] = 0.5
    data.joint("middle_mcp_side").qpos[0] = -0.5
    mujoco.mj_forward(made, data)
    met = {
        tuple(sorted(made.body(made.geom_bodyid[geom]).name.split("_")[0] for geom in contact.geom))
        for contact in data.contact
    }
    assert met == {("index", "middle")}
    for q_rad in np.linspace(0.0, 1.5, 6):
        mujoco.mj_resetData(made, data)
        for joint in ("pip", "dip"):
            data.joint(f"ring_{joint}").qpos[0] = q_rad
        mujoco.mj_forward(made, data)
        assert data.ncon == 0
