# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The Kalman filter on made-up touch: how exact it is, and what it does with what cannot be."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from acts_control.ball import BallEstimator, ContactMeasurement, EstimatorConfig
from acts_control.ball.plate import ROLLING, acceleration_of
from acts_core.errors import SettingsError

START_NS = 1_700_000_000_000_000_000
MS = 1_000_000


def touch(
    time_ms: float, x_m: float = 0.01, y_m: float = -0.02, force_n: float = 8.0, *, touched: bool = True
) -> ContactMeasurement:
    return ContactMeasurement(START_NS + round(time_ms * MS), touched, x_m, y_m, force_n)


def settled(config: EstimatorConfig | None = None) -> BallEstimator:
    """An estimator that has followed a ball at rest for 0.3 s."""
    estimator = BallEstimator(config or EstimatorConfig())
    for k in range(300):
        estimator.step(touch(k))
    return estimator


def test_noise_is_averaged_and_velocity_found_at_uneven_times() -> None:
    rng = random.Random(1)
    # It rolls at a constant speed on a level plate.
    estimator = BallEstimator(EstimatorConfig(rolling_resistance=0.0))
    time_ms, errors, speeds = 0.0, [], []
    for k in range(3000):
        time_ms += rng.choice([0.6, 1.0, 1.4, 3.0])
        x, y = 0.04 * time_ms * 1e-3 - 0.05, 0.02 - 0.01 * time_ms * 1e-3
        estimator.step(touch(time_ms, x + rng.gauss(0, 0.001), y + rng.gauss(0, 0.001)))
        if k > 500:
            errors.append(math.hypot(estimator.state.x_m - x, estimator.state.y_m - y))
            speeds.append(estimator.state.vx_m_s)
    assert np.sqrt(np.mean(np.square(errors))) < 0.0006
    assert np.mean(speeds) == pytest.approx(0.04, abs=0.001)
    assert np.std(speeds) < 0.02
    assert estimator.state.restarts == 1


def test_the_deviation_it_tells_is_the_one_it_has() -> None:
    rng = random.Random(2)
    estimator = BallEstimator(EstimatorConfig(acceleration_noise=0.02))
    errors = []
    for k in range(4000):
        estimator.step(touch(k, rng.gauss(0, 0.001), rng.gauss(0, 0.001)))
        if k > 500:
            errors += [estimator.state.x_m, estimator.state.y_m]
    # The ball rests, while the filter allows for accelerations: it promises less than it keeps.
    assert 0.3 * estimator.state.sigma_m < np.std(errors) <= estimator.state.sigma_m


def test_it_is_the_kalman_filter_of_its_model() -> None:
    """Position, velocity and deviation are those of the matrices, at uneven times and on a plate that tilts."""
    rng = random.Random(3)
    sigma_m, q = 0.002, 0.3**2
    estimator = BallEstimator(
        EstimatorConfig(sigma_m, acceleration_noise=0.3, gate_sigmas=1000.0, rolling_resistance=0.0, lever_arm_m=0.0)
    )
    time_ms, mean = 0.0, np.zeros((2, 2))
    # A ball may have some speed when it is first touched [m/s].
    covariance = np.diag([sigma_m**2, 0.3**2])
    estimator.step(touch(time_ms, 0.0, 0.0))
    for _ in range(200):
        dt_s = 1e-3 * rng.choice([1, 4, 30])
        tilt_x, tilt_y = rng.gauss(0.0, 0.05), rng.gauss(0.0, 0.05)
        time_ms += 1e3 * dt_s
        estimator.set_tilt(START_NS + round(time_ms * MS), tilt_x, tilt_y)
        measured = (rng.gauss(0.0, 0.01), rng.gauss(0.0, 0.01)) if rng.random() < 0.7 else None
        estimator.step(touch(time_ms, *measured) if measured else touch(time_ms, touched=False))
        step = np.array([[1.0, dt_s], [0.0, 1.0]])
        mean = step @ mean + np.outer([dt_s**2 / 2.0, dt_s], acceleration_of(tilt_x, tilt_y))
        noise = q * np.array([[dt_s**3 / 3.0, dt_s**2 / 2.0], [dt_s**2 / 2.0, dt_s]])
        covariance = step @ covariance @ step.T + noise
        if measured:
            gain = covariance[:, 0] / (covariance[0, 0] + sigma_m**2)
            mean = mean + np.outer(gain, np.array(measured) - mean[0])
            covariance = covariance - np.outer(gain, covariance[0])
        state = estimator.state
        found = [state.x_m, state.y_m, state.vx_m_s, state.vy_m_s, state.sigma_m]
        assert found == pytest.approx([*mean.ravel(), covariance[0, 0] ** 0.5], rel=1e-6, abs=1e-9)
    assert estimator.state.restarts == 1


