# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts of something long, such as an edge."""

from __future__ import annotations

import math

import numpy as np
import pytest

from acts_core.sampling import Sampler, SamplingConfig
from acts_core.skin import ForceResponse
from acts_recon.impacts import UNKNOWN_DIRECTION_SD_RAD, Impact, Kind
from acts_recon.settings import ReconstructionSettings

pytestmark = pytest.mark.slow

SAMPLE_S = 18e-6
ONSET_S, CONTACT_S = 0.2, 0.008


SCHEMES = ("tracking", 64), ("tracking", 128), ("adaptive", 128)
RARELY = ("random", 64), ("uniform", 64)


def struck(scheme: str, m: int, angle_rad: float, length_taxels: float) -> tuple[Impact, float, float]:
    """What is told of an edge that strikes, its true force [N], and how far off the place is [pitches]."""
    rows, cols = np.indices((24, 32))
    along = (cols - 15.2) * math.cos(angle_rad) + (rows - 11.7) * math.sin(angle_rad)
    across = (rows - 11.7) * math.cos(angle_rad) - (cols - 15.2) * math.sin(angle_rad)
    edge = 700 * np.exp(-((along / length_taxels) ** 2 + across**2) / 2)
    rng = np.random.default_rng(1)
    settings = ReconstructionSettings(rows=24, cols=32, touch_counts=25)
    recovery = settings.recovery()
    detector = settings.impact_detector(recovery)
    sampler = Sampler(SamplingConfig(scheme, 24, 32, m, threshold_counts=25))
    told = []
    for begin_s in np.arange(0.0, 0.24, (m + 1) * SAMPLE_S):
        next_s = float(begin_s)

        def measure(row: int, col: int) -> int:
            nonlocal next_s
            next_s += SAMPLE_S
            pressed = math.sin(math.pi * min(max((next_s - ONSET_S) / CONTACT_S, 0.0), 1.0))
            return min(max(round(float(edge[row, col] * pressed + 2 * rng.standard_normal())), 0), 1023)

        indices, counts = sampler.frame(measure)
        end_s, duration_s = 100.0 + begin_s + m * SAMPLE_S, m * SAMPLE_S
        recovery.step(indices, counts, end_s, duration_s)
        told += detector.step(end_s, duration_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured)
    over = max((one for one in told if one.is_over), key=lambda one: one.peak_n)
    assert over.kind is Kind.IMPACT
    true_n = float(ForceResponse().force_n(edge[edge > 10]).sum())
    geometry = recovery.geometry
    away_m = math.hypot(over.x_m - geometry.x_m(15.2), over.y_m - geometry.y_m(11.7))
    return over, true_n, away_m / geometry.pitch_m


@pytest.mark.parametrize(
    ("scheme", "m", "angle_rad", "length_taxels"),
    [
        *((scheme, m, angle_rad, 4.0) for scheme, m in SCHEMES for angle_rad in (0.1, 0.5, 0.9, 1.3, 1.7)),
        # A round footprint explains the samples of these well.
        ("tracking", 64, 0.05, 4.0),
        ("tracking", 128, 0.25, 2.5),
        ("tracking", 128, 1.05, 3.0),
        ("tracking", 128, 3.05, 4.0),
        ("adaptive", 64, 1.65, 4.0),
        ("adaptive", 128, 1.45, 5.0),
    ],
)
def test_the_force_of_an_edge_is_that_of_what_was_pressed(
    scheme: str, m: int, angle_rad: float, length_taxels: float
) -> None:
    """A round footprint that passes beside the edge explained it, with up to two hundred times its force."""
    over, true_n, away = struck(scheme, m, angle_rad, length_taxels)
    assert over.peak_n == pytest.approx(true_n, rel=0.2)
    assert over.direction_sd_rad == UNKNOWN_DIRECTION_SD_RAD
    assert away < 1.0


@pytest.mark.parametrize(("scheme", "m"), RARELY)
@pytest.mark.parametrize("length_taxels", [2.5, 4.0])
@pytest.mark.parametrize("angle_rad", [0.1, 0.5, 0.9, 1.3, 1.7])
def test_an_edge_is_known_also_where_each_taxel_is_rarely_measured(
    scheme: str, m: int, angle_rad: float, length_taxels: float
) -> None:
    """There images show less than half of it, and a round footprint may lie anywhere along it."""
    over, true_n, away = struck(scheme, m, angle_rad, length_taxels)
    assert over.peak_n == pytest.approx(true_n, rel=0.5)
    assert over.direction_sd_rad == UNKNOWN_DIRECTION_SD_RAD
    assert away < 1.2
