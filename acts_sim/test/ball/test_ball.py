# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The rolling ball against closed solutions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.robots import ur5e
from acts_sim.ball import ball, ball_plate
from acts_sim.ball.ball import BallConfig, BallState
from acts_sim.ball.ball_kernels import STANDARD_GRAVITY_M_S2 as G
from acts_sim.ball.ball_kernels import plate_pose
from acts_sim.ball.ball_plate import JointMotion, PlateConfig, PlateMotion

pytestmark = pytest.mark.slow

FREE = BallConfig(rolling_resistance=0.0)
DT_S = 0.001


def plate(
    pull: tuple[float, float, float] = (0.0, 0.0, -G),
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0),
    turn_change: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> PlateMotion:
    return PlateMotion(np.array([pull, turn, turn_change, (0.0, 0.0, 1.0)]))


def tilted(tilt_x_rad: float, tilt_y_rad: float, config: PlateConfig | None = None) -> PlateMotion:
    config = config or PlateConfig()
    q_rad = np.array(ur5e.LEVEL_Q_RAD)
    q_rad[3], q_rad[4] = ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, tilt_x_rad, tilt_y_rad, config.mount_yaw_rad)
    return ball_plate.motion(config, JointMotion.still(q_rad))


def rolled(config: BallConfig, state: BallState, motion: PlateMotion, seconds: float) -> BallState:
    for _ in range(round(seconds / DT_S)):
        state = ball.step(config, state, motion, DT_S)
    return state


def test_the_default_ball_is_half_a_kilogram_of_steel() -> None:
    assert BallConfig().mass_kg == pytest.approx(0.5105, abs=1e-3)
    assert BallConfig().radius_m == 0.025


@pytest.mark.parametrize("yaw_rad", [0.0, 0.7, -2.0])
@pytest.mark.parametrize(("tilt_x", "tilt_y"), [(0.03, 0.0), (0.0, 0.03), (-0.1, 0.0), (0.0, -0.1), (0.02, 0.05)])
def test_on_a_slope_it_accelerates_with_five_sevenths_of_g_sine(tilt_x: float, tilt_y: float, yaw_rad: float) -> None:
    motion = tilted(tilt_x, tilt_y, PlateConfig(mount_yaw_rad=yaw_rad))
    state = rolled(FREE, BallState(), motion, 0.5)
    angle = math.hypot(tilt_x, tilt_y)
    slope = 5 / 7 * G * math.sin(angle) / angle
    expected = np.array([slope * tilt_y, -slope * tilt_x])
    np.testing.assert_allclose([state.vx_m_s, state.vy_m_s], expected * 0.5, rtol=0.01, atol=1e-9)
    np.testing.assert_allclose([state.x_m, state.y_m], expected * 0.125, rtol=0.01, atol=1e-9)
    assert state.load_n == pytest.approx(FREE.mass_kg * G * math.cos(angle), rel=1e-6)


def test_rolling_down_a_slope_keeps_the_energy() -> None:
    angle = 0.05
    motion = tilted(0.0, angle)
    start = BallState(x_m=-0.03, y_m=0.01, vx_m_s=-0.1, vy_m_s=0.2)

    def energy(state: BallState) -> float:
        return 0.7 * (state.vx_m_s**2 + state.vy_m_s**2) - G * math.sin(angle) * state.x_m

    end = rolled(FREE, start, motion, 0.8)
    assert end.x_m - start.x_m > 0.02
    assert energy(end) == pytest.approx(energy(start), rel=1e-6)


def test_a_level_plate_keeps_it_at_rest() -> None:
    state = rolled(FREE, BallState(0.02, -0.015), tilted(0.0, 0.0), 5.0)
    assert math.hypot(state.x_m - 0.02, state.y_m + 0.015) < 1e-9
    assert rolled(BallConfig(), BallState(0.02, -0.015), tilted(0.0, 0.0), 5.0).x_m == 0.02


def test_it_behaves_the_same_in_every_direction() -> None:
    config = BallConfig()
    along_x = rolled(config, BallState(), tilted(0.0, 0.04), 0.4)
    back = rolled(config, BallState(), tilted(0.0, -0.04), 0.4)
    along_y = rolled(config, BallState(), tilted(-0.04, 0.0), 0.4)
    assert back.x_m == pytest.approx(-along_x.x_m, rel=1e-9)
    assert along_y.y_m == pytest.approx(along_x.x_m, rel=1e-9)
    assert along_y.x_m == pytest.approx(0.0, abs=1e-12)


def test_rolling_resistance_slows_it_to_a_stop_and_never_turns_it_back() -> None:
    config = BallConfig(rolling_resistance=0.01)
    slowing = 5 / 7 * 0.01 * G
    state = rolled(config, BallState(vx_m_s=0.1), plate(), 0.5)
    assert state.vx_m_s == pytest.approx(0.1 - slowing * 0.5, rel=1e-6)
    end = rolled(config, state, plate(), 5.0)
    assert (end.vx_m_s, end.vy_m_s) == (0.0, 0.0)
    assert end.x_m == pytest.approx(0.1**2 / (2 * slowing), rel=1e-3)


@pytest.mark.parametrize(("angle", "moves"), [(0.009, False), (0.011, True)])
def test_rolling_resistance_holds_against_a_slope_as_steep_as_its_coefficient(angle: float, moves: bool) -> None:
    state = rolled(BallConfig(rolling_resistance=0.01), BallState(), tilted(0.0, angle), 0.3)
    assert (state.x_m > 0.0) == moves


def test_a_plate_that_accelerates_leaves_it_behind() -> None:
    state = rolled(FREE, BallState(), plate(pull=(-0.7, 0.0, -G)), 1.0)
    assert state.vx_m_s == pytest.approx(-0.5, rel=1e-6)


