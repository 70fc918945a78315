# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Following a touch back to its first moment."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from acts_recon.impacts.footprint_fit import Footprint
from acts_recon.impacts.onset_fit import Rise, follow_back, follow_back_impact

BLUR_M2 = 5.6e-6


def rise(onset_s: float, speed_m_s: float, radius_m: float, rng: np.random.Generator) -> Rise:
    """A round body that comes at a steady speed: what a taxel under its middle carries."""
    time_s = onset_s + np.arange(0.006, 0.030, 0.0011)
    u = radius_m * speed_m_s * (time_s - onset_s) / BLUR_M2
    noise_n = np.full(time_s.size, 0.0015)
    force_n = 1e-4 * speed_m_s / 0.1 / radius_m * (u + np.expm1(-u)) + rng.normal(0, noise_n)
    area_m2 = math.pi * (radius_m * speed_m_s * (time_s[-1] - onset_s) + 2 * math.log(2) * BLUR_M2)
    return Rise(time_s, force_n, noise_n, np.array([onset_s + 0.002]), 0.008, area_m2, BLUR_M2)


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
    area_m2 = math.pi * float(u[-1] + 2 * math.log(2)) * BLUR_M2
    return Rise(time_s, force_n, noise_n, np.array([0.002]), 0.008, area_m2, BLUR_M2)


def test_touches_that_spring_back_are_not_told_late() -> None:
    rng = np.random.default_rng(1)
    found = [follow_back(tap(slowing_s, rng)) for slowing_s in (0.018, 0.025, 0.035) for _ in range(10)]
    errors_s = np.array([one[0] for one in found if one is not None])
    assert len(errors_s) == 30
    assert np.abs(errors_s).max() < 0.0015
    assert abs(errors_s.mean()) < 0.0006


def test_too_few_samples_tell_nothing() -> None:
    whole = rise(0.0, 0.1, 0.02, np.random.default_rng(1))
    few = replace(whole, time_s=whole.time_s[:3], force_n=whole.force_n[:3], noise_n=whole.noise_n[:3])
    assert follow_back(few) is None


def bounce(first_s: float, nodes: int = 8, log_sd: float = 0.0) -> Footprint:
    """A ball that touches for 9 ms from 0 s on, whose force is known from a moment on."""
    time_s = np.linspace(first_s, 0.0085, nodes)
    force_n = 50.0 * np.sin(math.pi * time_s / 0.009) ** 1.5
    return Footprint(time_s, force_n, log_sd**2 * np.eye(nodes), 0.004, 0.0, 0.0, np.zeros(2), np.eye(2))


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


def test_a_taxel_does_not_wait_longer_than_the_rest_of_the_rise() -> None:
    """Of a first sample that was late the force says little."""
    followed = follow_back_impact(bounce(0.003, 5))
    assert followed is not None
    assert followed.wait_s == pytest.approx(0.0015, rel=0.1)
    assert followed.zero_sd_s > 0.001


def test_an_impact_that_is_strongest_at_first_is_not_followed_back() -> None:
    assert follow_back_impact(bounce(0.006)) is None