@pytest.mark.parametrize(("tilt_x", "tilt_y"), [(0.03, 0.0), (0.0, 0.05), (-0.02, 0.04)])
def test_a_known_tilt_predicts_where_the_ball_goes_unseen(tilt_x: float, tilt_y: float) -> None:
    estimator = settled(EstimatorConfig(lever_arm_m=0.0))
    estimator.set_tilt(START_NS + 300 * MS, tilt_x, tilt_y)
    for k in range(300, 380):
        estimator.step(touch(k, touched=False))
    ax, ay = acceleration_of(tilt_x, tilt_y)
    t = 0.08
    assert estimator.state.valid
    assert estimator.state.x_m == pytest.approx(0.01 + ax * t * t / 2, abs=2e-4)
    assert estimator.state.y_m == pytest.approx(-0.02 + ay * t * t / 2, abs=2e-4)
    assert estimator.state.vx_m_s == pytest.approx(ax * t, abs=2e-3)
    assert estimator.state.without_contact == 80


@pytest.mark.parametrize("axis", ["x", "y"])
def test_turning_the_plate_is_not_taken_for_velocity(axis: str) -> None:
    # The plate turns to 0.05 rad within 0.1 s and carries itself sideways; the ball stays behind by 5/7 L lean.
    lever = 0.155
    estimator = settled(EstimatorConfig(lever_arm_m=lever))
    lean_speed = 0.5
    moved = ROLLING * lever * lean_speed
    for k in range(300, 400):
        lean, behind_m = lean_speed * (k - 300) * 1e-3, moved * (k - 300) * 1e-3
        estimator.set_tilt(START_NS + k * MS, *((0.0, lean) if axis == "x" else (-lean, 0.0)))
        # Gravity's part is left out of this world, and therefore of the check.
        estimator.step(touch(k, 0.01 - behind_m) if axis == "x" else touch(k, 0.01, -0.02 - behind_m))
    state = estimator.state
    found = (state.x_m - 0.01, state.vx_m_s) if axis == "x" else (state.y_m + 0.02, state.vy_m_s)
    assert found[0] == pytest.approx(-moved * 0.099, abs=2e-3)
    # Against the plate the ball moves at -moved = -0.055 m/s; of that nothing may stay as velocity.
    assert found[1] == pytest.approx(0.0, abs=0.02)
    assert state.restarts == 1


def test_without_contact_it_predicts_and_then_is_not_valid() -> None:
    estimator = settled(EstimatorConfig(lost_after_s=0.05))
    for k in range(300, 349):
        estimator.step(touch(k, touched=False))
    assert estimator.state.valid
    estimator.step(touch(350, touched=False))
    state = estimator.state
    assert not state.valid
    assert (state.x_m, state.y_m, state.vx_m_s, state.vy_m_s, state.sigma_m) == (0.0,) * 5
    assert state.stamp_ns == START_NS + 350 * MS
    estimator.step(touch(351, 0.03, 0.03))
    assert state.valid
    assert (state.x_m, state.vx_m_s) == pytest.approx((0.03, 0.0))


def test_a_gap_in_the_messages_counts_as_no_contact() -> None:
    estimator = settled()
    for k in range(450, 455):
        estimator.step(touch(k, 0.02, 0.02))
    assert estimator.state.x_m == pytest.approx(0.02)
    assert estimator.state.restarts == 2


def test_single_outliers_are_left_out() -> None:
    estimator = settled()
    for k in range(300, 400):
        estimator.step(touch(k, 0.06, 0.06) if k % 10 == 0 else touch(k))
    assert estimator.state.outliers == 10
    assert estimator.state.restarts == 1
    assert estimator.state.x_m == pytest.approx(0.01, abs=1e-4)


