# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Following a touch back to its first moment."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import MeasuredForceResponse
from acts_recon.impacts.footprint_fit import Footprint
from acts_recon.impacts.onset_fit import Rise, follow_back, follow_back_impact
from acts_recon.impacts.samples import RecentSamples

Array = NDArray[np.float64]

BLUR_M2 = 5.6e-6


AT = np.linspace(-4, 4, 61)
NORMAL = np.exp(-0.5 * AT**2) / np.exp(-0.5 * AT**2).sum()


def carried(u: float, away: float) -> float:
    """The mean pressure of a paraboloid on a taxel so many times s from its middle, by summing it up."""
    pressure = np.maximum(u - ((AT[:, None] + away) ** 2 + AT**2) / 2, 0.0)
    return float(NORMAL @ pressure @ NORMAL)


def half_away(u: float) -> float:
    """Where that is half of what it is in the middle."""
    away = np.linspace(0.0, 2 + math.sqrt(2 * u), 50)
    there = np.array([carried(u, one) for one in away.tolist()])
    return float(np.interp(-0.5 * there[0], -there, away))


def rise(onset_s: float, speed_m_s: float, radius_m: float, rng: np.random.Generator) -> Rise:
    """A round body that comes at a steady speed: what a taxel under its middle carries."""
    time_s = onset_s + np.arange(0.006, 0.030, 0.0011)
    u = radius_m * speed_m_s * (time_s - onset_s) / BLUR_M2
    noise_n = np.full(time_s.size, 0.0015)
    force_n = 1e-4 * speed_m_s / 0.1 / radius_m * (u + np.expm1(-u)) + rng.normal(0, noise_n)
    return rise_of_one(time_s, force_n, noise_n, onset_s + 0.002, float(u[-1]))


def rise_of_one(time_s: Array, force_n: Array, noise_n: Array, free_s: float, last_u: float) -> Rise:
    """Of the taxel in the middle, which was measured once before, and no more than noise.

    `last_u`: R d / s^2 at the end.
    """
    area_m2 = math.pi * BLUR_M2 * half_away(last_u) ** 2
    return Rise(
        np.append(free_s, time_s),
        np.append(0.0, force_n),
        np.append(noise_n[:1], noise_n),
        np.arange(time_s.size + 1) > 0,
        np.zeros(time_s.size + 1, dtype=np.intp),
        np.zeros(1),
        float(time_s[0]),
        0.0,
        0.008,
        area_m2,
        BLUR_M2,
    )


@pytest.mark.parametrize("speed_m_s", [0.05, 0.15])
@pytest.mark.parametrize("radius_m", [0.015, 0.08])
def test_the_first_moment_is_found(speed_m_s: float, radius_m: float) -> None:
    rng = np.random.default_rng(1)
    found = [follow_back(rise(10.0, speed_m_s, radius_m, rng)) for _ in range(10)]
    errors_s = np.array([one[0] - 10.0 for one in found if one is not None])
    assert len(errors_s) == 10
    assert np.abs(errors_s).max() < 0.003
    assert abs(errors_s.mean()) < 0.0015
    assert all(one is not None and 0 < one[1] < 0.005 for one in found)


def tap(slowing_s: float, rng: np.random.Generator) -> Rise:
    """A finger that comes at 0.1 m/s and springs back: the depth is half a sine wave."""
    time_s = np.arange(0.006, 1.3 * slowing_s, 0.0011)
    u = 0.012 * 0.1 * slowing_s * np.sin(time_s / slowing_s) / BLUR_M2
    noise_n = np.full(time_s.size, 0.0015)
    force_n = 0.04 * (u + np.expm1(-u)) + rng.normal(0, noise_n)
    return rise_of_one(time_s, force_n, noise_n, 0.002, float(u[-1]))


def test_touches_that_spring_back_are_not_told_late() -> None:
    rng = np.random.default_rng(1)
    found = [follow_back(tap(slowing_s, rng)) for slowing_s in (0.018, 0.025, 0.035) for _ in range(10)]
    errors_s = np.array([one[0] for one in found if one is not None])
    assert len(errors_s) == 30
    assert np.abs(errors_s).max() < 0.0015
    assert abs(errors_s.mean()) < 0.0006


LINEAR = MeasuredForceResponse(np.array([0.0, 1.0]), np.array([0.0, 1000.0]))
NOISE_COUNTS = 3.0
SPREAD_M = 0.002


