# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What runs a thousand times a second allocates no arrays in its kernels."""

from collections.abc import Callable, Iterator

import numba
import numpy as np
import pytest
from numba.core.runtime import _nrt_python, rtsys
from numpy.typing import NDArray
from recon_samples import bump, sample

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse
from acts_recon.contacts import BlobTracker, ContactFinder
from acts_recon.fusion import FusionEstimator
from acts_recon.fusion.fusion_state import Memory
from acts_recon.sparse import Dictionary, PatchModel, fastomp_kernels, patch_layout, workspace

GEOMETRY = ArrayGeometry()
FRAMES = 20

Count = Callable[[Callable[[int], object]], float]


@pytest.fixture
def allocations() -> Iterator[Count]:
    """How often a call has numba's memory manager allocate: once for an array given, once for an array made."""

    def count(call: Callable[[int], object]) -> float:
        call(0)
        before = rtsys.get_allocation_stats().mi_alloc
        for k in range(1, FRAMES + 1):
            call(k)
        return float(rtsys.get_allocation_stats().mi_alloc - before) / FRAMES

    _nrt_python.memsys_enable_stats()
    yield count
    _nrt_python.memsys_disable_stats()


def test_an_allocation_would_be_counted(allocations: Count) -> None:
    @numba.njit  # type: ignore[untyped-decorator]
    def none(values: NDArray[np.float64]) -> float:
        return float(values[0])

    @numba.njit  # type: ignore[untyped-decorator]
    def one(values: NDArray[np.float64]) -> float:
        return float((values + values[::-1])[0])

    values = np.ones(5)
    assert allocations(lambda k: none(values)) == 1
    assert allocations(lambda k: one(values)) == 2


def test_the_fusion_allocates_nothing(allocations: Count) -> None:
    estimator = FusionEstimator(GEOMETRY)
    indices, counts = sample(bump(GEOMETRY, 12, 14), 700)
    checked, fused = 3, len(Memory._fields) + 2
    assert allocations(lambda k: estimator.step(indices, counts, 1e-3 * k, 1e-3)) == checked + fused
    assert allocations(lambda k: estimator.confidence()) == 2


def test_finding_and_following_contacts_allocates_nothing(allocations: Count) -> None:
    finder, tracker = ContactFinder(GEOMETRY, ForceResponse(), 60.0), BlobTracker(GEOMETRY)
    image = (bump(GEOMETRY, 12, 14) + bump(GEOMETRY, 25, 5)).astype(np.float32)
    sigma = np.full(image.shape, 10, dtype=np.float32)
    assert allocations(lambda k: finder.find(image.ravel(), sigma.ravel())) == 6
    found, followed = 10, 9
    assert allocations(lambda k: tracker.step(image, 1e-3 * k, sigma)) == found + followed


@pytest.mark.parametrize("m", [55, 700])
def test_recovering_a_frame_alone_allocates_nothing(dictionary: Dictionary, allocations: Count, m: int) -> None:
    layout = patch_layout(GEOMETRY.rows, GEOMETRY.cols)
    image = np.zeros(GEOMETRY.size, dtype=np.float32)
    model, buffers = PatchModel.of(layout, dictionary.atoms), workspace(layout)
    frame = sample(bump(GEOMETRY, 12, 14), m)
    given = sum(isinstance(value, np.ndarray) for value in (*model, *frame, *buffers, image))
    recover = fastomp_kernels.recover_image
    assert allocations(lambda k: recover(model, *frame, 60, 1023, 0.25, True, buffers, image)) == given
    assert image.max() > 0
