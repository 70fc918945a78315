# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What presses beside an impact has no part in it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from told_impacts import SAMPLE_S, Array, bump

from acts_core.array import ArrayGeometry
from acts_core.sampling import Sampler, SamplingConfig
from acts_recon.impacts import Impact
from acts_recon.settings import ReconstructionSettings

pytestmark = pytest.mark.slow

Samples = list[tuple[NDArray[np.uint16], Array]]

ROWS, COLS, M = 32, 32, 64
FRAME_S = 0.0012
SETTINGS = ReconstructionSettings(rows=ROWS, cols=COLS, noise_counts=2.0)
X_M = ArrayGeometry(ROWS, COLS).x_m(np.arange(COLS))


def sampled(ball: Array, body: Array, onset_s: float) -> tuple[Samples, Samples]:
    """A ball that bounces beside a body that rests: the samples of both, and of the ball alone at the same taxels."""
    sampler = Sampler(SamplingConfig("tracking", ROWS, COLS, M, threshold_counts=15))
    rng = np.random.default_rng(1)
    both: Samples = []
    alone: Samples = []
    for begin_s in np.arange(0.0, 0.18, FRAME_S):
        next_s = float(begin_s)
        of_ball: list[float] = []

        def measure(row: int, col: int) -> int:
            nonlocal next_s
            next_s += SAMPLE_S
            since_s = next_s - onset_s
            push = math.sin(math.pi * since_s / 0.008) if 0 <= since_s <= 0.008 else 0.0
            noise = float(rng.normal(0.0, 2.0))
            of_ball.append(max(round(push * ball[row, col] + noise), 0))  # noqa: B023
            return max(round(push * ball[row, col] + (next_s > 0.02) * body[row, col] + noise), 0)

        indices, counts = sampler.frame(measure)
        both.append((indices, counts.astype(np.float64)))
        alone.append((indices, np.array(of_ball)))
    return both, alone


def told_of(samples: Samples) -> Impact:
    """The impact on the left half of the skin."""
    recovery = SETTINGS.recovery()
    detector = SETTINGS.impact_detector(recovery)
    told: list[Impact] = []
    for number, (indices, counts) in enumerate(samples):
        end_s, duration_s = 1.0 + number * FRAME_S + M * SAMPLE_S, M * SAMPLE_S
        recovery.step(indices, counts.astype(np.uint16), end_s, duration_s)
        told += detector.step(end_s, duration_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured)
    (impact,) = (one for one in told if one.is_over and one.x_m < X_M[16])
    return impact


@pytest.mark.parametrize("onset_ms", [150.0, 150.2, 150.4])
@pytest.mark.parametrize("apart", [8.5, 9.5])
def test_what_rests_beside_an_impact_has_no_part_in_it(apart: float, onset_ms: float) -> None:
    """Its samples were fitted as if they were of the ball: up to ten times the force, or half of it."""
    ball, body = 500 * bump(ROWS, COLS, 15, 7, 1.7), 500 * bump(ROWS, COLS, 15, 7 + apart, 1.3)
    beside, alone = (told_of(samples) for samples in sampled(ball, body, 1e-3 * onset_ms))
    assert beside.kind == alone.kind
    assert beside.peak_n == pytest.approx(alone.peak_n, rel=0.1)
    assert math.dist((beside.x_m, beside.y_m), (alone.x_m, alone.y_m)) < 0.001
    assert math.dist(beside.velocity_m_s, alone.velocity_m_s) < 0.5
