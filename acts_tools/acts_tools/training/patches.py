# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The choice of patches that a dictionary is learnt from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, TOUCH_COUNTS
from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_recon.learning import prune_coherent, random_patches

_PLACES_PER_PATCH = 40
"""Number of positions that are tried per patch: most of the skin is untouched in most frames."""

_DISTINCT_OF_PATCHES = 2.5
"""Number of patches before pruning, per patch after it."""


@dataclass(frozen=True)
class PatchChoice:
    """Which patches are chosen; options of `acts train`."""

    patch_size: int = setting(8, "side of a patch in taxels", minimum=2, maximum=32)
    min_active: int = setting(4, "pressed taxels that a patch needs; paper: 16", minimum=1, maximum=32**2)
    touch_counts: float = setting(float(TOUCH_COUNTS), "touch threshold", minimum=0, maximum=COUNT_MAX - 1)
    coherence: float = setting(0.99, "patches with a larger coherence are pruned", minimum=0, maximum=1)

    def __post_init__(self) -> None:
        validate(self)
        taxels = self.patch_size**2
        if self.min_active > taxels:
            raise SettingsError(f"min_active = {self.min_active}: allowed is 1 to {taxels}, the taxels of a patch")


def choose_patches(
    frames: NDArray[np.uint16], n_patches: int, rng: np.random.Generator, choice: PatchChoice = PatchChoice()
) -> NDArray[np.float32]:
    """Choose at most `n_patches` pressed patches of frames, no two alike (paper, "Tactile Dictionary Learning").

    Returns
    -------
    np.ndarray [shape=(n, patch_size**2), dtype=float32]
    """
    patches = random_patches(
        frames,
        _PLACES_PER_PATCH * n_patches,
        size=choice.patch_size,
        touch_counts=choice.touch_counts,
        min_active=choice.min_active,
        rng=rng,
    )[: int(_DISTINCT_OF_PATCHES * n_patches)]
    return patches[prune_coherent(patches, choice.coherence)][:n_patches]
