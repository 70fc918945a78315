# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""CPU time of K-SVD for a dictionary, and of scikit-learn for one that is equally good.

Both learn 1000 atoms from the same 15,000 patches. The measure is the residual of other patches after sparse coding
with 13 atoms by the same pursuit. K-SVD makes the paper's ten iterations; then MiniBatchDictionaryLearning continues,
batch by batch, until its residual is as small. Time is CPU time of all threads without the scoring, so that other
programs hardly affect it.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_recon.learning import KsvdConfig, code_patches, learn_dictionary
from acts_sim.pressing import OBJECTS
from acts_tools.bench.references.peers import SCIKIT_LEARN, missing, peer
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.workbench import Workbench
from acts_tools.training.frames import model_frames
from acts_tools.training.patches import choose_patches

PRESSES = 3000
PATCHES = 15000
OTHERS = 2000
"""Number of patches for scoring, which are not used for learning."""

CONFIG = KsvdConfig()
BATCH = 256
BATCHES_BETWEEN_SCORES = 6
PENALTY = 0.1
"""Penalty alpha of scikit-learn's codes: with its default, 1, it is far from as good after an epoch."""

Patches = NDArray[np.float32]


def measure(workbench: Workbench) -> Result:
    """Learn with both; scikit-learn for at most `workbench.seconds` of CPU time."""
    learnt, others = _patches()
    # Compile or load the kernels before the measurement.
    learn_dictionary(learnt[: CONFIG.atoms], KsvdConfig(atoms=CONFIG.atoms, iterations=1), rng=_rng())
    workbench.check_stop()
    begin_s = time.process_time()
    atoms = learn_dictionary(learnt, CONFIG, rng=_rng())
    ours_s = time.process_time() - begin_s
    error = unexplained(atoms.T, others)
    figures = [
        Figure("ours_s", f"K-SVD, {CONFIG.iterations} iterations, CPU time", ours_s, "s"),
        Figure("ours_error", "    unexplained of other patches", 100 * error, "%"),
    ]
    decomposition = peer(SCIKIT_LEARN, "decomposition")
    if decomposition is None:
        figures.append(Figure("sklearn_s", "MiniBatchDictionaryLearning", missing(SCIKIT_LEARN)))
        return Result(figures)
    peer_s, peer_error = _learn_as_well(decomposition, learnt, others, error, workbench)
    reached = "as good" if peer_error <= error else "given up, less good"
    figures += [
        Figure("sklearn_s", f"MiniBatchDictionaryLearning until {reached}, CPU time", peer_s, "s"),
        Figure("sklearn_error", "    unexplained of other patches", 100 * peer_error, "%"),
        Figure("ratio", f"scikit-learn's time to ours{'' if peer_error <= error else ', at least'}", peer_s / ours_s,
               "times", is_ratio=True),
    ]  # fmt: skip
    return Result(figures)


def unexplained(atoms: NDArray[np.floating], patches: Patches) -> float:
    """Norm of the residual of patches, coded with `CONFIG.sparsity` atoms, over the norm of the patches.

    Parameters
    ----------
    atoms : np.ndarray [shape=(n_atoms, n_pixels), dtype=float]
        Atoms of any norm but 0.
    patches : np.ndarray [shape=(n, n_pixels), dtype=float32]
    """
    D = np.ascontiguousarray(atoms / np.linalg.norm(atoms, axis=1, keepdims=True), dtype=np.float32)
    chosen = np.zeros((len(patches), CONFIG.sparsity), dtype=np.int32)
    coefficients = np.zeros(chosen.shape, dtype=np.float32)
    code_patches(patches @ D.T, D @ D.T, chosen, coefficients)
    left = patches - np.einsum("ns,nsp->np", coefficients, D[chosen])
    return float(np.linalg.norm(left) / np.linalg.norm(patches))


def _learn_as_well(
    decomposition: Any, learnt: Patches, others: Patches, error: float, workbench: Workbench
) -> tuple[float, float]:
    """CPU time [s] and error of scikit-learn when it was as good or gave up."""
    learner = decomposition.MiniBatchDictionaryLearning(
        n_components=CONFIG.atoms, alpha=PENALTY, batch_size=BATCH, random_state=0
    )
    order = _rng().permutation(len(learnt))
    spent_s, reached, batch = 0.0, np.inf, 0
    while spent_s < workbench.seconds and reached > error:
        workbench.check_stop()
        begin_s = time.process_time()
        for _ in range(BATCHES_BETWEEN_SCORES):
            first = batch * BATCH % len(learnt)
            learner.partial_fit(learnt[order[first : first + BATCH]])
            batch += 1
        spent_s += time.process_time() - begin_s
        used = np.linalg.norm(learner.components_, axis=1) > 0
        reached = unexplained(learner.components_[used], others)
    return spent_s, float(reached)


def _patches() -> tuple[Patches, Patches]:
    """Patches for learning and for scoring, each of norm 1."""
    frames = model_frames(list(OBJECTS.values()), PRESSES, seed=0)
    patches = choose_patches(frames, PATCHES + OTHERS, _rng())
    patches /= np.linalg.norm(patches, axis=1, keepdims=True)
    return patches[:-OTHERS], patches[-OTHERS:]


def _rng() -> np.random.Generator:
    return np.random.default_rng(0)
