# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The world as a whole: phases, seed, pushes, bad joints."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.robots import ur5e
from acts_core.skin import ForceResponse, layout
from acts_sim.ball.ball_kernels import plate_motion
from acts_sim.ball.ball_plate import JointMotion
from acts_sim.ball.world import Phase, World, WorldConfig, WorldState

pytestmark = pytest.mark.slow

DT_S = 0.001
LEVEL = JointMotion.still(np.array(ur5e.LEVEL_Q_RAD))


def tilted(tilt_x_rad: float, tilt_y_rad: float) -> JointMotion:
    q_rad = np.array(ur5e.LEVEL_Q_RAD)
    q_rad[3], q_rad[4] = ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, tilt_x_rad, tilt_y_rad)
    return JointMotion.still(q_rad)


def run(world: World, joints: JointMotion | None, seconds: float) -> WorldState:
    for _ in range(round(seconds / DT_S)):
        world.step(joints, DT_S)
    return world.state


def test_the_ball_is_put_on_after_a_while_and_presses_from_then_on() -> None:
    world = World(WorldConfig(start_after_s=0.1))
    assert run(world, LEVEL, 0.09).phase is Phase.AWAITED
    assert not world.counts.any()
    state = run(world, LEVEL, 0.05)
    assert state.phase is Phase.ROLLING
    assert (state.ball.x_m, state.ball.y_m) == (0.020, -0.015)
    assert state.ball.load_n == pytest.approx(5.006, abs=0.01)
    force_n = ForceResponse().force_n(world.counts).sum()
    assert force_n == pytest.approx(state.ball.load_n, rel=0.05)


def test_the_ball_is_not_put_on_a_plate_that_is_tilted_or_turns() -> None:
    world = World(WorldConfig(start_after_s=0.0))
    assert run(world, tilted(0.1, 0.0), 0.05).phase is Phase.AWAITED
    turning = JointMotion(np.array(ur5e.LEVEL_Q_RAD), np.array([0, 0, 0, 0.5, 0, 0]), np.zeros(6))
    assert run(world, turning, 0.05).phase is Phase.AWAITED
    assert run(world, LEVEL, 0.001).phase is Phase.ROLLING


def test_without_joints_the_plate_starts_level_and_then_keeps_its_last_pose() -> None:
    world = World(WorldConfig(start_after_s=0.0))
    assert run(world, None, 1.0).ball.x_m == 0.020
    run(world, tilted(0.0, 0.05), 0.05)
    before = world.state.ball
    after = run(world, None, 0.05).ball
    assert after.vx_m_s - before.vx_m_s == pytest.approx(5 / 7 * (9.80665 * 0.05 - 0.005 * 9.80665) * 0.05, rel=0.02)


def test_a_ball_that_rolls_off_presses_nothing_and_stays_off() -> None:
    world = World(WorldConfig(start_after_s=0.0))
    run(world, LEVEL, 0.01)
    state = run(world, tilted(0.0, 0.1), 0.8)
    assert state.phase is Phase.FALLEN
    assert state.falls == 1
    assert not world.counts.any()
    assert run(world, LEVEL, 2.0).phase is Phase.FALLEN


def test_it_leaves_at_the_edge_of_the_pad() -> None:
    world = World(WorldConfig(start_after_s=0.0, start_x_m=0.0699, start_y_m=0.0))
    assert run(world, LEVEL, 0.1).phase is Phase.ROLLING
    assert world.counts.any()
    world = World(WorldConfig(start_after_s=0.0, start_x_m=0.0701, start_y_m=0.0))
    assert run(world, LEVEL, 0.1).phase is Phase.FALLEN


def test_a_ball_that_fell_off_is_put_back_when_asked_for() -> None:
    world = World(WorldConfig(start_after_s=0.0, replace_after_s=0.5))
    run(world, LEVEL, 0.01)
    run(world, tilted(0.0, 0.1), 0.8)
    state = run(world, LEVEL, 0.6)
    assert state.phase is Phase.ROLLING
    assert (state.ball.x_m, state.ball.y_m) == (0.020, -0.015)
    assert state.falls == 1


def test_a_ball_that_fell_off_is_put_back_at_once_when_somebody_asks_for_it() -> None:
    world = World(WorldConfig(start_after_s=0.1))
    assert world.put_back() == "the ball is not yet on the plate"
    run(world, LEVEL, 0.2)
    assert world.put_back() == "the ball is on the plate"
    fallen = run(world, tilted(0.0, 0.1), 0.8)
    assert fallen.phase is Phase.FALLEN
    assert world.put_back() == ""
    # Not on a slope.
    assert run(world, tilted(0.0, 0.1), 0.1).phase is Phase.FALLEN
    assert run(world, LEVEL, 0.01).phase is Phase.ROLLING
    # Once for each time that somebody asks.
    run(world, tilted(0.0, 0.1), 0.8)
    assert run(world, LEVEL, 1.0).phase is Phase.FALLEN


