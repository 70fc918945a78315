# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The skin of the simulated hand: footprints, tips, sliding."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hand_motors import switch_on
from numpy.typing import NDArray

from acts_sim.hand import BLUNT_RADIUS_M, SHARP_RADIUS_M, STEP_S, HandWorld, HandWorldConfig, carry_out


def palm(world: HandWorld) -> NDArray[np.float64]:
    """Forces on the palm's taxels [N]; shape (16, 16)."""
    (patch,) = (one for one in world.layout.patches if one.name == "palm")
    return np.asarray(patch.of(world.layout.picture(world.forces_n.reshape(32, 32))), dtype=np.float64)


def centre_m(world: HandWorld) -> NDArray[np.float64]:
    """Centre of pressure on the palm in the palm's frame [m]; shape (3,)."""
    (patch,) = (one for one in world.layout.patches if one.name == "palm")
    forces = palm(world)
    return np.asarray((patch.points_m() * forces[..., None]).sum(axis=(0, 1)) / forces.sum())


def run(world: HandWorld, seconds: float) -> None:
    for _ in range(round(seconds / STEP_S)):
        world.step()


def test_a_press_of_twice_the_force_has_a_larger_footprint() -> None:
    world = HandWorld()
    run(world, 0.3)
    force, pressed = palm(world).sum(), np.count_nonzero(palm(world) > 0.005)
    carry_out(world, "load 1")
    run(world, 0.3)
    assert palm(world).sum() == pytest.approx(2.0 * force, rel=0.01)
    assert np.count_nonzero(palm(world) > 0.005) > pressed
    assert palm(world).max() < 2.0 * force


def test_a_sharp_tip_is_more_concentrated_than_a_blunt_one_and_sits_as_deep_as_told() -> None:
    shares = {}
    for radius_m in (SHARP_RADIUS_M, BLUNT_RADIUS_M):
        world = HandWorld(HandWorldConfig(object="none"))
        world.tip.poke("palm", radius_m, 0.05, 0.0015, row=7.0, col=7.0)
        run(world, 0.3)
        truth = world.truth
        assert truth.tip_depth_m == pytest.approx(0.0015, abs=1e-6)
        assert truth.patches["palm"].tip_force_n == pytest.approx(palm(world).sum())
        assert palm(world).sum() > 0.05
        shares[radius_m] = palm(world).max() / palm(world).sum()
        world.tip.withdraw()
        run(world, 0.01)
        assert not world.forces_n.any()
        assert world.truth.tip_patch == ""
    assert shares[SHARP_RADIUS_M] > 2.0 * shares[BLUNT_RADIUS_M]


@pytest.mark.parametrize("patch", ["index_distal", "middle_medial", "ring_proximal", "thumb_distal", "thumb_proximal"])
def test_a_tip_finds_every_patch_and_pushes_its_finger_away(patch: str) -> None:
    world = HandWorld(HandWorldConfig(object="none"))
    switch_on(world)
    run(world, 0.3)
    world.tip.poke(patch, SHARP_RADIUS_M, 0.05, 0.004)
    run(world, 0.15)
    truth = world.truth
    touched = [name for name, one in truth.patches.items() if one.force_n > 0.0]
    assert touched == [patch]
    assert 0.0 < truth.tip_depth_m < 0.0041


def test_a_tip_finds_any_place_of_a_dome_and_its_depth_there(tmp_path: Path) -> None:
    path = tmp_path / "dome.yaml"
    path.write_text(
        "matrix: [32, 32]\npicture: [32, 32]\npitch_m: 0.003\npatches:\n  dome:\n"
        "    wires: {down: rows 0 to 15, across: cols 0 to 15}\n    link: palm_lower\n"
        "    pose: {position_m: [-0.044, -0.035, -0.040], rpy_rad: [3.14159265, 0, 0]}\n"
        "    radius_m: 0.05\n    row_radius_m: 0.05\n"
    )
    world = HandWorld(HandWorldConfig(object="none", layout=str(path)))
    (patch,) = world.layout.patches
    for row, col in ((2, 3), (7, 7), (13, 2)):
        world.tip.poke("dome", SHARP_RADIUS_M, 0.05, 0.0, row=row, col=col)
        run(world, 0.2)
        # The palm's frame is the world's.
        assert world.data.mocap_pos[0] == pytest.approx(patch.points_m()[row, col], abs=1e-6)
        assert world.truth.tip_depth_m == pytest.approx(0.0, abs=1e-6)
        world.tip.poke("dome", SHARP_RADIUS_M, 0.05, 0.001, row=row, col=col)
        run(world, 0.2)
        assert world.truth.tip_depth_m == pytest.approx(0.001, abs=1e-6)
        assert int(world.forces_n.argmax()) == int(patch.of(world.layout.taxels)[row, col])


def test_the_pattern_moves_with_an_object_that_slides_and_its_rim_slides_first() -> None:
    world = HandWorld(HandWorldConfig(object_held=True))
    carry_out(world, "load 2 20")
    run(world, 0.2)
    before_m, was_m = centre_m(world), np.array(world.truth.object_position_m)
    world.holder.move(np.array([0.004, 0.006, 0.0]), np.zeros(3), 0.3)
    shares, speeds = [], []
    for _ in range(round(0.4 / STEP_S)):
        world.step()
        shares.append(world.truth.patches["palm"].sliding_share)
        speeds.append(world.truth.patches["palm"].sliding_m_s)
    moved_m = np.array(world.truth.object_position_m) - was_m
    assert np.linalg.norm(moved_m[:2]) > 0.005
    assert centre_m(world)[:2] - before_m[:2] == pytest.approx(moved_m[:2], abs=4e-4)
    assert max(shares) == pytest.approx(1.0)
    first_all = shares.index(max(shares))
    assert any(0.02 < share < 0.9 for share in shares[:first_all])
    assert 0.02 < max(speeds) < 0.08


def test_what_is_pulled_less_than_friction_holds_stays() -> None:
    world = HandWorld(HandWorldConfig(object="box"))
    run(world, 0.3)
    was_m = np.array(world.truth.object_position_m)
    along = np.array([0.0, 1.0, 0.0])
    world.disturbances.pull(0.4 * world.weight_n * along, 0.05)
    run(world, 0.5)
    assert np.linalg.norm(np.array(world.truth.object_position_m) - was_m) < 3e-4
    world.disturbances.pull(0.9 * world.weight_n * along, 0.05)
    run(world, 0.2)
    assert world.truth.object_position_m[1] - was_m[1] > 0.01
