# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tilt and acceleration, the PID, and the limits of the tilt's motion."""

import itertools
from dataclasses import replace
from math import hypot, radians, sin

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from acts_control.ball import Ball, Reference, ReferenceReport
from acts_control.ball.limiter import LimiterConfig, TiltLimiter
from acts_control.ball.pid import BallPid, PidConfig
from acts_control.ball.plate import GRAVITY_M_S2, ROLLING_GRAVITY_M_S2, acceleration_of, tilt_for
from acts_control.ball.reference import ReferenceFollower, ReferenceLimits
from acts_core.errors import SettingsError

pytestmark = pytest.mark.slow

LIMIT = radians(6)
LEVEL = (0.0, 0.0)
CENTRE = Reference(0.0, 0.0)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_the_tilt_for_an_acceleration_causes_it(ax: float, ay: float) -> None:
    assert acceleration_of(*tilt_for(ax, ay, LIMIT)) == pytest.approx((ax, ay), abs=1e-12)


def test_signs_and_size_of_the_acceleration() -> None:
    ax, ay = acceleration_of(0.0, 0.1)
    assert ax == pytest.approx(5 / 7 * 9.81 * 0.0998334, rel=1e-5)
    assert ay == 0.0
    assert acceleration_of(0.1, 0.0)[1] < 0.0
    assert acceleration_of(*LEVEL) == LEVEL
    assert tilt_for(0.0, 0.0, LIMIT) == LEVEL


@given(st.floats(-50, 50), st.floats(-50, 50))
def test_the_tilt_is_limited_and_keeps_its_direction(ax: float, ay: float) -> None:
    tilt_x, tilt_y = tilt_for(ax, ay, LIMIT)
    assert hypot(tilt_x, tilt_y) <= LIMIT * (1 + 1e-12)
    assert ax * tilt_x + ay * tilt_y == pytest.approx(0.0, abs=1e-6)
    assert ax * tilt_y - ay * tilt_x >= 0.0


def test_the_pid_pushes_the_ball_towards_the_reference_and_brakes_it() -> None:
    pid = BallPid(PidConfig(), LIMIT)
    tilt_x, tilt_y = pid.step(Ball(0.02, 0.0, 0.0, 0.0), CENTRE, LEVEL, 0.004)
    assert tilt_y < 0.0
    assert tilt_x == 0.0
    tilt_x, tilt_y = pid.step(Ball(0.0, 0.0, 0.0, 0.1), CENTRE, LEVEL, 0.004)
    assert tilt_x > 0.0
    assert tilt_y == pytest.approx(0.0, abs=1e-12)


def test_on_a_perfect_course_only_the_reference_is_fed_forward() -> None:
    config = PidConfig(rolling_resistance=0.0)
    reference = Reference(0.01, 0.02, 0.03, -0.01, 0.1, -0.05)
    tilt = tilt_for(0.1, -0.05, LIMIT)
    wanted = BallPid(config, LIMIT).step(Ball(0.01, 0.02, 0.03, -0.01), reference, tilt, 0.004)
    assert wanted == pytest.approx(tilt, abs=1e-12)


def test_rolling_resistance_is_compensated_along_the_reference() -> None:
    config = PidConfig(rolling_resistance=0.01, lever_arm_m=0.0)
    moving = Reference(0.0, 0.0, -0.5, 0.0)
    ax, ay = acceleration_of(*BallPid(config, LIMIT).step(Ball(0.0, 0.0, -0.5, 0.0), moving, LEVEL, 0.004))
    assert ax == pytest.approx(-0.01 * ROLLING_GRAVITY_M_S2, rel=0.01)
    assert ay == pytest.approx(0.0, abs=1e-12)


def test_the_lean_that_the_plate_has_counts_as_position() -> None:
    config = PidConfig(lever_arm_m=0.15, ki=0.0)
    tilt = tilt_for(0.2, 0.0, LIMIT)
    with_lean = acceleration_of(*BallPid(config, LIMIT).step(Ball(0.0, 0.0, 0.0, 0.0), CENTRE, tilt, 0.004))
    assert with_lean[0] == pytest.approx(-config.kp * 0.15 / GRAVITY_M_S2 * 0.2, rel=1e-6)


