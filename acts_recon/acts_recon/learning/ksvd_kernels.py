# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loops of K-SVD in numba; see `acts_recon.learning.ksvd`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel

_TINY = np.float32(1e-7)


@kernel(fastmath={"nnan", "ninf", "nsz", "contract", "reassoc"})
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
    w = np.zeros(sparsity, np.float32)
    x = np.zeros(sparsity, np.float32)
    for p in range(n):
        for k in range(n_atoms):
            rest[k] = projections[p, k]
        count = 0
        while count < sparsity:
            top = np.float32(0.0)
            for k in range(n_atoms):
                top = max(top, abs(rest[k]))
            if top < _TINY:
                break
            atom = 0
            for k in range(n_atoms):
                if abs(rest[k]) == top:
                    atom = k
                    break
            # New row of the factor of gram[chosen, chosen].
            square = gram[atom, atom]
            for i in range(count):
                value = gram[chosen[p, i], atom]
                for j in range(i):
                    value -= L[i, j] * w[j]
                w[i] = value / L[i, i]
                square -= w[i] * w[i]
            if square <= np.float32(1e-5):  # the atom is a sum of the chosen ones
                break
            for i in range(count):
                L[count, i] = w[i]
            L[count, count] = np.sqrt(square)
            chosen[p, count] = atom
            count += 1
            for i in range(count):
                value = projections[p, chosen[p, i]]
                for j in range(i):
                    value -= L[i, j] * x[j]
                x[i] = value / L[i, i]
            for i in range(count - 1, -1, -1):
                value = x[i]
                for j in range(i + 1, count):
                    value -= L[j, i] * x[j]
                x[i] = value / L[i, i]
            for k in range(n_atoms):
                rest[k] = projections[p, k]
            for i in range(count):
                a = chosen[p, i]
                share = x[i]
                for k in range(n_atoms):
                    rest[k] -= share * gram[a, k]
        for i in range(count):
            coefficients[p, i] = x[i]
        for i in range(count, sparsity):
            chosen[p, i] = chosen[p, 0] if count > 0 else 0
            coefficients[p, i] = np.float32(0.0)


@kernel(fastmath={"nnan", "ninf", "nsz", "contract", "reassoc"})
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
    n_atoms, n_pixels = D.shape
    sparsity = coefficients.shape[1]
    fresh = np.zeros(n_pixels, np.float32)
    for k in range(n_atoms):
        for j in range(n_pixels):
            fresh[j] = 0.0
        used = False
        for e in range(start[k], start[k + 1]):
            p = order[e] // sparsity
            g = coefficients[p, order[e] % sparsity]
            if g == 0.0:
                continue
            used = True
            for j in range(n_pixels):
                fresh[j] += g * (residual[p, j] + g * D[k, j])
        if not used:
            continue
        square = np.float32(0.0)
        for j in range(n_pixels):
            square += fresh[j] * fresh[j]
        if square <= _TINY * _TINY:
            continue
        scale = np.float32(1.0) / np.sqrt(square)
        for j in range(n_pixels):
            fresh[j] *= scale
        for e in range(start[k], start[k + 1]):
            p = order[e] // sparsity
            i = order[e] % sparsity
            g = coefficients[p, i]
            if g == 0.0:
                continue
            value = np.float32(0.0)
            for j in range(n_pixels):
                value += fresh[j] * (residual[p, j] + g * D[k, j])
            for j in range(n_pixels):
                residual[p, j] += g * D[k, j] - value * fresh[j]
            coefficients[p, i] = value
        for j in range(n_pixels):
            D[k, j] = fresh[j]
