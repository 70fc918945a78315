# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts that are told of a pressure which a test gives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from acts_core.sampling import Sampler, SamplingConfig
from acts_recon.impacts import Impact
from acts_recon.settings import ReconstructionConfig

Array = NDArray[np.float64]

SAMPLE_S = 18e-6


def bump(rows: int, cols: int, row: float, col: float, width: float) -> Array:
    """A round contact of 1 at its middle."""
    at_row, at_col = np.indices((rows, cols))
    bumped: Array = np.exp(-((at_row - row) ** 2 + (at_col - col) ** 2) / (2 * width**2))
    return bumped


def told_of(
    settings: ReconstructionConfig,
    sampling: SamplingConfig,
    pressure: Callable[[float], Array],
    seconds: float,
    lost_s: tuple[float, float] = (0.0, 0.0),
) -> list[Impact]:
    """What is told of a skin that is sampled taxel by taxel; frames that begin within `lost_s` never arrive."""
    rng = np.random.default_rng(1)
    recovery = settings.recovery()
    detector = settings.impact_detector(recovery)
    sampler = Sampler(sampling)
    frame_s = (sampling.m + 1) * SAMPLE_S
    told: list[Impact] = []
    for begin_s in np.arange(0.0, seconds, frame_s):
        next_s = float(begin_s)

        def measure(row: int, col: int) -> int:
            nonlocal next_s
            next_s += SAMPLE_S
            return min(max(round(float(pressure(next_s)[row, col] + 2 * rng.standard_normal())), 0), 1023)

        indices, counts = sampler.frame(measure)
        if lost_s[0] <= begin_s < lost_s[1]:
            continue
        end_s = 100.0 + begin_s + frame_s
        recovery.step(indices, counts, end_s, sampling.m * SAMPLE_S)
        told += detector.step(
            end_s, sampling.m * SAMPLE_S, recovery.image, recovery.sigma, recovery.age_s, recovery.measured
        )
    return told