def test_the_integral_removes_a_standing_error_and_is_bounded() -> None:
    config = PidConfig(max_integral_m_s2=0.1)
    pid = BallPid(config, LIMIT)
    for _ in range(10_000):
        pid.step(Ball(-0.002, 0.0, 0.0, 0.0), CENTRE, LEVEL, 0.004)
    assert pid.state.integral_x_m_s2 == 0.1
    pid.reset()
    assert pid.state.integral_x_m_s2 == 0.0


@pytest.mark.parametrize(("changed", "left"), [({"ki": 0.0}, 0.0), ({"max_integral_m_s2": 0.05}, 0.05)])
@pytest.mark.parametrize("x_m", [-0.002, -0.03])
def test_what_was_integrated_ends_with_the_setting_that_allowed_it(
    changed: dict[str, float], left: float, x_m: float
) -> None:
    """Also where the ball is too far away for anything to be integrated."""
    config = PidConfig(max_integral_m_s2=0.1)
    pid = BallPid(config, LIMIT)
    for _ in range(10_000):
        pid.step(Ball(-0.002, 0.0, 0.0, 0.0), CENTRE, LEVEL, 0.004)
    pid.config = replace(config, **changed)
    pid.step(Ball(x_m, 0.0, 0.0, 0.0), CENTRE, LEVEL, 0.004)
    assert pid.state.integral_x_m_s2 == left


def test_a_ball_that_lags_behind_rolls_harder_than_was_thought() -> None:
    for lag_m, adapted in ((0.003, 0.02), (-0.003, 0.0)):
        pid = BallPid(PidConfig(), LIMIT)
        for _ in range(300):
            pid.step(Ball(0.0, -lag_m, 0.0, 0.05), Reference(0.0, 0.0, 0.0, 0.05), LEVEL, 0.008)
        assert pid.state.resistance == pytest.approx(adapted, abs=0.003)
        pid.reset()
        assert pid.state.resistance == pytest.approx(adapted, abs=0.003)
        pid.step(Ball(0.0, 0.003, 0.0, 0.0), CENTRE, LEVEL, 1.0)
        assert pid.state.resistance == pytest.approx(adapted, abs=0.003)


@pytest.mark.parametrize("ball", [Ball(-0.02, 0.0, 0.0, 0.0), Ball(-0.005, 0.0, -1.0, 0.0)])
def test_nothing_is_integrated_far_away_or_while_the_tilt_is_limited(ball: Ball) -> None:
    pid = BallPid(PidConfig(), LIMIT)
    pid.step(ball, CENTRE, LEVEL, 0.004)
    assert pid.state.integral_x_m_s2 == 0.0
    assert pid.state.saturated == (ball.vx_m_s != 0.0)


def follow(*references: tuple[int, Reference]) -> Reference | None:
    """What is followed after these, each at the time of its stamp [ms]."""
    follower = ReferenceFollower(ReferenceLimits(0.07, 0.2, 0.105, 1.0))
    for stamp_ms, reference in references:
        followed = follower.step(ReferenceReport(stamp_ms * 10**6, reference), stamp_ms * 10**6)
    return followed


@pytest.mark.parametrize("next_ms", [1008, 992, 1000, 2000, -3_600_000, 3_600_000])
def test_the_jerk_is_found_from_the_reference_before_and_from_no_other(next_ms: int) -> None:
    now = follow((1000, Reference(0, 0, 0, 0, 0.2, 0.1)), (next_ms, Reference(0, 0, 0, 0, 0.21, 0.08)))
    expected = (1.25, -2.5) if next_ms == 1008 else (0.0, 0.0)
    assert now is not None
    assert (now.jx_m_s3, now.jy_m_s3) == pytest.approx(expected)


