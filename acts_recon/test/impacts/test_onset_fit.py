# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Following a slow touch back to its first moment."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from acts_recon.impacts.onset_fit import Rise, follow_back

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
