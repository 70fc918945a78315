# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How the simulated joints move: lag, limits, and that no command ever breaks them."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from acts_sim.ur.config import CYCLE_S
from acts_sim.ur.joints import Brake, JointState, Motion, Move, Servo, Speed

pytestmark = pytest.mark.slow

SPEED_LIMIT, ACCELERATION_LIMIT = math.pi, 40.0

angles = st.lists(st.floats(-2 * math.pi, 2 * math.pi), min_size=6, max_size=6)
speeds = st.lists(st.floats(-1e6, 1e6), min_size=6, max_size=6)
rates = st.floats(1e-3, 1e3)


def joints(q: list[float] | None = None) -> JointState:
    return JointState(q or [0.0] * 6, SPEED_LIMIT, ACCELERATION_LIMIT)


def servo(target: list[float], lookahead_s: float) -> Servo:
    motion = Servo()
    motion.set(target, lookahead_s)
    return motion


def speed(target: list[float], acceleration: float) -> Speed:
    motion = Speed()
    motion.set(target, acceleration)
    return motion


motions = st.one_of(
    st.builds(servo, angles, st.floats(0.03, 0.2)),
    st.builds(speed, speeds, rates),
    st.builds(Move, angles, rates, rates),
    st.builds(Brake, rates),
)


@settings(deadline=None)
@given(angles, st.lists(st.tuples(motions, st.integers(1, 60)), min_size=1, max_size=8))
@example([0.0] * 5 + [0.5556307571763623], [(servo([0.0] * 6, 0.125), 32), (servo([0.0] * 6, 0.09122768051940741), 31)])
def test_limits_hold_whatever_is_asked(start: list[float], commands: list[tuple[Motion, int]]) -> None:
    state = joints(start)
    for motion, cycles in commands:
        for _ in range(cycles):
            q, qd = list(state.q), list(state.qd)
            motion.step(state, CYCLE_S)
            for index in range(6):
                assert math.isfinite(state.q[index])
                assert abs(state.qd[index]) <= SPEED_LIMIT * (1 + 1e-9)
                assert abs(state.qd[index] - qd[index]) <= ACCELERATION_LIMIT * CYCLE_S * (1 + 1e-6)
                assert abs(state.q[index] - q[index]) <= SPEED_LIMIT * CYCLE_S * (1 + 1e-6)


def test_servo_lags_a_moving_target_by_the_lookahead_time() -> None:
    state, motion = joints(), Servo()
    for cycle in range(1000):
        target = 0.4 * cycle * CYCLE_S
        motion.set([target] * 6, 0.1)
        motion.step(state, CYCLE_S)
    # The cycle in which a target is set already moves towards it.
    assert (target - state.q[0]) / 0.4 == pytest.approx(0.1, abs=CYCLE_S)
    assert state.qd[0] == pytest.approx(0.4, rel=1e-3)


def test_servo_step_is_critically_damped() -> None:
    state, motion = joints(), servo([0.05] * 6, 0.1)
    w = 2.0 / 0.1
    for cycle in range(1, 500):
        motion.step(state, CYCLE_S)
        t = cycle * CYCLE_S
        assert state.q[0] == pytest.approx(0.05 * (1.0 - (1.0 + w * t) * math.exp(-w * t)), abs=1e-9)
    assert state.q[0] == pytest.approx(0.05, abs=1e-6)


@pytest.mark.parametrize("lookahead_s", [0.03, 0.1, 0.2])
@pytest.mark.parametrize("jump", [0.1, 1.0, 6.0])
def test_a_far_target_is_reached_without_overshoot(jump: float, lookahead_s: float) -> None:
    state, motion = joints(), servo([jump] * 6, lookahead_s)
    furthest = 0.0
    for _ in range(2500):
        motion.step(state, CYCLE_S)
        furthest = max(furthest, state.q[0])
    assert state.q[0] == pytest.approx(jump, abs=1e-6)
    assert furthest <= jump + 0.01 * min(jump, 1.0)


@given(angles, angles, st.floats(0.05, 3.14), st.floats(0.1, 40.0))
@settings(deadline=None, max_examples=30)
def test_move_ends_exactly_at_the_target(start: list[float], target: list[float], v: float, a: float) -> None:
    state, motion = joints(start), Move(target, v, a)
    longest = max(abs(end - begin) for begin, end in zip(start, target, strict=True))
    expected_s = longest / v + v / a if longest > v * v / a else 2.0 * math.sqrt(longest / a)
    cycles = 1
    while not motion.step(state, CYCLE_S):
        assert max(abs(rate) for rate in state.qd) <= v * (1 + 1e-9)
        cycles += 1
        assert cycles * CYCLE_S < expected_s + 2 * CYCLE_S
    assert cycles * CYCLE_S >= expected_s - CYCLE_S
    assert state.q == target
    assert state.at_rest


def test_move_first_brakes_an_arm_in_motion() -> None:
    state = joints()
    run = speed([1.0, -0.5, 0, 0, 0, 0], 10.0)
    for _ in range(200):
        run.step(state, CYCLE_S)
    motion = Move([0.0] * 6, 1.0, 2.0)
    for _ in range(2000):
        if motion.step(state, CYCLE_S):
            break
    assert state.q == [0.0] * 6


def test_brake_takes_speed_over_deceleration_and_keeps_the_direction() -> None:
    state = joints()
    run = speed([1.0, -0.5, 0, 0, 0, 0], 40.0)
    for _ in range(100):
        run.step(state, CYCLE_S)
    assert state.qd[:2] == pytest.approx([1.0, -0.5])
    motion, cycles = Brake(5.0), 1
    while not motion.step(state, CYCLE_S):
        assert state.qd[1] == pytest.approx(-0.5 * state.qd[0])
        cycles += 1
    assert cycles * CYCLE_S == pytest.approx(0.2, abs=2 * CYCLE_S)
    assert state.qd == [0.0] * 6


def test_speed_is_reached_at_the_acceleration_and_kept() -> None:
    state, motion = joints(), speed([0.5, 0.25, 0, 0, 0, -9.0], 1.0)
    for _ in range(250):
        motion.step(state, CYCLE_S)
    assert state.qd[5] == pytest.approx(-0.5)
    for _ in range(2000):
        motion.step(state, CYCLE_S)
    assert state.qd == pytest.approx([0.5, 0.25, 0, 0, 0, -SPEED_LIMIT])
