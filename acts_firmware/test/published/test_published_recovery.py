# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recovery and classification on the virtual board take the time of the paper's Fig. 9."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from core_library import published_sample_us
from recovery_library import published_recovery_us

from acts_core.sampling import SamplingConfig

# The files were numbered before the figures: figure 8 there is Fig. 9 of the paper. Curves of frames a second over M.
CURVES = {("image", 50): 56, ("image", 100): 55, ("object", 60): 52, ("object", 90): 51}


def test_the_heat_map_of_recovery(recording_path: Callable[[str], Path]) -> None:
    with np.load(recording_path("paper/fig8_heatmap.npz")) as archive:
        rates, axis = archive["fps"], archive["x"].astype(int)
    # The published map holds measured values on these rows and columns and interpolates rates between them.
    measured = [0, 1, 3, 5, 7, 9]
    for i in measured:
        for j in measured:
            rate = 1e6 / published_recovery_us("image", int(axis[i]), int(axis[j]))
            assert rate == pytest.approx(rates[i, j], rel=0.002), (axis[i], axis[j])


@pytest.mark.parametrize(("output", "columns"), CURVES)
def test_the_frame_rates_with_sampling(output: str, columns: int, recording_path: Callable[[str], Path]) -> None:
    table = np.loadtxt(recording_path("paper/curves.csv"), delimiter=",", skiprows=1)
    curve = table[table[:, 0] == CURVES[output, columns]]
    assert len(curve) == 6
    for _, m, rate in curve:
        sampling_us = m * published_sample_us(SamplingConfig("adaptive", m=int(m)))
        frame_us = sampling_us + published_recovery_us(output, columns, int(m))
        # What is off is sampling, whose times were published twice.
        assert 1e6 / frame_us == pytest.approx(rate, rel=0.045)


def test_the_papers_words() -> None:
    sampling_us = 50 * published_sample_us(SamplingConfig("adaptive", m=50))
    assert 1e6 / (sampling_us + published_recovery_us("image", 50, 50)) == pytest.approx(720, rel=0.02)
    assert 1e6 / (sampling_us + published_recovery_us("object", 60, 50)) == pytest.approx(806, rel=0.02)
    assert published_recovery_us("image", 50, 50) < 500


@pytest.mark.parametrize("output", ["image", "object"])
def test_more_measurements_and_columns_take_longer_everywhere(output: str) -> None:
    sizes = [1, 20, 49, 50, 51, 99, 100, 300, 500, 501, 900, 1024]
    times = np.array(
        [[published_recovery_us(output, columns, m) for m in sizes] for columns in [1, 30, 60, 75, 90, 600]]
    )
    assert times.min() > 0
    assert np.diff(times, axis=0).min() > 0
    assert np.diff(times, axis=1).min() > 0


def test_a_larger_array_takes_the_time_of_its_patches() -> None:
    assert published_recovery_us("image", 50, 220, shape=(64, 64)) == pytest.approx(
        4 * published_recovery_us("image", 50, 55)
    )
    assert published_recovery_us("samples", 50, 50) == 0
