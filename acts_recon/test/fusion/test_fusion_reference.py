# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The kernels of fusion do what the reference implementation says."""

from collections.abc import Callable

import numpy as np
import pytest
from fusion_patches_reference import PatchesReference
from fusion_reference import FusionReference
from fusion_streams import DURATION_S, SMALL, Frame, Skin, sliding, streams
from hypothesis import given, settings
from recon_samples import layouts

from acts_core.array import ArrayGeometry
from acts_core.skin import NO_PATCH, Layout
from acts_recon.fusion import FusionConfig, FusionEstimator
from acts_recon.images import NOISE_COUNTS, borders_of

pytestmark = pytest.mark.slow


def compare(estimator: FusionEstimator, frames: list[tuple[Frame, float, float]]) -> None:
    geometry, config = estimator.geometry, estimator.config
    reference = FusionReference(geometry.rows, geometry.cols, config.tuning, 2.0)
    last_s = None
    for (indices, counts), end_s, duration_s in frames:
        image = estimator.step(indices, counts, end_s, duration_s)
        period_s = duration_s if last_s is None else end_s - last_s
        if not 0 <= period_s <= config.reset_after_s:
            reference.forget()
            period_s = duration_s
        last_s = end_s
        reference.step(indices, counts, period_s, duration_s)
        assert image == pytest.approx(reference.image, abs=1.01)  # rounded either way
        assert estimator.sigma == pytest.approx(reference.sigma, rel=0.02, abs=0.05)
        assert estimator.age_s == pytest.approx(reference.age, rel=1e-4, abs=1e-6)


@given(streams())
# The same examples every time: where a motion is just used or just not, single and double precision may differ.
@settings(max_examples=40, deadline=None, derandomize=True)
def test_kernels_equal_the_reference(frames: list[tuple[Frame, float, float]]) -> None:
    compare(FusionEstimator(SMALL), frames)


def test_kernels_equal_the_reference_on_a_sliding_contact() -> None:
    skin = Skin(sliding(200.0), noise=2.0)
    compare(
        FusionEstimator(ArrayGeometry()),
        [(skin.frame(0.001 * k), 0.001 * k, DURATION_S) for k in range(1, 90)],
    )


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (40, 1), (5, 64), (64, 64)])
def test_kernels_equal_the_reference_on_arrays_of_any_shape(shape: tuple[int, int]) -> None:
    """A bump that slides over a corner and saturates, in frames of one taxel, of some and of all."""
    geometry = ArrayGeometry(*shape)
    rng = np.random.default_rng(5)
    r, c = np.indices(shape)
    frames = []
    for k in range(30):
        field = 2000 * np.exp(-((r - 0.3 * k) ** 2 + (c - 0.2 * k) ** 2) / 18) + rng.normal(0, 2, shape)
        m = (1, geometry.size, 1 + geometry.size // 3)[k % 3]
        indices = rng.permutation(geometry.size)[:m].astype(np.uint16)
        counts = np.clip(field, 0, 1023).astype(np.uint16).ravel()[indices]
        frames.append(((indices, counts), 0.002 * k, 0.001))
    compare(FusionEstimator(geometry), frames)


def test_kernels_equal_the_reference_where_an_array_of_one_column_is_measured_in_part() -> None:
    first = np.arange(3, dtype=np.uint16)
    frames = [((first[: 1 + k % 3], np.full(1 + k % 3, 500 + k, np.uint16)), 0.001 * k, 0.0009) for k in range(9)]
    compare(FusionEstimator(ArrayGeometry(8, 1)), frames)


# The same frames every time: where a decision hangs by the last bit of a float32, kernel and reference part.
@pytest.mark.parametrize("noise_counts", [0.0, 1.5])
@given(layouts(9, 13), streams())
@settings(max_examples=15, deadline=None, derandomize=True)
def test_patches_are_skins_of_their_own(
    estimator_of: Callable[[float, Layout | None], FusionEstimator],
    noise_counts: float,
    arranged: Layout | None,
    frames: list[tuple[Frame, float, float]],
) -> None:
    estimator = estimator_of(noise_counts, arranged)
    borders, tuning, is_known = borders_of(9, 13, arranged), estimator.config.tuning, noise_counts > 0
    assumed = noise_counts or NOISE_COUNTS
    reference, last_s = PatchesReference(9, 13, borders, tuning, assumed, is_known=is_known), None
    for (indices, counts), end_s, duration_s in frames:
        image = estimator.step(indices, counts, end_s, duration_s)
        period_s = duration_s if last_s is None else end_s - last_s
        if not 0 <= period_s <= estimator.config.reset_after_s:
            reference.forget()
            period_s = duration_s
        last_s = end_s
        if arranged is not None:
            counts = counts * (arranged.patch_of_taxel.ravel()[indices] != NO_PATCH)
            indices = arranged.places[indices]
        reference.step(indices, counts, period_s, duration_s)
        assert image == pytest.approx(reference.field("image"), abs=1.01)
        assert estimator.sigma == pytest.approx(reference.field("sigma"), rel=0.02, abs=0.05)
        assert estimator.age_s == pytest.approx(reference.field("age"), rel=1e-4, abs=1e-6)


@pytest.fixture(scope="module")
def estimator_of() -> Callable[[float, Layout | None], FusionEstimator]:
    return lambda noise_counts, arranged: FusionEstimator(SMALL, FusionConfig(noise_counts=noise_counts), arranged)