def followed_back(x: float, y: float, seed: int, noise: float = 0.0) -> float:
    """When a fingertip is said to have touched that comes at 0.1 m/s, at 0 s, so many pitches beside a taxel [s].

    `noise`: what all taxels read before it touches when they were measured last [counts].
    """
    geometry = ArrayGeometry(8, 8, 0.004375, 0.004375)
    samples = RecentSamples(geometry, LINEAR, 25.0, NOISE_COUNTS, 1.0)
    rng = np.random.default_rng(seed)
    place = np.arange(64)
    dx_m = geometry.x_m(place % 8) - geometry.x_m(4 + x)
    dy_m = geometry.y_m(place // 8) - geometry.y_m(4 + y)
    width_m = math.sqrt(SPREAD_M**2 + geometry.pitch_m**2 / 12)
    away = np.hypot(dx_m, dy_m) / width_m
    counts = np.zeros(64)
    # Untouched taxels are measured now and then.
    for time_s in (-0.03, -0.018, -0.006, *np.arange(0.006, 0.030, 0.0011)):
        depth_m = 0.1 * max(time_s, 0.0)
        u = 0.018 * depth_m / width_m**2
        counts = np.array([25.0 * carried(u, one) for one in away.tolist()])
        read = counts + rng.normal(0, NOISE_COUNTS, 64) if time_s != -0.006 else np.full(64, noise)
        read = np.clip(np.rint(read), 0, 1023).astype(np.float32)
        samples.add(time_s, 1e-3, read.reshape(8, 8), np.zeros((8, 8), dtype=np.float32))
    there = float(geometry.x_m(4 + x)), float(geometry.y_m(4 + y))
    rise = samples.rise(-0.03, 0.03, *there, 0, counts.astype(np.float32).reshape(8, 8), SPREAD_M)
    assert rise is not None
    followed = follow_back(rise)
    assert followed is not None
    return followed[0]


@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.3, 0.2)])
def test_what_touches_between_taxels_is_not_told_late(x: float, y: float) -> None:
    errors_s = np.array([followed_back(x, y, seed) for seed in range(10)])
    assert abs(errors_s.mean()) < 0.0012
    assert np.abs(errors_s).max() < 0.0015


def test_what_is_flat_is_not_told_early() -> None:
    """A flat sole that comes at 0.35 m/s: the force on a taxel goes with its depth from the first moment on."""
    rng = np.random.default_rng(1)
    errors_s = []
    for _ in range(10):
        time_s = np.arange(rng.uniform(0.0002, 0.001), 0.030, 0.0023)
        force_n = 3.0 * -np.expm1(-time_s / 0.016) * rng.normal(1, 0.01, time_s.size)
        followed = follow_back(rise_of_one(time_s, force_n, np.full(time_s.size, 0.002), -0.005, 250.0))
        assert followed is not None
        errors_s.append(followed[0])
    assert abs(np.mean(errors_s)) < 0.0003


def test_readings_of_noise_before_a_touch_do_not_begin_it() -> None:
    errors_s = [followed_back(0.2, 0.2, seed, noise=14.0) for seed in range(10)]
    assert np.abs(errors_s).max() < 0.002


def test_too_few_samples_tell_nothing() -> None:
    whole = rise(0.0, 0.1, 0.02, np.random.default_rng(1))
    # One of them is of before.
    few = replace(
        whole,
        time_s=whole.time_s[:4],
        force_n=whole.force_n[:4],
        noise_n=whole.noise_n[:4],
        is_pressed=whole.is_pressed[:4],
        taxel=whole.taxel[:4],
    )
    assert follow_back(few) is None


def bounce(first_s: float, nodes: int = 8, log_sd: float = 0.0) -> Footprint:
    """A ball that touches for 9 ms from 0 s on, whose force is known from a moment on."""
    time_s = np.linspace(first_s, 0.0085, nodes)
    force_n = 50.0 * np.sin(math.pi * time_s / 0.009) ** 1.5
    still, width_m = np.zeros(2), np.full(nodes, 0.005)
    return Footprint(
        time_s, force_n, log_sd**2 * np.eye(nodes), 0.004, 0.0, 0.0, still, np.eye(2), width_m, np.zeros(2)
    )


@pytest.mark.parametrize("first_s", [0.0002, 0.0005, 0.001, 0.002])
@pytest.mark.parametrize("nodes", [5, 8])
def test_an_impact_that_slows_down_is_not_followed_back_too_far(first_s: float, nodes: int) -> None:
    followed = follow_back_impact(bounce(first_s, nodes))
    assert followed is not None
    assert abs(followed.zero_s) < 0.15 * first_s
    assert abs(followed.zero_s) < followed.zero_sd_s < first_s
    assert followed.wait_s == pytest.approx(first_s, rel=0.15)


def test_a_first_force_that_is_less_certain_makes_the_onset_less_certain() -> None:
    certain, uncertain = (follow_back_impact(bounce(0.001, log_sd=log_sd)) for log_sd in (0.0, 1.0))
    assert certain is not None
    assert uncertain is not None
    assert uncertain.zero_s == certain.zero_s
    assert uncertain.zero_sd_s > 2 * certain.zero_sd_s


@pytest.mark.parametrize("first_s", [0.0001, 0.00012])
def test_a_first_force_that_is_no_more_than_its_error_leads_back_to_no_false_moment(first_s: float) -> None:
    """A footprint of few taxels is fitted with some force, even if a ball has only just touched."""
    true = bounce(first_s, 10)
    followed = follow_back_impact(replace(true, force_n=np.maximum(true.force_n, 0.02 * true.force_n.max())))
    assert followed is not None
    assert abs(followed.zero_s) < min(0.0002, 1.5 * followed.zero_sd_s)


def test_a_taxel_does_not_wait_longer_than_the_rest_of_the_rise() -> None:
    """Of a first sample that was late the force says little."""
    followed = follow_back_impact(bounce(0.003, 5))
    assert followed is not None
    assert followed.wait_s == pytest.approx(0.0015, rel=0.1)
    assert followed.zero_sd_s > 0.001


def test_an_impact_that_is_strongest_at_first_is_not_followed_back() -> None:
    assert follow_back_impact(bounce(0.006)) is None