def test_pushes_come_in_time_with_the_given_speed() -> None:
    config = WorldConfig(
        start_after_s=0.0,
        start_x_m=0.0,
        start_y_m=0.0,
        push_speed_m_s=0.05,
        push_period_s=0.2,
        rolling_resistance=0.0,
    )
    world = World(config)
    assert run(world, LEVEL, 0.15).pushes == 0
    state = run(world, LEVEL, 0.1)
    assert state.pushes == 1
    assert math.hypot(state.ball.vx_m_s, state.ball.vy_m_s) == pytest.approx(0.05, rel=1e-6)
    assert run(world, LEVEL, 0.4).pushes == 3


def test_the_same_seed_gives_the_same_world_and_another_another() -> None:
    def path(seed: int) -> list[tuple[float, float]]:
        world = World(WorldConfig(start_after_s=0.1, push_speed_m_s=0.03, push_period_s=0.1, seed=seed))
        positions = []
        for step in range(1000):
            state = world.step(tilted(0.01 * math.sin(step / 50), 0.0), DT_S)
            positions.append((state.ball.x_m, state.ball.y_m))
        return positions

    assert path(5) == path(5)
    assert path(5) != path(6)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -1e30])
@pytest.mark.parametrize("where", ["q_rad", "qd_rad_s", "qdd_rad_s2"])
def test_bad_joints_are_refused_and_counted_and_the_plate_keeps_its_pose(bad: float, where: str) -> None:
    world = World(WorldConfig(start_after_s=0.0))
    good = tilted(0.0, 0.02)
    run(world, good, 0.01)
    values = {"q_rad": good.q_rad.copy(), "qd_rad_s": np.zeros(6), "qdd_rad_s2": np.zeros(6)}
    values[where][4] = bad
    state = run(world, JointMotion(**values), 0.05)
    assert state.joints_refused == 50
    np.testing.assert_array_equal(state.joints.q_rad, good.q_rad)
    assert math.isfinite(state.ball.x_m)
    assert state.phase is Phase.ROLLING
    assert np.isfinite(world.counts).all()
    assert run(world, good, 0.01).joints_refused == 50


@pytest.mark.parametrize("where", ["q_rad", "qd_rad_s", "qdd_rad_s2"])
@pytest.mark.parametrize(
    ("given", "words"),
    [
        ([0.0] * 6, "is list: needed is an array of numpy, of 6 float64"),
        (None, "is NoneType"),
        (np.zeros(5), r"of shape \(5,\), float64: needed is \(6,\), float64"),
        (np.zeros(8), r"of shape \(8,\)"),
        (np.zeros((1, 6)), r"of shape \(1, 6\)"),
        (np.zeros(()), r"of shape \(\)"),
        (np.zeros(6, np.float32), "float32"),
        (np.zeros(6, np.int64), "int64"),
        (np.zeros(6, ">f8"), ">f8"),
    ],
)
def test_joints_of_another_kind_are_refused(where: str, given: Any, words: str) -> None:
    values: dict[str, Any] = {name: np.zeros(6) for name in ("q_rad", "qd_rad_s", "qdd_rad_s2")}
    with pytest.raises(ArrayError, match=f"{where} .*{words}"):
        JointMotion(**{**values, where: given})
    with pytest.raises(ArrayError, match="q_rad of shape"):
        JointMotion.still(np.zeros(7))


def test_joints_in_another_order_move_the_plate_and_nothing_is_compiled() -> None:
    world, plain = World(WorldConfig(start_after_s=0.0)), World(WorldConfig(start_after_s=0.0))
    joints = np.zeros((6, 2))
    joints[:, 0] = ur5e.LEVEL_Q_RAD
    fixed = np.zeros(6)
    fixed.flags.writeable = False
    plain.step(LEVEL, DT_S)
    compiled = len(plate_motion.signatures)  # type: ignore[attr-defined]
    assert world.step(JointMotion(joints[:, 0], joints[:, 1], fixed), DT_S).ball == plain.state.ball
    assert len(plate_motion.signatures) == compiled  # type: ignore[attr-defined]


