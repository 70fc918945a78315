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
from numpy.typing import NDArray
from recon_samples import layouts

from acts_core.array import ArrayGeometry
from acts_core.skin import NO_PATCH, Layout
from acts_recon.fusion import FusionConfig, FusionEstimator
from acts_recon.images import NOISE_COUNTS, borders_of

pytestmark = pytest.mark.slow


class References:
    """The reference implementation, and two more that tell how far single precision can be from it.

    Times of these two are a millionth longer and shorter, and their state is rounded as that of the kernels is. Where
    they differ from the first, a decision hangs by the last bits of a float32, and the kernels may part from it, too.
    """

    def __init__(self, reference_of: Callable[[], FusionReference | PatchesReference]) -> None:
        self.exact = reference_of()
        self._rounded = {1 + 1e-6: reference_of(), 1 - 1e-6: reference_of()}

    def step(
        self, indices: NDArray[np.integer], counts: NDArray[np.integer], period_s: float, duration_s: float
    ) -> None:
        self.exact.step(indices, counts, period_s, duration_s)
        for share, reference in self._rounded.items():
            reference.step(indices, counts, share * period_s, duration_s / share)
            reference.round_to_single()

    def forget(self) -> None:
        for reference in (self.exact, *self._rounded.values()):
            reference.forget()

    def is_decided(self) -> bool:
        """Whether they agree."""
        image, sigma = self.exact.field("image"), self.exact.field("sigma")
        return all(
            reference.field("image") == pytest.approx(image, abs=0.5)
            and reference.field("sigma") == pytest.approx(sigma, rel=0.01, abs=0.02)
            for reference in self._rounded.values()
        )


def compare(
    estimator: FusionEstimator,
    frames: list[tuple[Frame, float, float]],
    reference_of: Callable[[], FusionReference | PatchesReference] | None = None,
    arranged: Layout | None = None,
) -> int:
    """Compare frame by frame; the number of frames before the two part by a last bit."""
    geometry, config = estimator.geometry, estimator.config
    references = References(
        reference_of or (lambda: FusionReference(geometry.rows, geometry.cols, config.tuning, NOISE_COUNTS))
    )
    last_s = None
    for number, ((indices, counts), end_s, duration_s) in enumerate(frames):
        image = estimator.step(indices, counts, end_s, duration_s)
        period_s = duration_s if last_s is None else end_s - last_s
        if not 0 <= period_s <= config.reset_after_s:
            references.forget()
            period_s = duration_s
        last_s = end_s
        if arranged is not None:
            counts = counts * (arranged.patch_of_taxel.ravel()[indices] != NO_PATCH)
            indices = arranged.places[indices]
        references.step(indices, counts, period_s, duration_s)
        shown = pytest.approx(references.exact.field("image"), abs=1.01)  # rounded either way
        sure = pytest.approx(references.exact.field("sigma"), rel=0.02, abs=0.05)
        if not (image == shown and estimator.sigma == sure) and not references.is_decided():
            return number
        assert image == shown
        assert estimator.sigma == sure
        assert estimator.age_s == pytest.approx(references.exact.field("age"), rel=1e-4, abs=1e-6)
    return len(frames)


@given(streams())
# The same examples every time: one stream in some thousands parts by a last bit that `References` does not show.
@settings(max_examples=40, deadline=None, derandomize=True)
def test_kernels_equal_the_reference(frames: list[tuple[Frame, float, float]]) -> None:
    compare(FusionEstimator(SMALL), frames)


def test_kernels_equal_the_reference_on_a_sliding_contact() -> None:
    skin = Skin(sliding(200.0), noise=2.0)
    frames = [(skin.frame(0.001 * k), 0.001 * k, DURATION_S) for k in range(1, 90)]
    assert compare(FusionEstimator(ArrayGeometry()), frames) == len(frames)


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
    assert compare(FusionEstimator(geometry), frames) == len(frames)


def test_kernels_equal_the_reference_where_an_array_of_one_column_is_measured_in_part() -> None:
    first = np.arange(3, dtype=np.uint16)
    frames = [((first[: 1 + k % 3], np.full(1 + k % 3, 500 + k, np.uint16)), 0.001 * k, 0.0009) for k in range(9)]
    assert compare(FusionEstimator(ArrayGeometry(8, 1)), frames) == len(frames)


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
    compare(estimator, frames, lambda: PatchesReference(9, 13, borders, tuning, assumed, is_known=is_known), arranged)


@pytest.fixture(scope="module")
def estimator_of() -> Callable[[float, Layout | None], FusionEstimator]:
    return lambda noise_counts, arranged: FusionEstimator(SMALL, FusionConfig(noise_counts=noise_counts), arranged)
