# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines of young contacts of which a part lies where nothing is measured: beyond a border, on dead taxels."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import Sampler, SamplingConfig
from acts_core.skin import ForceResponse
from acts_recon.outlines import OutlinesConfig, OutlineTracer
from acts_recon.settings import ReconstructionSettings

pytestmark = pytest.mark.slow

GEOMETRY = ArrayGeometry()
ALL = np.arange(1024, dtype=np.uint16)


def disc(row: float, col: float, radius: float) -> NDArray[np.uint16]:
    """Counts of a flat disc, each the mean over its taxel [taxels]."""
    fine = (np.arange(8 * 32) - 3.5) / 8
    pressed = np.hypot(fine[:, None] - row, fine[None, :] - col) <= radius
    share = pressed.reshape(32, 8, 32, 8).mean(axis=(1, 3))
    return np.rint(ForceResponse().counts(share)).astype(np.uint16)


@pytest.mark.parametrize("radius", [2.2, 3.2])
@pytest.mark.parametrize(("row", "col", "part"), [(-0.5, -0.5, 4), (31.5, -0.5, 4), (15.3, 31.5, 2), (15.3, 16.2, 1)])
def test_the_outline_of_what_rests_stays_though_a_part_of_it_lies_beyond_the_skin(
    radius: float, row: float, col: float, part: int
) -> None:
    """At a corner it grew to five times the area within 50 ms, or vanished: beyond a border nothing held the edge."""
    tracer = OutlineTracer(GEOMETRY, touch_counts=60, config=OutlinesConfig(outlines_fast_s=0.5))
    counts = disc(row, col, radius)
    rng = np.random.default_rng(1)
    true_m2 = math.pi * (radius * GEOMETRY.pitch_m) ** 2 / part
    for number in range(300):
        # A fifth of the taxels, and all that are pressed.
        measured = np.union1d(rng.choice(ALL, 200, replace=False), ALL[counts.ravel() > 0]).astype(np.uint16)
        measured_counts = counts.ravel()[measured]
        (outline,) = tracer.step(measured, measured_counts, 1e-3 * number, 1e-3, counts.astype(np.float32))
        assert outline.area_m2 == pytest.approx(true_m2, rel=0.45)


@pytest.mark.parametrize("dead_taxels", ["", "col=19 col=20", "row=12 row=13", "row=15 col=14"])
def test_the_outline_of_what_rests_stays_though_a_part_of_its_edge_lies_on_dead_taxels(dead_taxels: str) -> None:
    """Beside two dead lines it grew to more than twice the area within 50 ms."""
    settings = ReconstructionSettings(touch_counts=60, dead_taxels=dead_taxels)
    recovery = settings.recovery()
    tracer = settings.outline_tracer(recovery)
    sampler = Sampler(SamplingConfig("tracking", m=55, threshold_counts=60))
    pressed = disc(15.3, 16.2, 2.2)
    if recovery.dead is not None:
        pressed[recovery.dead.in_picture] = 0
    rng = np.random.default_rng(0)
    counts = np.zeros((32, 32))

    def measure(row: int, col: int) -> int:
        return int(counts[row, col])

    areas_m2 = []
    for number in range(70):
        counts[:] = np.clip(np.rint(pressed * (number >= 20) + 3 * rng.standard_normal((32, 32))), 0, 1023)
        indices, samples = sampler.frame(measure)
        if recovery.dead is not None:
            indices, samples = recovery.dead.left_out(indices, samples)
        end_s = 1e-3 * number
        recovery.step(indices, samples, end_s, 1e-3)
        found = tracer.step(indices, samples, end_s, 1e-3, recovery.image)
        areas_m2 += [outline.area_m2 for outline in found if number >= 26]
    assert len(areas_m2) == 44
    assert areas_m2 == pytest.approx([math.pi * (2.2 * GEOMETRY.pitch_m) ** 2] * 44, rel=0.45)
