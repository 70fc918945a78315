# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated hand: what it holds, what its skin feels of that, and that nothing is left to chance."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hand_motors import AROUND_SPHERE, close, switch_on

from acts_core.errors import ActsError, SettingsError
from acts_sim.hand import HandWorld, HandWorldConfig

pytestmark = pytest.mark.slow


def test_a_sphere_lies_on_the_palm_with_its_weight() -> None:
    world = HandWorld()
    for _ in range(300):
        world.step()
    truth = world.truth
    assert world.forces_n.sum() == pytest.approx(world.weight_n, rel=0.01)
    assert truth.patches["palm"].force_n == pytest.approx(world.forces_n.sum())
    assert truth.object_position_m[:2] == pytest.approx((-0.044, -0.035), abs=0.001)
    palm = next(patch for patch in world.layout.patches if patch.name == "palm")
    elsewhere = world.layout.picture(world.forces_n.reshape(32, 32))
    palm.of(elsewhere)[...] = 0.0
    assert not elsewhere.any()


def test_a_skin_that_lies_on_no_link_of_the_hand_is_refused() -> None:
    with pytest.raises(SettingsError, match="layout = square: a patch lies on no link, and the simulated hand has"):
        HandWorld(HandWorldConfig(layout="square"))


def test_physics_that_has_become_unstable_is_told_and_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    world = HandWorld()
    world.data.qvel[:] = 1e12
    with pytest.raises(ActsError, match="unstable after"):
        world.step()
    assert not list(tmp_path.iterdir())


def test_the_closed_hand_holds_a_sphere_and_feels_what_it_holds_it_with() -> None:
    world = HandWorld(HandWorldConfig(seed=2))
    switch_on(world)
    close(world, AROUND_SPHERE)
    truth = world.truth
    assert not truth.object_lost
    assert np.linalg.norm(truth.object_velocity_m_s) < 0.002
    assert sum(one.force_n for one in truth.patches.values()) == pytest.approx(world.forces_n.sum())
    assert truth.patches["palm"].force_n > 1.5 * world.weight_n
    # What the skin does to the object carries its weight: the forces are those of the contacts.
    carried = world.data.xfrc_applied[world.model.body("object").id][:3]
    assert carried == pytest.approx((0.0, 0.0, -world.weight_n), abs=0.05)
    # The fingers that touch are held back by it.
    assert truth.q_rad[5] < 1.29


def test_the_same_seed_gives_the_same_bits_and_another_one_another_skin() -> None:
    def run(seed: int) -> tuple[bytes, bytes]:
        world = HandWorld(HandWorldConfig(object="cylinder", seed=seed))
        switch_on(world)
        close(world, AROUND_SPHERE, 60, 40)
        return world.counts.tobytes(), repr(world.truth).encode()

    assert run(3) == run(3)
    assert run(3)[0] != run(4)[0]


def test_motors_see_their_joints() -> None:
    world = HandWorld(HandWorldConfig(object="none"))
    switch_on(world)
    apart = (*AROUND_SPHERE[:12], 0.8, 0.0, 0.3, 0.5)  # the thumb does not meet the index finger
    close(world, apart, 200, 100)
    for motor, angle in zip(world.motors, world.truth.q_rad, strict=True):
        assert motor["present_position"] == pytest.approx(2048 + angle * 4096 / (2 * np.pi), abs=2)
    assert world.truth.q_rad == pytest.approx(apart, abs=0.1)
    world.blocked.add(5)
    before = world.truth.q_rad[5]
    switch_on(world)
    close(world, [0.0] * 16, 50, 300)
    assert world.truth.q_rad[5] == pytest.approx(before)
    assert abs(world.truth.q_rad[1]) < 0.2


def test_what_needs_no_hand_does_not_load_mujoco() -> None:
    modules = "acts_sim.ball.world_loop, acts_sim.shared.timed_ring, acts_sim.dynamixel.main, acts_sim.ur.main"
    code = f"import sys, {modules}; sys.exit('mujoco' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0


def test_a_world_stands_as_a_truth_has_it_for_a_picture() -> None:
    world, other = (HandWorld(HandWorldConfig(object="cylinder", object_held=True)) for _ in range(2))
    other.put(0.01, 0.0, 0.02, held=True)
    other.motors[2].shaft.position_rad += 0.3
    for _ in range(5):
        other.step()
    world.show(other.truth)
    assert world.truth.q_rad == other.truth.q_rad
    assert world.truth.object_position_m == other.truth.object_position_m
