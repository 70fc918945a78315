# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The choice of patches that a dictionary is learnt from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_recon.learning import prune_coherent, random_patches

_PLACES_PER_PATCH = 40
"""Number of positions that are tried per patch: most of the skin is untouched in most frames."""

_DISTINCT_OF_PATCHES = 2.5
"""Number of patches before pruning, per patch after it."""


@dataclass(frozen=True)
class PatchChoice:
    """Which patches are chosen; the defaults are those of `acts train`.

    Attributes
    ----------
    size : int
        Side of a patch [taxels].
    touch_counts : float
        A taxel above it is pressed.
    min_active : int
        Pressed taxels that a patch needs.
    coherence : float
        Of two patches with a larger coherence one is left out.
    """

    size: int = 8
    touch_counts: float = 60.0
    min_active: int = 4
    coherence: float = 0.99


def choose_patches(
    frames: NDArray[np.uint16], n_patches: int, rng: np.random.Generator, choice: PatchChoice = PatchChoice()
) -> NDArray[np.float32]:
    """Choose at most `n_patches` pressed patches of frames, no two alike (paper, "Tactile Dictionary Learning").

    Returns
    -------
    np.ndarray [shape=(n, size * size), dtype=float32]
    """
    patches = random_patches(
        frames,
        _PLACES_PER_PATCH * n_patches,
        size=choice.size,
        touch_counts=choice.touch_counts,
        min_active=choice.min_active,
        rng=rng,
    )[: int(_DISTINCT_OF_PATCHES * n_patches)]
    return patches[prune_coherent(patches, choice.coherence)][:n_patches]
