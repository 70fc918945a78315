# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An impact at the border of two patches belongs to the one that it presses, and to that alone."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from told_impacts import Array, bump, told_of

from acts_core.array import ArrayGeometry
from acts_core.sampling import SamplingConfig
from acts_core.skin import ForceResponse
from acts_recon.impacts import Impact, Kind
from acts_recon.settings import ReconstructionConfig, ReconstructionSettings

pytestmark = pytest.mark.slow


@pytest.fixture
def settings(tmp_path: Path) -> ReconstructionConfig:
    """A skin of two patches that lie beside one another in the picture."""
    skin = tmp_path / "two.yaml"
    skin.write_text(
        "matrix: [32, 32]\npitch_m: 0.004375\npatches:\n"
        "  left: {at: [0, 0], wires: {down: rows, across: cols 0 to 15}}\n"
        "  right: {at: [0, 16], wires: {down: rows, across: cols 16 to 31}}\n"
    )
    return ReconstructionSettings(layout=str(skin), touch_counts=25)


@pytest.mark.parametrize(("col", "width"), [(16.8, 1.8), (17.5, 2.5)])
def test_an_impact_is_told_on_the_patch_that_it_presses(
    col: float, width: float, settings: ReconstructionConfig
) -> None:
    """What lies beside it in the picture may be another finger."""

    def pressure(time_s: float) -> Array:
        share = (time_s - 0.2) / 0.008
        pressed = np.zeros((32, 32))
        if 0 < share < 1:
            counts = 2000 * math.sin(math.pi * share) * bump(32, 32, 10, col, width)
            pressed[:, :16] = np.minimum(counts, 1000)[:, :16]
        return pressed

    told = told_of(settings, SamplingConfig("tracking", 32, 32, 128, threshold_counts=25), pressure, 0.3)
    (impact,) = (one for one in told if one.kind is Kind.IMPACT)
    inner_m, border_m = ArrayGeometry(32, 32, 0.004375).x_m([13.0, 15.5])
    assert inner_m < impact.x_m <= border_m
    assert max(impact.path_x_m) <= border_m


@pytest.mark.parametrize("whole_n", [20.0, 150.0])
@pytest.mark.parametrize("col", [14.5, 15.5, 16.3])
def test_of_an_impact_across_a_border_only_what_presses_the_patch_is_told(
    col: float, whole_n: float, settings: ReconstructionConfig
) -> None:
    """It was told as if the skin went on there, of up to three times the force."""
    response, geometry = ForceResponse(), ArrayGeometry(32, 32, 0.004375)
    share_n = np.where(np.arange(32) < 16, bump(32, 32, 10, col, 1.2), 0.0) / (2 * math.pi * 1.2**2)

    def pressure(time_s: float) -> Array:
        share = (time_s - 0.2) / 0.008
        return response.counts(whole_n * math.sin(math.pi * min(max(share, 0.0), 1.0)) ** 1.5 * share_n)

    told = told_of(settings, SamplingConfig("tracking", 32, 32, 64, threshold_counts=25), pressure, 0.3)
    (impact,) = (one for one in told if one.kind is Kind.IMPACT)
    assert impact.peak_n == pytest.approx(whole_n * share_n.sum(), rel=0.2)
    assert impact.force_n.max() == impact.peak_n
    assert impact.x_m == pytest.approx(float((share_n @ geometry.x_m(np.arange(32))).sum() / share_n.sum()), abs=0.001)


@pytest.mark.parametrize("row", [5, 11, 17])
def test_frames_that_measured_nothing_near_do_not_say_when_an_impact_began(row: int) -> None:
    """So few taxels lie around an impact at the edge of the skin that some frames measure none of them."""
    response = ForceResponse()
    share_n = bump(32, 32, row, 31.9, 1.0) / (2 * math.pi)

    def pressure(time_s: float) -> Array:
        share = (time_s - 0.2) / 0.008
        return response.counts(20.0 * math.sin(math.pi * min(max(share, 0.0), 1.0)) ** 1.5 * share_n)

    sampling = SamplingConfig("tracking", 32, 32, 64, threshold_counts=25, seed=3)
    told = told_of(ReconstructionSettings(touch_counts=25), sampling, pressure, 0.25)
    (impact,) = (one for one in told if one.kind is Kind.IMPACT)
    assert abs(impact.onset_s - 100.2) < 3 * impact.onset_sd_s


@pytest.mark.parametrize("scheme", ["tracking", "adaptive", "random"])
def test_what_presses_the_patch_beside_has_no_part_in_an_impact(scheme: str, settings: ReconstructionConfig) -> None:
    def impact_beside(counts: float) -> Impact:
        def pressure(time_s: float) -> Array:
            share = (time_s - 0.2) / 0.008
            pressed = np.zeros((32, 32))
            if 0 < share < 1:
                pressed[:, :16] = 700 * math.sin(math.pi * share) * bump(32, 32, 10, 12 + 2 * share, 1.8)[:, :16]
            pressed[7:14, 16:19] = counts
            return pressed

        told = told_of(settings, SamplingConfig(scheme, 32, 32, 128, threshold_counts=25), pressure, 0.3)
        (impact,) = (one for one in told if one.kind is Kind.IMPACT)
        return impact

    alone, beside = impact_beside(0.0), impact_beside(500.0)
    assert beside.x_m == pytest.approx(alone.x_m, abs=0.003)
    assert beside.duration_s == pytest.approx(alone.duration_s, abs=0.002)
    assert beside.peak_n == pytest.approx(alone.peak_n, rel=0.5)
    assert beside.velocity_m_s[0] == pytest.approx(alone.velocity_m_s[0], abs=0.3)
