# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""FastOMP: the reference implementation against linear algebra, the kernel against the reference implementation."""

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_samples import bump, sample

from acts_core.array import ArrayGeometry
from acts_recon.sparse import (
    SPARSITY_RATIO,
    Dictionary,
    PatchLayout,
    PatchModel,
    fast_omp,
    patch_layout,
    sparsity,
    workspace,
)
from acts_recon.sparse import fastomp_kernels as kernels

pytestmark = pytest.mark.slow

Frame = NDArray[np.uint16]


def recover_image(
    layout: PatchLayout,
    atoms: NDArray[np.floating],
    indices: NDArray[np.integer],
    values: NDArray[np.floating],
    *,
    ratio: float = SPARSITY_RATIO,
) -> NDArray[np.float64]:
    """Reference implementation of the kernel, without clipping and without putting the samples back in.

    Parameters
    ----------
    layout : PatchLayout
    atoms : np.ndarray [shape=(size * size, n_atoms), dtype=float]
        Dictionary.
    indices : np.ndarray [shape=(m,), dtype=int]
        Row-major taxel indices, none twice.
    values : np.ndarray [shape=(m,), dtype=float]
        What was measured there; 0 where not pressed.
    ratio : float
        See `sparsity`.

    Returns
    -------
    np.ndarray [shape=(rows, cols), dtype=float64]
    """
    value = np.zeros(layout.rows * layout.cols)
    measured = np.zeros(value.size, dtype=bool)
    value[indices] = values
    measured[indices] = True
    total = np.zeros(value.size)
    for taxels in layout.taxels:
        rows = np.flatnonzero(measured[taxels])
        y = value[taxels[rows]]
        if not y.any():
            continue
        chosen, coefficients = fast_omp(atoms[rows], y, sparsity(rows.size, ratio))
        total[taxels] += np.asarray(atoms[:, chosen], dtype=np.float64) @ coefficients
    return (total / layout.overlap).reshape(layout.rows, layout.cols)


@pytest.mark.parametrize(("measured", "atoms"), [(1, 1), (2, 1), (5, 1), (6, 2), (10, 3), (14, 4), (64, 16)])
def test_a_quarter_of_the_measured_pixels_halves_rounded_up(measured: int, atoms: int) -> None:
    assert sparsity(measured) == atoms


def test_coefficients_are_those_of_least_squares_on_the_chosen_atoms() -> None:
    rng = np.random.default_rng(0)
    A = rng.standard_normal((20, 60))
    y = rng.standard_normal(20)
    chosen, coefficients = fast_omp(A, y, 5)
    assert len(set(chosen.tolist())) == 5
    expected = np.linalg.lstsq(A[:, chosen], y, rcond=None)[0]
    # Not exactly: the regularisation of 1e-4 is part of the method.
    np.testing.assert_allclose(coefficients, expected, rtol=1e-4)


def test_each_atom_is_the_one_most_correlated_with_what_is_left() -> None:
    rng = np.random.default_rng(1)
    A = rng.standard_normal((12, 40))
    y = rng.standard_normal(12)
    chosen, _ = fast_omp(A, y, 4)
    for i, atom in enumerate(chosen):
        left = y - A[:, chosen[:i]] @ np.linalg.lstsq(A[:, chosen[:i]], y, rcond=None)[0]
        assert atom == np.argmax(np.abs(left @ A))


def test_columns_are_not_normalised_again() -> None:
    # The second column points exactly along y but is short; the published method prefers the long one.
    A = np.array([[1.0, 0.1], [1.0, 0.0]])
    assert fast_omp(A, np.array([1.0, 0.0]), 1)[0].tolist() == [0]


def test_nothing_to_explain_needs_no_atoms() -> None:
    chosen, coefficients = fast_omp(np.eye(3), np.zeros(3), 2)
    assert chosen.size == coefficients.size == 0