def test_acceleration_and_jerk_count_no_more_than_the_plate_can_do() -> None:
    now = follow((1000, Reference(0, 0, 0, 0, -6.0, 0.0)), (1001, Reference(0, 0, 0, 0, 0.0, 6.0)))
    assert now is not None
    assert now.ay_m_s2 == pytest.approx(ROLLING_GRAVITY_M_S2 * sin(0.105))
    assert hypot(now.jx_m_s3, now.jy_m_s3) == pytest.approx(ROLLING_GRAVITY_M_S2 * 1.0)


def test_a_reference_can_be_carried_on() -> None:
    later = Reference(1.0, 0.0, 2.0, 0.0, 3.0, 0.0, 4.0).after(0.1)
    assert later.x_m == pytest.approx(1.0 + 0.2 + 0.015)
    assert later.vx_m_s == pytest.approx(2.3)
    assert later.ax_m_s2 == pytest.approx(3.4)
    assert later.at_rest() == Reference(later.x_m, 0.0)


TARGETS = st.lists(st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)), min_size=1, max_size=30)


STEPS_S = st.lists(st.sampled_from([0.002, 0.004, 0.008, 0.016, 0.032]), min_size=1, max_size=7)


@given(TARGETS, STEPS_S)
@example([(-0.11, -0.12), (-0.2, 0.07)], [0.002])
def test_tilt_rate_and_acceleration_keep_their_limits(targets: list[tuple[float, float]], steps_s: list[float]) -> None:
    config = LimiterConfig()
    limiter = TiltLimiter(config)
    last, last_rate = (0.0, 0.0), (0.0, 0.0)
    passed = itertools.cycle(steps_s)
    for target in targets:
        for _ in range(5):
            dt = next(passed)
            tilt = limiter.step(*target, dt)
            assert hypot(*tilt) <= config.max_tilt_rad * (1 + 1e-9)
            rate = ((tilt[0] - last[0]) / dt, (tilt[1] - last[1]) / dt)
            assert max(map(abs, rate)) <= config.max_tilt_rate_rad_s * (1 + 1e-6)
            change = max(abs(rate[0] - last_rate[0]), abs(rate[1] - last_rate[1]))
            assert change <= config.max_tilt_acceleration_rad_s2 * dt * (1 + 1e-6)
            last, last_rate = tilt, (limiter.state.rate_x_rad_s, limiter.state.rate_y_rad_s)


@given(TARGETS, st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)), st.sampled_from([0.002, 0.004, 0.008, 0.016]))
def test_from_wherever_it_turns_a_tilt_that_stays_is_reached(
    targets: list[tuple[float, float]], target: tuple[float, float], dt: float
) -> None:
    limiter = TiltLimiter(LimiterConfig())
    for before in targets:
        for _ in range(3):
            limiter.step(*before, dt)
    for _ in range(round(0.8 / dt)):
        tilt = limiter.step(*target, dt)
    share = min(LIMIT / max(hypot(*target), 1e-9), 1.0)
    assert tilt == pytest.approx((share * target[0], share * target[1]), abs=1e-6)


@given(st.floats(-0.1, 0.1), st.sampled_from([0.002, 0.0043, 0.008, 0.016]))
def test_a_tilt_that_stays_is_reached_without_overshoot(target: float, dt: float) -> None:
    limiter = TiltLimiter(LimiterConfig())
    path = [limiter.step(target, 0.0, dt)[0] for _ in range(round(0.5 / dt))]
    assert path[-1] == pytest.approx(target, abs=1e-6)
    assert max(map(abs, path)) <= abs(target) + 1e-9
    for _ in range(round(0.5 / dt)):
        limiter.step(0.0, 0.0, dt)
    assert limiter.is_level


LIMITS = st.lists(st.tuples(st.floats(0.001, 0.35), st.floats(0.01, 3.0)), min_size=2, max_size=20)


