# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is noise is learnt: light pressures on quiet mats are kept, untouched noisy skin is 0."""

from collections.abc import Callable

import numpy as np
import pytest
from fusion_reference import FusionReference
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_core.skin import layout
from acts_recon.fusion import FusionConfig, FusionEstimator
from acts_recon.images import NOISE_COUNTS

pytestmark = pytest.mark.slow

Field = Callable[[float], NDArray[np.integer]]


class Scores:
    """Mean errors of images, of the fusion and of last values, over frames after `settled_s`.

    The truth is `field`, whole counts; every sample has `noise_counts` of normal noise more. The fusion is told
    `told_counts`, 0: nothing.
    """

    def __init__(
        self,
        field: Field,
        *,
        frames: int,
        noise_counts: float = 0.0,
        told_counts: float = 0.0,
        settled_s: float = 0.3,
        m: int = 55,
    ) -> None:
        rows, cols = field(0.0).shape
        sampler = Sampler(SamplingConfig("tracking", rows, cols, m, threshold_counts=15))
        self.estimator = FusionEstimator(ArrayGeometry(rows, cols), FusionConfig(noise_counts=told_counts))
        rng = np.random.default_rng(7)
        last = np.zeros((rows, cols))
        errors, centres = [], []
        for k in range(1, frames):
            truth = field(0.001 * k)
            noisy = np.clip(np.rint(truth + noise_counts * rng.standard_normal(truth.shape)), 0, 1023).astype(np.uint16)
            indices, counts = sampler.frame(measure_in(noisy))
            image = self.estimator.step(indices, counts, 0.001 * k, m * 17.877e-6)
            last.ravel()[indices] = counts
            if k > 1000 * settled_s:
                norm = np.linalg.norm(truth)
                errors.append([np.linalg.norm(one - truth) / norm for one in (image, last)])
                centres.append([np.hypot(*(centre(one) - centre(truth))) for one in (image, last)])
        self.error, self.last_error = np.mean(errors, axis=0)
        self.centre, self.last_centre = np.mean(centres, axis=0)


def centre(image: NDArray[np.number]) -> NDArray[np.float64]:
    return np.array([(image * places).sum() for places in np.indices(image.shape)]) / image.sum()


def feet(shape: tuple[int, int], *, flicker: bool) -> Field:
    """A foot that rolls from heel to toe: wide light pressure of at most 9 counts, and small peaks."""
    rows, cols = np.indices(shape)
    r, c = rows / shape[0], cols / shape[1]
    wide = 9.5 * np.exp(-(((r - 0.5) / 0.25) ** 4) - ((c - 0.5) / 0.3) ** 4)
    heel, toe = (np.exp(-(((r - row) / 0.06) ** 2) - ((c - 0.5) / 0.12) ** 2) for row in (0.68, 0.32))
    rng = np.random.default_rng(5)
    grain = rng.random((8, *shape)) < 0.05

    def field(time_s: float) -> NDArray[np.integer]:
        roll = 0.5 - 0.5 * np.cos(2 * np.pi * time_s / 1.2)
        clean = wide + 90 * ((1 - roll) * heel + roll * toe)
        if flicker:
            clean = clean + grain[int(time_s / 0.03) % len(grain)]
        return np.floor(clean).astype(np.int64)

    return field


@pytest.mark.parametrize("shape", [(64, 32), (16, 16), (64, 64)])
@pytest.mark.parametrize("flicker", [False, True])
def test_light_pressures_on_a_quiet_mat_are_kept(shape: tuple[int, int], flicker: bool) -> None:
    scores = Scores(feet(shape, flicker=flicker), frames=700)
    assert scores.error < 1.05 * scores.last_error
    assert scores.centre < 1.05 * scores.last_centre


@pytest.mark.parametrize("noise_counts", [1.0, 3.0, 6.0])
def test_readings_of_untouched_noisy_skin_are_0_whatever_its_noise(noise_counts: float) -> None:
    """The setting says 2 counts: the rest is learnt."""
    r, c = np.indices((32, 32))
    bump = np.rint(400 * np.exp(-((r - 9) ** 2 + (c - 20) ** 2) / 8)).astype(np.int64)
    scores = Scores(lambda _: bump, frames=900, noise_counts=noise_counts, told_counts=2.0)
    untouched = scores.estimator.image[bump == 0]
    assert np.mean(untouched > 0) < 0.15  # of the measured values nearly a half
    assert scores.centre < 0.3 * scores.last_centre
    assert scores.error < 0.8 * scores.last_error


@pytest.mark.parametrize("shape", [(16, 16), (32, 32), (64, 64)])
@pytest.mark.parametrize("noise_counts", [1.0, 4.0])
def test_what_skin_of_unknown_noise_reads_untouched_is_kept(shape: tuple[int, int], noise_counts: float) -> None:
    """No reading is below 0, so noise adds to each in the mean, and draws a recording's own centre to the middle."""
    r, c = np.indices(shape)
    bump = 400 * np.exp(-((r - 0.3 * shape[0]) ** 2 + (c - 0.6 * shape[1]) ** 2) / 8)
    rng = np.random.default_rng(3)
    recording = np.rint(bump + np.abs(noise_counts * rng.standard_normal((1000, *shape)))).astype(np.int64)
    scores = Scores(lambda time_s: recording[round(1000 * time_s)], frames=1000)
    assert scores.centre < 1.05 * scores.last_centre
    assert scores.error < 1.05 * scores.last_error