def recover_by_kernel(
    layout: PatchLayout,
    atoms: NDArray[np.float32],
    indices: Frame,
    counts: Frame,
    *,
    keep: bool = False,
    ratio: float = 0.25,
) -> NDArray[np.float32]:
    image = np.zeros(layout.rows * layout.cols, dtype=np.float32)
    kernels.recover_image(
        PatchModel.of(layout, atoms),
        indices,
        counts,
        60,
        1023,
        ratio,
        keep,
        workspace(layout, ratio),
        image,
    )
    return image.reshape(layout.rows, layout.cols)


def assert_kernel_equals_twin(layout: PatchLayout, atoms: NDArray[np.float32], indices: Frame, counts: Frame) -> None:
    values = np.where(counts > 60, counts, 0).astype(np.float64)
    expected = np.clip(recover_image(layout, atoms, indices, values), 0, 1023)
    np.testing.assert_allclose(recover_by_kernel(layout, atoms, indices, counts), expected, rtol=2e-3, atol=0.5)


@pytest.mark.parametrize(("rows", "cols", "step"), [(32, 32, 4), (32, 32, 1), (33, 15, 4), (8, 8, 4)])
def test_kernel_equals_reference_on_random_data(rows: int, cols: int, step: int) -> None:
    rng = np.random.default_rng(rows + step)
    # Atoms in general position: no two are nearly as good a choice, where rounding would decide.
    atoms = rng.standard_normal((64, 130)).astype(np.float32)
    layout = patch_layout(rows, cols, step=step)
    for _ in range(5):
        m = int(rng.integers(1, rows * cols // 2))
        indices = rng.permutation(rows * cols)[:m].astype(np.uint16)
        assert_kernel_equals_twin(layout, atoms, indices, rng.integers(0, 1024, m).astype(np.uint16))


@pytest.mark.parametrize("ratio", [0.05, 1.0])
def test_as_many_atoms_as_are_asked_for(ratio: float) -> None:
    rng = np.random.default_rng(5)
    atoms = rng.standard_normal((16, 40)).astype(np.float32)
    layout = patch_layout(12, 12, size=4, step=2)
    indices = rng.permutation(144)[:50].astype(np.uint16)
    counts = rng.integers(0, 1024, 50).astype(np.uint16)
    values = np.where(counts > 60, counts, 0).astype(np.float64)
    expected = np.clip(recover_image(layout, atoms, indices, values, ratio=ratio), 0, 1023)
    image = recover_by_kernel(layout, atoms, indices, counts, ratio=ratio)
    np.testing.assert_allclose(image, expected, rtol=2e-3, atol=0.5)


@pytest.mark.parametrize("m", [55, 256])
def test_kernel_equals_reference_on_real_grasps(dictionary: Dictionary, grasp_frames: Frame, m: int) -> None:
    layout = patch_layout(32, 32)
    for frame in grasp_frames:
        assert_kernel_equals_twin(layout, dictionary.atoms, *sample(frame, m))


def test_the_image_is_in_range_and_keeps_what_was_measured(dictionary: Dictionary) -> None:
    frame = bump(ArrayGeometry(), 12, 9, peak=1023, width=3)
    indices, counts = sample(frame, 90)
    image = recover_by_kernel(patch_layout(32, 32), dictionary.atoms, indices, counts, keep=True)
    assert image.min() >= 0
    assert image.max() <= 1023
    assert np.array_equal(image.ravel()[indices], np.where(counts > 60, counts, 0))


def test_values_at_the_touch_threshold_are_not_pressed(dictionary: Dictionary) -> None:
    indices = np.arange(0, 1024, 7, dtype=np.uint16)
    layout = patch_layout(32, 32)
    assert not recover_by_kernel(layout, dictionary.atoms, indices, np.full_like(indices, 60)).any()
    assert recover_by_kernel(layout, dictionary.atoms, indices, np.full_like(indices, 61)).any()
