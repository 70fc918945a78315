# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recovery where the same few taxels are measured in every frame, and most of them never."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_core.skin import ForceResponse
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.fusion import FusionEstimator
from acts_recon.methods import METHODS
from acts_recon.settings import ReconstructionSettings

GEOMETRY = ArrayGeometry()
ROW, COL = 10, 20
FRAMES = 300


def shown(method: str, field: NDArray[np.int64], *, m: int, taxels: int) -> FrameRecovery:
    """What is recovered of frames of a field that does not change."""
    sampler = Sampler(SamplingConfig("fixed", m=m, fixed_row=ROW, fixed_col=COL, fixed_taxels=taxels))
    recovery = FrameRecovery(ReconstructionSettings(method=method))
    rng = np.random.default_rng(1)
    for number in range(FRAMES):
        noisy = np.clip(field + np.rint(2 * rng.standard_normal(field.shape)).astype(np.int64), 0, 1023)
        indices, counts = sampler.frame(measure_in(noisy))
        frame = SampleFrame(number, 1000 * number, 18 * m, Scheme.FIXED, 32, 32, 0, indices, counts)
        recovery.step(frame, 1_000_000 * number)
    return recovery


def press(row: float, col: float) -> NDArray[np.int64]:
    rows, cols = np.mgrid[:32, :32]
    force_n = 0.5 * np.exp(-((rows - row) ** 2 + (cols - col) ** 2) / 8)
    return np.rint(ForceResponse().counts(force_n)).astype(np.int64)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("m", "taxels"), [(1, 0), (50, 1), (50, 9), (25, 0)])
def test_what_is_not_measured_is_no_contact_and_what_is_pressed_is_one_there(method: str, m: int, taxels: int) -> None:
    elsewhere = shown(method, press(26, 4), m=m, taxels=taxels)
    assert not elsewhere.contact.in_contact
    assert not elsewhere.blobs
    here = shown(method, press(ROW, COL), m=m, taxels=taxels)
    assert here.contact.in_contact
    assert len(here.blobs) == 1
    reach_m = 4 * GEOMETRY.pitch_m
    assert here.contact.x_m == pytest.approx(float(GEOMETRY.x_m(COL)), abs=reach_m)
    assert here.contact.y_m == pytest.approx(float(GEOMETRY.y_m(ROW)), abs=reach_m)
    # No more than what presses.
    assert here.contact.force_n < 1.2 * float(ForceResponse().force_n(press(ROW, COL)).sum())


def test_the_uncertainty_says_what_was_never_measured() -> None:
    recovery = shown("fusion", press(ROW, COL), m=50, taxels=1).recovery
    assert recovery.sigma is not None
    assert recovery.age_s is not None
    far = np.hypot(*(np.mgrid[:32, :32] - np.array([ROW, COL])[:, None, None])) > 6
    assert recovery.sigma[ROW, COL] < 5
    assert recovery.sigma[far].min() > 10 * recovery.sigma[ROW, COL]
    assert np.isfinite(recovery.image).all()
    assert recovery.age_s[ROW, COL] < 1e-3
    assert recovery.age_s[far].min() > 0.9 * FRAMES * 1e-3


@pytest.mark.parametrize("m", [128, 256])
def test_a_press_from_the_first_frame_on_has_no_rim_of_taxels_that_were_never_measured(m: int) -> None:
    """`adaptive` never measures beyond an edge that reads little."""
    truth = np.zeros((32, 32), dtype=np.uint16)
    truth[8:12, 14:20] = [
        [0, 0, 0, 1, 39, 16],
        [0, 17, 65, 92, 90, 38],
        [0, 63, 56, 103, 109, 35],
        [0, 0, 0, 17, 0, 0],
    ]
    sampler = Sampler(SamplingConfig("adaptive", m=m, threshold_counts=50))
    estimator = FusionEstimator(GEOMETRY)
    period_s = m * 17.877e-6
    for number in range(round(0.06 / period_s)):
        indices, counts = sampler.frame(measure_in(truth))
        image = estimator.step(indices, counts, number * period_s, period_s)
    never = np.isinf(estimator.age_s)
    assert never.sum() > 100
    assert image[never].max() <= 2
