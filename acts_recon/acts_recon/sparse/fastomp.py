# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""FastOMP of one patch in NumPy, and what it shares with `fastomp_kernels`, which recovers whole images by it.

FastOMP is orthogonal matching pursuit (OMP) with a QR factorisation by modified Gram-Schmidt. For a patch with measured
pixels y and the measured rows A of the dictionary, starting from the residual r = y, each step

1. chooses the atom with the largest ``|a' r|``,
2. makes it orthogonal to the atoms chosen before: w,
3. takes the projection on it off the residual: ``r -= w (w' r) / (w' w + REGULARISATION)``.

In the end the triangular system ``R x = Q' y`` gives the coefficients x of the atoms. The method is the paper's
("Sparse Recovery and Tactile Reconstruction"; its reference 49) with the details of the published analysis: a quarter
as many atoms as measured pixels, atoms not re-normalised after the measured rows are picked, overlapping patches
averaged.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

REGULARISATION = 1e-4
"""Ridge: added to the squared norm of every orthogonalised column, which may be 0."""

SPARSITY_RATIO = 0.25
"""Atoms allowed per measured pixel of a patch."""


def sparsity(measured: int, ratio: float = SPARSITY_RATIO) -> int:
    """Number of atoms for a patch with `measured` pixels: ``round(ratio * measured)``, halves up, at least 1."""
    return max(1, math.floor(ratio * measured + 0.5))


def fast_omp(
    A: NDArray[np.floating], y: NDArray[np.floating], n_atoms: int
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Approximate ``y = A[:, chosen] @ coefficients`` with at most `n_atoms` columns.

    Parameters
    ----------
    A : np.ndarray [shape=(m, n_columns), dtype=float]
        The rows of the dictionary that were measured.
    y : np.ndarray [shape=(m,), dtype=float]
        What was measured.
    n_atoms : int
        Columns to choose, at least 1. Fewer are chosen when nothing is left to explain.

    Returns
    -------
    chosen : np.ndarray [shape=(s,), dtype=int64]
        Columns, in the order of choice.
    coefficients : np.ndarray [shape=(s,), dtype=float64]
    """
    A = np.asarray(A, dtype=np.float64)
    y = np.asarray(y, dtype=np.float64)
    residual = y.copy()
    R = np.zeros((n_atoms, n_atoms))
    Q = np.zeros((n_atoms, y.size))
    chosen: list[int] = []
    for i in range(n_atoms):
        correlation = np.abs(residual @ A)
        atom = int(np.argmax(correlation))
        if correlation[atom] == 0:
            break
        w = A[:, atom].copy()
        for j in range(i):
            R[j, i] = Q[j] @ w
            w -= R[j, i] * Q[j] / R[j, j]
        R[i, i] = w @ w + REGULARISATION
        Q[i] = w
        residual -= (w @ residual) * w / R[i, i]
        chosen.append(atom)
    s = len(chosen)
    v = Q[:s] @ y
    coefficients = np.zeros(s)
    for i in range(s - 1, -1, -1):
        coefficients[i] = (v[i] - R[i, i + 1 : s] @ coefficients[i + 1 :]) / R[i, i]
    return np.array(chosen, dtype=np.int64), coefficients