def test_a_ball_that_was_carried_away_is_followed_after_a_moment() -> None:
    estimator = settled(EstimatorConfig(gate_reset_s=0.03, measurement_sigma_m=0.001))
    for k in range(300, 329):
        estimator.step(touch(k, -0.05, 0.05))
    assert estimator.state.x_m > 0.0
    for k in range(329, 335):
        estimator.step(touch(k, -0.05, 0.05))
    assert estimator.state.x_m == pytest.approx(-0.05, abs=1e-3)
    assert estimator.state.restarts == 2


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_what_is_not_finite_is_counted_and_changes_nothing(bad: float) -> None:
    estimator = settled()
    stamp_ns, x_m = estimator.state.stamp_ns, estimator.state.x_m
    estimator.step(touch(300, bad, 0.0))
    estimator.step(touch(301, 0.0, bad))
    estimator.step(touch(301, 0.0, 0.0, bad))
    estimator.set_tilt(START_NS + 300 * MS, bad, 0.0)
    # The stamp stays: such messages do not count as touch.
    assert (estimator.state.stamp_ns, estimator.state.x_m, estimator.state.not_finite) == (stamp_ns, x_m, 3)
    estimator.step(touch(302))
    assert estimator.state.x_m == pytest.approx(0.01, abs=1e-4)


def test_a_centre_found_with_little_force_hardly_counts() -> None:
    full, part = settled(), settled()
    for k in range(300, 350):
        full.step(touch(k, 0.014, -0.02, 8.0))
        part.step(touch(k, 0.014, -0.02, 4.0))
    assert full.state.x_m == pytest.approx(0.0135, abs=1e-3)
    assert part.state.x_m == pytest.approx(0.010, abs=5e-4)
    assert part.state.sigma_m > full.state.sigma_m


def test_centres_found_with_little_force_hardly_count_as_long_as_some_are_found_with_all_of_it() -> None:
    estimator = settled()
    for k in range(300, 2300):
        estimator.step(touch(k) if k % 100 == 0 else touch(k, 0.014, force_n=4.0))
    assert estimator.state.x_m == pytest.approx(0.010, abs=1e-3)
    assert estimator.state.outliers == 0


def test_a_lighter_ball_is_believed_in_time_and_no_force_at_all_is_no_doubt() -> None:
    lighter = settled()
    for k in range(300, 300 + 30_000, 3):
        lighter.step(touch(k, 0.01, -0.02, 2.0))
    for k in range(30_300, 30_350):
        lighter.step(touch(k, 0.014, -0.02, 2.0))
    assert lighter.state.x_m == pytest.approx(0.014, abs=1e-3)
    unknown = BallEstimator(EstimatorConfig())
    for k in range(100):
        unknown.step(touch(k, 0.01, -0.02, 0.0))
    assert unknown.state.x_m == pytest.approx(0.01, abs=1e-6)
    assert unknown.state.sigma_m < 0.001


def test_rolling_resistance_slows_an_unseen_ball_to_rest_and_not_back() -> None:
    estimator = BallEstimator(EstimatorConfig(rolling_resistance=0.05))
    for k in range(100):
        estimator.step(touch(k, 0.05 * k * 1e-3, 0.0))
    moving = estimator.state.vx_m_s
    for k in range(100, 300, 20):
        estimator.step(touch(k, touched=False))
        assert estimator.state.vx_m_s >= 0.0
    assert estimator.state.vx_m_s < 0.2 * moving


def test_repeated_and_older_stamps_are_ignored_and_counted() -> None:
    estimator = settled()
    stamp_ns, x_m = estimator.state.stamp_ns, estimator.state.x_m
    for late in (299, 298, 100):
        estimator.step(touch(late, 0.05, 0.05))
    assert (estimator.state.stamp_ns, estimator.state.x_m, estimator.state.out_of_order) == (stamp_ns, x_m, 3)


@pytest.mark.parametrize("step_ms", [-3_600_000, -5000, -500, -20, 5000, 3_600_000])
def test_a_clock_that_was_set_is_followed_from_the_fifth_message_on(step_ms: int) -> None:
    estimator = settled()
    for k in range(300, 305):
        assert estimator.state.x_m == pytest.approx(0.01, abs=1e-3)
        estimator.step(touch(k + step_ms, 0.03, 0.03))
    assert estimator.state.valid
    assert estimator.state.x_m == pytest.approx(0.03)
    assert estimator.state.stamp_ns == START_NS + (304 + step_ms) * MS


