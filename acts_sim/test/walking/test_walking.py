# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Somebody who walks on simulated insoles."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from acts_core.errors import SettingsError
from acts_sim.walking import Walk, walk

TIME_S = np.arange(0.0, 10.0, 0.005)


def test_feet_carry_the_weight_in_turn() -> None:
    walking = walk(Walk(variation=0.0), 10.0, np.random.default_rng(1))
    left, right = (walking.force_n(foot, TIME_S) for foot in range(2))
    assert left[0] + right[0] == pytest.approx(700.0, rel=0.01)
    walks = (TIME_S > 3.0) & (TIME_S < 6.0)
    assert (left[walks] == 0).any()
    assert (right[walks] == 0).any()
    assert ((left + right)[walks] > 300.0).all()
    assert max(left.max(), right.max()) < 1.2 * 700.0
    for foot in range(2):
        begin_s = [footfall.strike_s for footfall in walking.footfalls[foot] if footfall.is_whole]
        assert np.diff(begin_s) == pytest.approx(120.0 / 110.0)


@pytest.mark.parametrize("stance_share", [0.55, 0.62])
@pytest.mark.parametrize("seed", range(5))
def test_feet_stay_half_a_stride_apart_and_one_always_carries(stance_share: float, seed: int) -> None:
    walking = walk(Walk(stance_share=stance_share), 60.0, np.random.default_rng(seed))
    time_s = np.arange(0.0, 60.0, 0.001)
    assert (walking.force_n(0, time_s) + walking.force_n(1, time_s)).min() > 0.0
    left_s, right_s = (np.array([one.strike_s for one in foot if one.is_whole]) for foot in walking.footfalls)
    assert left_s.size == right_s.size > 40
    phase = (right_s[:-1] - left_s[:-1]) / np.diff(left_s)
    assert phase == pytest.approx(0.5, abs=3 * walking.walk.variation)
    assert phase.std() > 0.001
    assert np.diff(left_s).std() == pytest.approx(walking.walk.variation * 120.0 / 110.0, rel=0.4)


def test_no_foot_is_set_down_before_it_is_lifted() -> None:
    for seed in range(20):
        walking = walk(Walk(stance_share=0.9, limp=0.1, variation=0.2), 60.0, np.random.default_rng(seed))
        for foot in walking.footfalls:
            for before, after in itertools.pairwise(foot):
                assert before.toe_off_s <= after.strike_s


def test_the_truth_is_that_of_the_force() -> None:
    walking = walk(Walk(), 10.0, np.random.default_rng(1))
    step = next(footfall for footfall in walking.footfalls[0] if footfall.is_whole)
    rise_s, fall_s = step.above_s(0.25)
    around = walking.force_n(0, np.array([step.strike_s, rise_s, fall_s, step.toe_off_s]))
    assert around == pytest.approx([0.0, 0.25 * 1.1 * 700.0, 0.25 * 1.1 * 700.0, 0.0], rel=0.05, abs=1e-6)
    heel_m, toes_m = walking.y_m(0, np.array([rise_s, fall_s]))
    assert -0.14 < heel_m < -0.07
    assert 0.07 < toes_m < 0.14


def test_frames_hold_force_and_centre() -> None:
    walking = walk(Walk(noise_counts=0.0, object_n=100.0), 10.0, np.random.default_rng(1))
    frames = walking.frames(TIME_S, np.random.default_rng(1)).astype(float)
    assert frames.shape == (TIME_S.size, 2, 33, 15)
    force_n = walking.force_n(0, TIME_S)
    assert frames[:, 0].sum((1, 2)) / 20.0 == pytest.approx(force_n + 100.0, rel=0.02)
    carries = force_n > 300.0
    loads = frames[carries, 0].sum(2) - walking.frames(TIME_S[force_n == 0][:1], np.random.default_rng(1))[0, 0].sum(1)
    centre_m = loads @ walking.walk.along_m / loads.sum(1)
    assert centre_m == pytest.approx(walking.y_m(0, TIME_S[carries]), abs=0.002)


def test_who_stands_makes_no_step_and_seeds_repeat() -> None:
    standing = walk(Walk(cadence_per_min=0.0), 10.0, np.random.default_rng(1))
    assert not any(footfall.is_whole for foot in standing.footfalls for footfall in foot)
    assert standing.force_n(0, TIME_S).min() > 300.0
    frames = [standing.frames(TIME_S[:20], np.random.default_rng(3)) for _ in range(2)]
    assert (frames[0] == frames[1]).all()


@pytest.mark.parametrize(("stance_share", "limp"), [(0.9, 0.12), (0.8, -0.25)])
def test_a_foot_that_would_be_set_down_before_it_is_lifted_is_refused(stance_share: float, limp: float) -> None:
    with pytest.raises(SettingsError, match=rf"stance_share = {stance_share:g} with limp = {limp:g}: .* below 1"):
        Walk(stance_share=stance_share, limp=limp)
    assert Walk(stance_share=0.9, limp=0.1).limp == 0.1
