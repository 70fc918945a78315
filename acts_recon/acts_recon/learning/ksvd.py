# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""K-SVD: learning a dictionary in which every patch is a sum of few atoms.

M. Aharon, M. Elad, A. Bruckstein, "K-SVD: An algorithm for designing overcomplete dictionaries for sparse
representation", IEEE Transactions on Signal Processing 54, 4311-4322 (2006): the paper's reference 54. Sparse coding is
batch OMP and an atom's update is one power iteration instead of an SVD, both after R. Rubinstein, M. Zibulevsky,
M. Elad, "Efficient implementation of the K-SVD algorithm using batch orthogonal matching pursuit" (its reference 56).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.settings import setting, validate
from acts_recon.learning.ksvd_kernels import code_patches, update_atoms
from acts_recon.learning.training_patches import require_patches


@dataclass(frozen=True)
class KsvdConfig:
    """Settings of K-SVD; the defaults are the paper's ("Tactile Dictionary Learning")."""

    atoms: int = setting(1000, "number of atoms", minimum=2, maximum=20000)
    sparsity: int = setting(13, "largest number of atoms in a patch", minimum=1, maximum=64)
    iterations: int = setting(10, "rounds of coding and updating", minimum=1, maximum=1000)
    coherence: float = setting(0.99, "an atom more alike than this to an earlier one is replaced", minimum=0, maximum=1)
    min_users: int = setting(2, "an atom used by fewer patches than this is replaced", minimum=0, maximum=1000)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class KsvdProgress:
    """Progress of the learning after an iteration.

    Attributes
    ----------
    iteration, iterations : int
        1 to `iterations`.
    relative_error : float
        Norm of the residual over the norm of the patches.
    replaced : int
        Atoms replaced in this iteration.
    """

    iteration: int
    iterations: int
    relative_error: float
    replaced: int


@dataclass(frozen=True)
class KsvdState:
    """State between two iterations, from which an interrupted learning continues.

    Attributes
    ----------
    iteration : int
        Iterations done, at least 1.
    atoms : np.ndarray [shape=(config.atoms, n_pixels), dtype=float32]
        A row an atom.
    """

    iteration: int
    atoms: NDArray[np.float32]


def learn_dictionary(
    patches: NDArray[np.floating],
    config: KsvdConfig,
    *,
    rng: np.random.Generator,
    progress: Callable[[KsvdProgress], None] | None = None,
    save: Callable[[KsvdState], None] | None = None,
    resume: KsvdState | None = None,
) -> NDArray[np.float32]:
    """Learn atoms from patches.

    Parameters
    ----------
    patches : np.ndarray [shape=(n, n_pixels), dtype=float]
        At least as many as atoms, none all 0, all finite.
    config : KsvdConfig
    rng : np.random.Generator
        Same state, same atoms (on the same processor: the last digits of sums may differ between processors).
    progress : callable or None
        Called after every iteration.
    save : callable or None
        Called before `progress`, after every iteration but the last; the atoms are valid during the call.
    resume : KsvdState or None
        What `save` got, with the same patches, configuration and `rng`: the result is the same, bit for bit.

    Returns
    -------
    np.ndarray [shape=(n_pixels, config.atoms), dtype=float32]
        Unit-norm atoms whose largest element is positive.

    Raises
    ------
    ArrayError
        When the patches are too few, of the wrong shape, all 0 or not finite, or `resume` does not fit or is not
        finite.
    """
    X = _checked(patches, config)
    # Every patch counts alike, however hard it was pressed: what is learnt is shape.
    X /= np.linalg.norm(X, axis=1, keepdims=True)
    n, n_pixels = X.shape
    D = np.ascontiguousarray(X[rng.choice(n, size=config.atoms, replace=False)])
    first = 1
    if resume is not None:
        atoms = np.asarray(resume.atoms, dtype=np.float32)
        if atoms.shape != D.shape or not 1 <= resume.iteration < config.iterations:
            raise ArrayError(
                f"state after iteration {resume.iteration} with atoms {atoms.shape}: "
                f"needed are 1 to {config.iterations - 1} and {D.shape}"
            )
        if not np.isfinite(atoms).all():
            raise ArrayError("the atoms of the state hold NaN or infinity; learn from the beginning")
        D[:] = atoms
        first = resume.iteration + 1
    sparsity = min(config.sparsity, n_pixels, config.atoms)
    chosen = np.zeros((n, sparsity), dtype=np.int32)
    coefficients = np.zeros((n, sparsity), dtype=np.float32)
    for iteration in range(first, config.iterations + 1):
        code_patches(X @ D.T, D @ D.T, chosen, coefficients)
        residual = X - _synthesis(D, chosen, coefficients)
        order = np.argsort(chosen.ravel(), kind="stable").astype(np.int64)
        start = np.searchsorted(chosen.ravel()[order], np.arange(config.atoms + 1)).astype(np.int64)
        update_atoms(D, residual, order, start, coefficients)
        error = float(np.linalg.norm(residual) / np.linalg.norm(X))
        # After the last iteration a fresh patch would be an atom that nothing was fitted to.
        replaced = 0 if iteration == config.iterations else _replace(D, X, residual, chosen, coefficients, config)
        if save is not None and iteration < config.iterations:
            save(KsvdState(iteration, D))
        if progress is not None:
            progress(KsvdProgress(iteration, config.iterations, error, replaced))
    peak = np.take_along_axis(D, np.argmax(np.abs(D), axis=1)[:, None], axis=1)
    return np.ascontiguousarray((D * np.sign(peak)).T)


def _checked(patches: NDArray[np.floating], config: KsvdConfig) -> NDArray[np.float32]:
    # In this order, for in another the last digits of sums may differ.
    X = np.array(patches, dtype=np.float32, order="C")
    require_patches(X)
    if X.shape[0] < config.atoms:
        raise ArrayError(
            f"{X.shape[0]} patches for {config.atoms} atoms: give more frames, or learn fewer atoms "
            f"(patches with few pressed taxels and repeated ones are left out)"
        )
    return X


def _synthesis(
    D: NDArray[np.float32], chosen: NDArray[np.int32], coefficients: NDArray[np.float32]
) -> NDArray[np.float32]:
    codes = np.zeros((chosen.shape[0], D.shape[0]), dtype=np.float32)
    # A place of a patch's code that is not used has coefficient 0 and repeats an atom, hence add, not assign.
    np.add.at(codes, (np.arange(chosen.shape[0])[:, None], chosen), coefficients)
    return codes @ D


def _replace(
    D: NDArray[np.float32],
    X: NDArray[np.float32],
    residual: NDArray[np.float32],
    chosen: NDArray[np.int32],
    coefficients: NDArray[np.float32],
    config: KsvdConfig,
) -> int:
    """Replace atoms that are hardly used, or nearly equal to another, by the patches with the largest residuals."""
    used = chosen.ravel()[np.abs(coefficients.ravel()) > 1e-6]
    users = np.bincount(used, minlength=config.atoms)
    alike = np.tril(np.abs(D @ D.T), -1).max(axis=1) > config.coherence
    bad = np.flatnonzero((users < config.min_users) | alike)
    worst = np.argsort(-np.einsum("ij,ij->i", residual, residual), kind="stable")[: bad.size]
    bad = bad[: worst.size]
    D[bad] = X[worst]
    return int(bad.size)