@given(TARGETS, LIMITS, st.integers(1, 40))
def test_limits_that_change_in_motion_cause_no_jump(
    targets: list[tuple[float, float]], limits: list[tuple[float, float]], steps: int
) -> None:
    dt = 0.004
    limiter = TiltLimiter(LimiterConfig())
    last, largest_tilt, largest_rate = (0.0, 0.0), 0.0, 0.0
    for k, (tilt_limit, rate_limit) in enumerate(limits):
        limiter.config = LimiterConfig(max_tilt_rad=tilt_limit, max_tilt_rate_rad_s=rate_limit)
        largest_tilt, largest_rate = max(largest_tilt, tilt_limit), max(largest_rate, rate_limit)
        for _ in range(steps):
            tilt = limiter.step(*targets[k % len(targets)], dt)
            rates = ((tilt[0] - last[0]) / dt, (tilt[1] - last[1]) / dt)
            assert max(map(abs, rates)) <= max(largest_rate, 1.0) * (1 + 1e-6)
            assert hypot(*tilt) <= max(largest_tilt, LIMIT) * (1 + 1e-9)
            last = tilt
    # Whatever was before, soon the last limits are kept.
    for _ in range(round(2 * 0.35 / rate_limit / dt) + 200):
        tilt = limiter.step(*targets[-1], dt)
    assert hypot(*tilt) <= tilt_limit * (1 + 1e-9)


@pytest.mark.parametrize("at", [0.02, 0.04, 0.0499])
def test_a_plate_beyond_a_new_limit_brakes_and_comes_back(at: float) -> None:
    dt = 0.004
    limiter = TiltLimiter(LimiterConfig())
    while limiter.state.tilt_x_rad < at:
        limiter.step(0.1, 0.0, dt)
    limiter.config = LimiterConfig(max_tilt_rad=0.03)
    path = [limiter.step(0.1, 0.0, dt)[0] for _ in range(200)]
    # The way to stop from 1 rad/s with 20 rad/s^2.
    assert max(path) <= max(at + 1.0 * dt, 0.03) + 1.0**2 / (2 * 20.0)
    rates = [(b - a) / dt for a, b in itertools.pairwise(path)]
    assert max(abs(b - a) for a, b in itertools.pairwise(rates)) <= 20.0 * dt * (1 + 1e-6)
    assert path[-1] == pytest.approx(0.03, abs=1e-6)


def test_a_larger_limit_is_made_use_of() -> None:
    limiter = TiltLimiter(LimiterConfig(max_tilt_rad=0.03))
    for limit in (0.03, 0.08):
        limiter.config = LimiterConfig(max_tilt_rad=limit)
        for _ in range(200):
            tilt = limiter.step(0.3, 0.4, 0.004)
        assert tilt == pytest.approx((0.6 * limit, 0.8 * limit), abs=1e-6)


@given(TARGETS, st.floats(0.005, 0.1), st.sampled_from([0.002, 0.004, 0.008]))
def test_a_smaller_limit_that_is_kept_once_is_kept(targets: list[tuple[float, float]], limit: float, dt: float) -> None:
    limiter = TiltLimiter(LimiterConfig())
    limiter.config = LimiterConfig(max_tilt_rad=limit)
    for target in targets:
        for _ in range(5):
            assert hypot(*limiter.step(*target, dt)) <= limit * (1 + 1e-9)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), float("-inf")])
def test_a_target_that_is_not_finite_means_level(bad: float) -> None:
    limiter = TiltLimiter(LimiterConfig())
    for _ in range(100):
        limiter.step(0.05, -0.05, 0.004)
    for _ in range(100):
        tilt = limiter.step(bad, 0.05, 0.004)
        assert hypot(*tilt) < 1.0
    assert limiter.is_level


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(SettingsError, match=r"kp = -1.0.*0 to 200"):
        PidConfig(kp=-1.0)
    with pytest.raises(SettingsError, match="max_tilt_rad"):
        LimiterConfig(max_tilt_rad=1.0)