def test_noise_is_calibrated_taxel_by_taxel() -> None:
    """Before anything can be learnt: what is far beyond the noise of one taxel is within that of another."""
    geometry = ArrayGeometry(8, 16)
    estimator = FusionEstimator(geometry)
    noise = np.full((8, 16), 0.5, dtype=np.float32)
    noise[:, 8:] = 10.0
    estimator.set_noise(noise.ravel(), np.ones(128, dtype=np.bool_))
    everything = np.arange(128, dtype=np.uint16)
    estimator.step(everything, np.full(128, 6, dtype=np.uint16), 0.0, 0.0)
    image = estimator.step(everything[:1], np.full(1, 6, dtype=np.uint16), 0.001, 0.0)
    assert (image[:, :7] == 6).all()
    assert (image[:, 9:] == 0).all()
    assert (estimator.sigma[:, 9:] >= 10.0).all()
    assert (estimator.sigma[:, :7] < 5.0).all()


def test_noise_is_given_by_matrix_index_and_elsewhere_the_setting_holds() -> None:
    glove = layout("glove")
    estimator = FusionEstimator(glove.geometry(), FusionConfig(noise_counts=3.0), glove)
    valid = np.zeros(glove.places.size, dtype=np.bool_)
    valid[5] = True
    estimator.set_noise(np.full(valid.size, 20.0, dtype=np.float32), valid)
    everything = np.arange(valid.size, dtype=np.uint16)
    estimator.step(everything, np.zeros(valid.size, dtype=np.uint16), 0.0, 0.0)
    sigma = estimator.sigma.ravel()
    assert sigma[glove.places[5]] == pytest.approx(20.0, rel=0.01)
    assert np.delete(sigma, glove.places[5]) == pytest.approx(3.0, rel=0.01)


def test_the_same_noise_again_forgets_nothing_and_wrong_ones_are_refused() -> None:
    skin = Scores(feet((16, 16), flicker=False), frames=60, settled_s=0.0)
    estimator, valid = skin.estimator, np.ones(256, dtype=np.bool_)
    estimator.set_noise(np.full(256, 2.0, dtype=np.float32), valid)
    learnt = estimator._state.learnt.copy()
    estimator.set_noise(np.full(256, 2.0, dtype=np.float32), valid)
    assert np.array_equal(estimator._state.learnt, learnt)
    for wrong in (np.full(256, np.nan), np.full(256, -1.0), np.full(256, 1e30), np.zeros(255)):
        with pytest.raises(ArrayError, match="noise"):
            estimator.set_noise(wrong.astype(np.float32), valid)
    assert np.array_equal(estimator._state.learnt, learnt)


def test_what_was_learnt_of_the_noise_outlasts_a_reset() -> None:
    estimator = Scores(feet((16, 16), flicker=False), frames=400).estimator
    learnt = estimator._state.log_noise.copy()
    estimator.reset()
    assert learnt[0] < -1.0  # the setting says 2 counts, the mat has none
    assert np.array_equal(estimator._state.log_noise, learnt)


@pytest.mark.parametrize("is_known", [True, False])
def test_kernels_equal_the_reference_while_noise_is_learnt(is_known: bool) -> None:
    geometry = ArrayGeometry(12, 20)
    rng = np.random.default_rng(2)
    noise = rng.uniform(0.5, 6.0, geometry.size).astype(np.float32)
    estimator = FusionEstimator(geometry)
    if is_known:
        estimator.set_noise(noise, np.ones(geometry.size, dtype=np.bool_))
    told = noise.reshape(12, 20).astype(np.float64) if is_known else NOISE_COUNTS
    reference = FusionReference(12, 20, estimator.config.tuning, told, is_known=is_known)
    r, c = np.indices((12, 20))
    differing = 0
    for k in range(1, 300):
        clean = 300 * np.exp(-((r - 5) ** 2 + (c - 4 - 0.02 * k) ** 2) / 6) + noise.reshape(12, 20) * rng.normal(
            size=(12, 20)
        )
        indices = rng.permutation(geometry.size)[:50].astype(np.uint16)
        counts = np.clip(clean, 0, 1023).astype(np.uint16).ravel()[indices]
        image = estimator.step(indices, counts, 0.001 * k, 0.001)
        reference.step(indices, counts, 0.001, 0.001)
        differing += int(np.count_nonzero(np.abs(image - reference.image) > 0.5))
    # Rounding, and thresholds that single and double precision meet on different sides.
    assert differing < 300 * geometry.size / 1000
    assert estimator._state.log_noise[0] == pytest.approx(reference.log_noise, abs=0.02)
    learnt = (reference.readings, reference.changes, reference.expected, reference.low_total, reference.low_number)
    assert estimator._state.learnt[:, 2:7].reshape(3, 5, 5) == pytest.approx(np.dstack(learnt), rel=0.02, abs=1.0)


def test_a_reading_that_can_be_noise_is_not_carried_on() -> None:
    estimator = FusionEstimator(ArrayGeometry(), FusionConfig(noise_counts=1.5))
    rng = np.random.default_rng(11)
    every = np.arange(1024, dtype=np.uint16)
    for k in range(1, 41):
        counts = np.clip(np.rint(1.5 * rng.standard_normal(1024)), 0, 1023).astype(np.uint16)
        # The noise of this taxel: nothing, then 3.3 standard deviations.
        counts[500] = 5 if k == 40 else 0
        estimator.step(every, counts, 0.001 * k, 0.001)
    for k in range(41, 65):
        image = estimator.step(every[:1], counts[:1], 0.001 * k, 0.001)
        assert image.flat[500] <= 5, f"{k - 40} ms after the reading"