def test_a_wild_arm_never_makes_a_field_that_is_not_one() -> None:
    world = World(WorldConfig(start_after_s=0.0, replace_after_s=0.001, start_slope=2.0, start_turn_rate_rad_s=100.0))
    rng = np.random.default_rng(4)
    for _ in range(2000):
        joints = JointMotion(rng.uniform(-90, 90, 6), rng.uniform(-90, 90, 6), rng.uniform(-9e4, 9e4, 6))
        world.step(joints, DT_S)
        assert np.isfinite(world.counts).all()
        assert 0 <= world.counts.min() <= world.counts.max() <= 1023
    assert world.state.falls > 0


def test_the_plates_own_acceleration_moves_the_load() -> None:
    """Wrist 1 speeding up lifts the pad, which lies beside its axis."""
    world = World(WorldConfig(start_after_s=0.0))
    run(world, LEVEL, 0.01)
    loads = []
    for acceleration in (-5.0, 0.0, 5.0):
        joints = JointMotion(np.array(ur5e.LEVEL_Q_RAD), np.zeros(6), np.array([0, 0, 0, acceleration, 0, 0]))
        loads.append(world.step(joints, 1e-6).ball.load_n)
    assert loads[0] != pytest.approx(loads[1], rel=0.01)
    assert loads[0] + loads[2] == pytest.approx(2 * loads[1], rel=0.01)


@pytest.mark.parametrize("name", ["insole", "glove", "end_effector"])
def test_the_ball_presses_the_picture_of_the_skin_whatever_the_wires(name: str) -> None:
    config = WorldConfig(layout=name, start_after_s=0.0, start_x_m=0.012, start_y_m=-0.009)
    world = World(config)
    state = run(world, LEVEL, 0.01)
    skin, geometry = layout(name), config.geometry
    picture_n = ForceResponse().force_n(skin.picture(world.counts.reshape(32, 32)))
    x_m, y_m = geometry.x_m(np.arange(skin.cols)), geometry.y_m(np.arange(skin.rows))
    centre_m = np.array([picture_n.sum(0) @ x_m, picture_n.sum(1) @ y_m]) / picture_n.sum()
    assert centre_m == pytest.approx((state.ball.x_m, state.ball.y_m), abs=1e-3)
    assert picture_n.sum() == pytest.approx(state.ball.load_n, rel=0.05)


def test_where_there_is_no_skin_nothing_is_read(tmp_path: Path) -> None:
    path = tmp_path / "half.yaml"
    path.write_text(
        "matrix: [8, 8]\npicture: [8, 8]\npitch_m: 0.005\n"
        "patches:\n  half: {wires: {down: rows 0 to 3, across: cols 7 to 0}}\n"
    )
    world = World(WorldConfig(layout=str(path), rows=8, cols=8, start_after_s=0.0, start_x_m=0.0, start_y_m=0.0))
    run(world, LEVEL, 0.01)
    counts = world.counts.reshape(8, 8)
    assert counts[3].any()
    assert not counts[4:].any()


def test_the_ball_leaves_at_the_edge_of_the_picture() -> None:
    for start_y_m, phase in ((0.1399, Phase.ROLLING), (0.1401, Phase.FALLEN)):
        world = World(WorldConfig(layout="insole", start_after_s=0.0, start_x_m=0.0, start_y_m=start_y_m))
        assert run(world, LEVEL, 0.1).phase is phase


def test_a_layout_for_another_matrix_is_refused() -> None:
    with pytest.raises(ArrayError, match="insole"):
        World(WorldConfig(layout="insole", rows=16))


def test_the_square_pad_is_that_of_the_paper_unless_its_pitch_is_given() -> None:
    assert WorldConfig().geometry == ArrayGeometry(row_pitch_m=0.140 / 32)
    assert WorldConfig(pitch_m=0.002).geometry == ArrayGeometry(pitch_m=0.002, row_pitch_m=0.002)


@pytest.mark.parametrize("place", [{"start_x_m": 0.2}, {"start_y_m": -0.5}])
def test_a_start_beside_the_plate_is_refused(place: dict[str, Any]) -> None:
    with pytest.raises(SettingsError, match=r"beside the plate, which reaches 0\.07 m along x and 0\.07 m along y"):
        World(WorldConfig(**place))


@pytest.mark.parametrize(
    "change", [{"rows": 0}, {"cols": 65}, {"push_period_s": 0.0}, {"start_x_m": float("nan")}, {"seed": -1}]
)
def test_impossible_settings_are_refused(change: dict[str, Any]) -> None:
    with pytest.raises(SettingsError, match=next(iter(change))):
        WorldConfig(**change)