def test_a_plate_that_is_lifted_is_pressed_harder_and_one_that_drops_is_not() -> None:
    assert ball.step(FREE, BallState(), plate(pull=(0, 0, -G - 2)), DT_S).load_n == pytest.approx(
        FREE.mass_kg * (G + 2)
    )
    assert ball.step(FREE, BallState(), plate(pull=(0, 0, 1.0)), DT_S).load_n == 0.0


def test_on_a_turntable_it_runs_in_circles_at_two_sevenths_of_the_turntables_speed() -> None:
    """A ball on a turntable circles, in the room's frame, at 2/7 of its rate (Earnshaw 1844)."""
    turn = 3.0
    motion = plate(turn=(0.0, 0.0, turn))
    x0, y0 = 0.03, 0.0
    vx, vy = 0.02, 0.05
    room_v = np.array([vx - turn * y0, vy + turn * x0])
    state = BallState(x0, y0, vx, vy)
    period_s = 2 * math.pi / (2 / 7 * turn)
    steps = 100_000
    path = []
    for step in range(steps):
        angle = turn * period_s * step / steps
        c, s = math.cos(angle), math.sin(angle)
        path.append((c * state.x_m - s * state.y_m, s * state.x_m + c * state.y_m))
        state = ball.step(FREE, state, motion, period_s / steps)
    room = np.array(path)
    centre = room.mean(axis=0)
    radius = np.hypot(*(room - centre).T)
    assert radius.std() < 0.01 * radius.mean()
    assert radius.mean() == pytest.approx(np.hypot(*room_v) / (2 / 7 * turn), rel=0.01)


def test_a_plate_that_starts_to_turn_under_it_leaves_it_where_it_is() -> None:
    """About the x axis: the centre, a radius above the plate, keeps its place in the room while the plate tips."""
    state = ball.step(FREE, BallState(), plate(pull=(0, 0, -G), turn_change=(10.0, 0.0, 0.0)), DT_S)
    assert state.vy_m_s == pytest.approx(FREE.radius_m * 10.0 * DT_S, rel=1e-9)
    assert state.vx_m_s == 0.0


def pose(config: PlateConfig, q_rad: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rotation and origin [m] of the skin in the robot's base frame."""
    rotation, origin_m = plate_pose(q_rad, ball_plate._DH, config.mount_yaw_rad, config.surface_height_m)
    return rotation, origin_m


def test_the_plate_is_where_the_kinematics_of_the_arm_say() -> None:
    config = PlateConfig(mount_yaw_rad=0.4, surface_height_m=0.03)
    c, s = math.cos(0.4), math.sin(0.4)
    mount = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0.03], [0, 0, 0, 1]])
    for q_rad in np.random.default_rng(3).uniform(-3, 3, (50, 6)):
        expected = ur5e.forward_kinematics(q_rad) @ mount
        rotation, origin_m = pose(config, q_rad)
        np.testing.assert_allclose(rotation, expected[:3, :3], atol=1e-12)
        np.testing.assert_allclose(origin_m, expected[:3, 3], atol=1e-12)


def test_the_plates_motion_is_the_derivative_of_its_pose() -> None:
    """Joints on smooth paths; velocity and acceleration of the plate against differences of the pose over time."""
    config = PlateConfig(mount_yaw_rad=-0.3)
    rate = np.array([1.1, 0.7, 1.3, 2.0, 2.5, 1.7])

    def joints(time_s: float) -> JointMotion:
        phase = rate * time_s
        return JointMotion(
            np.array(ur5e.LEVEL_Q_RAD) + 0.2 * np.sin(phase), 0.2 * rate * np.cos(phase), -0.2 * rate**2 * np.sin(phase)
        )

    time_s, h = 0.37, 1e-4
    before, now, after = (pose(config, joints(time_s + k * h).q_rad) for k in (-1, 0, 1))
    motion = ball_plate.motion(config, joints(time_s)).rows
    acceleration = (after[1] - 2 * now[1] + before[1]) / h**2
    np.testing.assert_allclose(motion[0], now[0].T @ (np.array([0, 0, -G]) - acceleration), atol=1e-5)
    spin = now[0].T @ (after[0] - before[0]) / (2 * h)
    np.testing.assert_allclose(motion[1], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-5)
    turn_before, turn_after = (ball_plate.motion(config, joints(time_s + k * h)).rows[1] for k in (-1, 1))
    np.testing.assert_allclose(motion[2], (turn_after - turn_before) / (2 * h), atol=1e-3)
    np.testing.assert_allclose(motion[3], now[0][2])


def test_terms_of_the_turning_frame_are_small_at_the_pace_of_balancing() -> None:
    """What the simpler law 5/7 (g - a) leaves out: under 0.01 g at 0.2 rad/s, and the turn's own change counts most."""
    config = PlateConfig()
    q_rad = np.array(ur5e.LEVEL_Q_RAD)
    slow = ball_plate.motion(config, JointMotion(q_rad, np.array([0, 0, 0, 0.2, 0.2, 0]), np.zeros(6)))
    state = ball.step(FREE, BallState(0.05, 0.05, 0.1, 0.1), slow, DT_S)
    simple = 5 / 7 * slow.rows[0][:2] * DT_S
    assert np.hypot(state.vx_m_s - 0.1 - simple[0], state.vy_m_s - 0.1 - simple[1]) < 0.01 * G * DT_S


@pytest.mark.parametrize("change", [{"diameter_m": 0.0}, {"density_kg_per_m3": float("nan")}, {"diameter_m": -1.0}])
def test_an_impossible_ball_is_refused(change: dict[str, float]) -> None:
    with pytest.raises(SettingsError, match=next(iter(change))):
        replace(BallConfig(), **change)
