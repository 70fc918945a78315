# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From full tactile frames to the patches that a dictionary is learnt from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS
from acts_core.errors import ArrayError
from acts_recon.sparse import patch_starts

_CHUNK = 1024
_PLACES = 65536
"""Places looked at at a time."""


def random_patches(
    frames: NDArray[np.number],
    n_patches: int,
    *,
    size: int = 8,
    touch_counts: float = TOUCH_COUNTS,
    min_active: int = 16,
    rng: np.random.Generator,
) -> NDArray[np.float32]:
    """Cut patches at random places out of frames, and drop those with few pressed taxels.

    Parameters
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=number]
        Full frames [counts].
    n_patches : int
        How many places to try.
    size : int
        Side of a patch.
    touch_counts : float
        A taxel above is pressed; others are taken as 0.
    min_active : int
        Pressed pixels that a patch needs. The paper keeps patches with more than 15 ("Tactile Dictionary Learning").
    rng : np.random.Generator

    Returns
    -------
    np.ndarray [shape=(at most n_patches, size * size), dtype=float32]
        Pixels numbered column first, counts.

    Raises
    ------
    ArrayError
        When `frames` are no frames, or too small.
    """
    if frames.ndim != 3 or frames.shape[0] == 0:
        raise ArrayError(f"frames of shape {frames.shape}: needed are (n, rows, cols) with at least one frame")
    patch_starts(min(frames.shape[1:]), size, 1)  # raises where a patch does not fit
    n, rows, cols = frames.shape
    frame = rng.integers(n, size=n_patches)[:, None, None]
    row = rng.integers(rows - size + 1, size=n_patches)[:, None, None]
    col = rng.integers(cols - size + 1, size=n_patches)[:, None, None]
    # Column first.
    down, right = np.arange(size)[None, None, :], np.arange(size)[None, :, None]
    kept = []
    # In pieces: most places are untouched and left out, and all of them at once may be more than memory holds.
    for begin in range(0, n_patches, _PLACES):
        piece = slice(begin, begin + _PLACES)
        patches = frames[frame[piece], row[piece] + down, col[piece] + right].reshape(-1, size * size)
        patches = np.where(patches > touch_counts, patches, 0).astype(np.float32)
        kept.append(patches[np.count_nonzero(patches, axis=1) >= min_active])
    return np.concatenate(kept)


def require_patches(patches: NDArray[np.floating]) -> None:
    """Raise `ArrayError` unless these are patches, shape (n, n_pixels), finite and none of them all 0."""
    if patches.ndim != 2:
        raise ArrayError(f"patches of shape {patches.shape}: needed are (n, n_pixels)")
    if not np.isfinite(patches).all():
        raise ArrayError("the patches hold NaN or infinity")
    if not patches.any(axis=1).all():
        raise ArrayError("some patches are all 0; leave them out")


def prune_coherent(patches: NDArray[np.float32], limit: float) -> NDArray[np.bool_]:
    """Choose patches of which no two are nearly equal.

    Parameters
    ----------
    patches : np.ndarray [shape=(n, n_pixels), dtype=float32]
        Finite, none of them all 0.
    limit : float
        Largest allowed coherence, ``|<a, b>|`` of unit-norm patches (paper, "Tactile Dictionary Learning").

    Returns
    -------
    np.ndarray [shape=(n,), dtype=bool]
        True for the patches to keep: each whose coherence with every earlier kept one is at most `limit`.

    Raises
    ------
    ArrayError
        When `patches` are none, not finite or all 0, or the limit is not within 0 to 1.
    """
    if not 0.0 <= limit <= 1.0:
        raise ArrayError(f"limit = {limit}: allowed is 0 to 1")
    require_patches(patches)
    unit = patches / np.linalg.norm(patches, axis=1, keepdims=True)
    n = unit.shape[0]
    keep = np.ones(n, dtype=bool)
    for start in range(0, n, _CHUNK):
        chunk = unit[start : start + _CHUNK]
        earlier = unit[:start][keep[:start]]
        if earlier.size:
            keep[start : start + _CHUNK] = (np.abs(chunk @ earlier.T) <= limit).all(axis=1)
        alike = np.abs(chunk @ chunk.T) > limit
        for i in range(chunk.shape[0]):
            if keep[start + i]:
                keep[start + i] = not (alike[i, :i] & keep[start : start + i]).any()
    return keep