@pytest.mark.parametrize("off_ms", [-3_600_000, -500, 5000, 3_600_000])
def test_single_messages_of_another_clock_change_nothing(off_ms: int) -> None:
    estimator = settled()
    for k in range(300, 400):
        estimator.step(touch(k + (off_ms if k % 4 == 0 else 0), 0.01 if k % 4 else 0.05))
    assert estimator.state.x_m == pytest.approx(0.01, abs=1e-4)
    assert (estimator.state.restarts, estimator.state.out_of_order) == (1, 25)


def test_after_one_message_from_the_near_future_the_stream_is_found_again() -> None:
    estimator = settled()
    estimator.step(touch(300 + 900))
    for k in range(301, 320):
        estimator.step(touch(k))
    assert estimator.state.valid
    assert estimator.state.stamp_ns == START_NS + 319 * MS


@pytest.mark.parametrize("late_ms", [-3_600_000, 900, 3_600_000])
def test_tilts_of_another_clock_do_not_hide_those_that_follow(late_ms: int) -> None:
    def after_a_tilt(first_ms: int) -> float:
        estimator = settled(EstimatorConfig(lever_arm_m=0.0))
        estimator.set_tilt(START_NS + first_ms * MS, -0.05, 0.05)
        for k in range(300, 400):
            estimator.set_tilt(START_NS + k * MS, 0.02, 0.03)
            estimator.step(touch(k, touched=False))
        return estimator.state.x_m

    assert after_a_tilt(300 + late_ms) == pytest.approx(after_a_tilt(299), abs=1e-4)


@pytest.mark.parametrize(
    "bad", [touch(300, 1000.0), touch(300, 0.0, -1.5), touch(300, force_n=1e6), touch(300, force_n=-1.0)]
)
def test_what_no_ball_on_a_plate_does_is_counted_and_changes_nothing(bad: ContactMeasurement) -> None:
    estimator = settled()
    before = replace(estimator.state)
    estimator.step(bad)
    assert estimator.state == replace(before, received=before.received + 1, implausible=1)


def test_a_tilt_that_no_plate_has_is_left_out() -> None:
    estimator = settled()
    estimator.set_tilt(START_NS + 300 * MS, 0.0, 100.0)
    estimator.step(touch(301))
    assert estimator.state.x_m == pytest.approx(0.01, abs=1e-4)


def test_one_hard_knock_does_not_make_all_that_follows_doubtful() -> None:
    estimator = settled()
    estimator.step(touch(300, force_n=900.0))
    for k in range(301, 330):
        estimator.step(touch(k, 0.014))
    assert estimator.state.x_m > 0.011


@pytest.mark.parametrize("every_ms", [1, 10])
def test_a_hand_that_pressed_on_the_ball_makes_its_place_doubtful_for_a_moment_only(every_ms: int) -> None:
    estimator = settled()
    for k in range(300, 2300, every_ms):
        estimator.step(touch(k, force_n=40.0))
    for k in range(2300, 3700, every_ms):
        estimator.step(touch(k))
    expected = settled()
    for k in range(300, 3700, every_ms):
        expected.step(touch(k))
    for k in range(3700, 3800, every_ms):
        estimator.step(touch(k, 0.014))
        expected.step(touch(k, 0.014))
    assert expected.state.x_m > 0.0135
    assert estimator.state.x_m == pytest.approx(expected.state.x_m, abs=5e-4)


def test_a_hand_that_pressed_before_does_not_make_the_next_ball_doubtful() -> None:
    def after(force_n: float) -> BallEstimator:
        estimator = BallEstimator(EstimatorConfig())
        for k in range(1000):
            estimator.step(touch(k, force_n=force_n))
        for k in range(1000, 2000):
            estimator.step(touch(k, touched=False))
        for k in range(2000, 3000):
            estimator.step(touch(k, 0.010, force_n=5.0))
        for k in range(3000, 3100):
            estimator.step(touch(k, 0.014, force_n=5.0))
        return estimator

    pressed, unpressed = after(25.0), after(5.0)
    assert unpressed.state.x_m == pytest.approx(0.014, abs=1e-3)
    assert pressed.state.x_m == pytest.approx(unpressed.state.x_m, abs=1e-6)


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(SettingsError, match="measurement_sigma_m"):
        EstimatorConfig(measurement_sigma_m=0.0)
