# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loops of K-SVD in numba; see `acts_recon.learning.ksvd`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel

_TINY = np.float32(1e-7)
_FASTMATH = {"nnan", "ninf", "nsz", "contract", "reassoc"}


@kernel(fastmath=_FASTMATH)
def code_patches(
    projections: NDArray[np.float32],
    gram: NDArray[np.float32],
    chosen: NDArray[np.int32],
    coefficients: NDArray[np.float32],
) -> None:
    """Batch OMP with a growing Cholesky factor.

    Parameters
    ----------
    projections : np.ndarray [shape=(n, n_atoms), dtype=float32]
        Inner products of patches and unit-norm atoms.
    gram : np.ndarray [shape=(n_atoms, n_atoms), dtype=float32]
        Inner products of atoms.
    chosen : np.ndarray [shape=(n, sparsity), dtype=int32]
        Written: the atoms of each patch. Places that are not used repeat the first atom with coefficient 0.
    coefficients : np.ndarray [shape=(n, sparsity), dtype=float32]
        Written.
    """
    n, n_atoms = projections.shape
    sparsity = chosen.shape[1]
    L = np.zeros((sparsity, sparsity), np.float32)
    rest = np.zeros(n_atoms, np.float32)
    x = np.zeros(sparsity, np.float32)
    for p in range(n):
        row, atoms = projections[p], chosen[p]
        rest[:] = row
        count = 0
        while count < sparsity:
            atom = _largest(rest)
            if abs(rest[atom]) < _TINY or not _add_row(L, gram, atoms, count, atom):
                break
            atoms[count] = atom
            count += 1
            _solve(L, row, atoms, count, x)
            _subtract(row, gram, atoms, count, x, rest)
        for i in range(count):
            coefficients[p, i] = x[i]
        for i in range(count, sparsity):
            chosen[p, i] = chosen[p, 0] if count > 0 else 0
            coefficients[p, i] = np.float32(0.0)


@kernel(fastmath=_FASTMATH, inline="always")
def _largest(values: NDArray[np.float32]) -> int:
    """Place of the largest magnitude, the first of equals."""
    # Two loops, because the first has no branch, and so is vectorised.
    top = np.float32(0.0)
    for k in range(len(values)):
        top = max(top, abs(values[k]))
    for k in range(len(values)):
        if abs(values[k]) == top:
            return k
    return 0


@kernel(fastmath=_FASTMATH, inline="always")
def _add_row(
    L: NDArray[np.float32], gram: NDArray[np.float32], chosen: NDArray[np.int32], count: int, atom: int
) -> bool:
    """Add the row of an atom to the Cholesky factor of ``gram[chosen, chosen]``; False: it is a sum of those chosen."""
    square = gram[atom, atom]
    for i in range(count):
        value = gram[chosen[i], atom]
        for j in range(i):
            value -= L[i, j] * L[count, j]
        L[count, i] = value / L[i, i]
        square -= L[count, i] * L[count, i]
    if square <= np.float32(1e-5):
        return False
    L[count, count] = np.sqrt(square)
    return True


@kernel(fastmath=_FASTMATH, inline="always")
def _solve(
    L: NDArray[np.float32],
    projections: NDArray[np.float32],
    chosen: NDArray[np.int32],
    count: int,
    x: NDArray[np.float32],
) -> None:
    """Write the coefficients of the atoms chosen: solve ``L @ L.T @ x = projections[chosen]``."""
    for i in range(count):
        value = projections[chosen[i]]
        for j in range(i):
            value -= L[i, j] * x[j]
        x[i] = value / L[i, i]
    for i in range(count - 1, -1, -1):
        value = x[i]
        for j in range(i + 1, count):
            value -= L[j, i] * x[j]
        x[i] = value / L[i, i]


@kernel(fastmath=_FASTMATH, inline="always")
def _subtract(
    projections: NDArray[np.float32],
    gram: NDArray[np.float32],
    chosen: NDArray[np.int32],
    count: int,
    x: NDArray[np.float32],
    rest: NDArray[np.float32],
) -> None:
    """Write the projections of what the chosen atoms leave of a patch."""
    for k in range(len(rest)):
        rest[k] = projections[k]
    for i in range(count):
        atom, share = chosen[i], x[i]
        for k in range(len(rest)):
            rest[k] -= share * gram[atom, k]


@kernel(fastmath=_FASTMATH)
def update_atoms(
    D: NDArray[np.float32],
    residual: NDArray[np.float32],
    order: NDArray[np.int64],
    start: NDArray[np.int64],
    coefficients: NDArray[np.float32],
) -> None:
    """Update every atom, one after the other: fit it to the residual of the patches that use it, without its own part.

    Parameters
    ----------
    D : np.ndarray [shape=(n_atoms, n_pixels), dtype=float32]
        Changed in place; a row an atom, unit norm.
    residual : np.ndarray [shape=(n, n_pixels), dtype=float32]
        Patches minus their approximation; kept up to date.
    order : np.ndarray [shape=(n * sparsity,), dtype=int64]
        Places in the flat `coefficients`, grouped by atom.
    start : np.ndarray [shape=(n_atoms + 1,), dtype=int64]
        The places of atom k are ``order[start[k]:start[k + 1]]``.
    coefficients : np.ndarray [shape=(n, sparsity), dtype=float32]
        Changed in place.
    """
    fresh = np.zeros(D.shape[1], np.float32)
    for k in range(len(D)):
        uses = order[start[k] : start[k + 1]]
        if _fit(D[k], residual, uses, coefficients, fresh):
            _replace(D[k], residual, uses, coefficients, fresh)


@kernel(fastmath=_FASTMATH, inline="always")
def _fit(
    atom: NDArray[np.float32],
    residual: NDArray[np.float32],
    uses: NDArray[np.int64],
    coefficients: NDArray[np.float32],
    fresh: NDArray[np.float32],
) -> bool:
    """Write the atom, of unit norm, that fits its patches better; False where no patch uses it, or none is left."""
    sparsity = coefficients.shape[1]
    for j in range(len(fresh)):
        fresh[j] = 0.0
    for use in uses:
        p = use // sparsity
        g = coefficients[p, use % sparsity]
        if g == 0.0:
            continue
        for j in range(len(fresh)):
            fresh[j] += g * (residual[p, j] + g * atom[j])
    square = np.float32(0.0)
    for j in range(len(fresh)):
        square += fresh[j] * fresh[j]
    if square <= _TINY * _TINY:
        return False
    scale = np.float32(1.0) / np.sqrt(square)
    for j in range(len(fresh)):
        fresh[j] *= scale
    return True


@kernel(fastmath=_FASTMATH, inline="always")
def _replace(
    atom: NDArray[np.float32],
    residual: NDArray[np.float32],
    uses: NDArray[np.int64],
    coefficients: NDArray[np.float32],
    fresh: NDArray[np.float32],
) -> None:
    """Put `fresh` in the place of an atom, with the coefficients that fit it, and keep the residual up to date."""
    sparsity = coefficients.shape[1]
    for use in uses:
        p, i = use // sparsity, use % sparsity
        g = coefficients[p, i]
        if g == 0.0:
            continue
        value = np.float32(0.0)
        for j in range(len(fresh)):
            value += fresh[j] * (residual[p, j] + g * atom[j])
        for j in range(len(fresh)):
            residual[p, j] += g * atom[j] - value * fresh[j]
        coefficients[p, i] = value
    for j in range(len(fresh)):
        atom[j] = fresh[j]
