# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Overlapping square patches that cover an array: the units in which it is recovered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_recon.images import Borders, borders_of


@dataclass(frozen=True)
class PatchLayout:
    """Where the patches lie and which taxel is which pixel of which patch.

    Pixels of a patch are numbered column first: pixel ``col * size + row``. This is the order of the published
    dictionaries.

    Attributes
    ----------
    rows, cols : int
        Size of the array.
    size, step : int
        Side of a patch and distance between neighbouring ones, in taxels.
    taxels : np.ndarray [shape=(n_patches, size * size), dtype=int32]
        Row-major taxel index of every pixel of every patch.
    overlap : np.ndarray [shape=(rows * cols,), dtype=float32]
        Number of patches that hold a taxel; 1 also where none does.
    entry_start : np.ndarray [shape=(rows * cols + 1,), dtype=int32]
    entry_patch, entry_pixel : np.ndarray [shape=(n_patches * size * size,), dtype=int32]
        The inverse of `taxels`: taxel t is pixel ``entry_pixel[e]`` of patch ``entry_patch[e]`` for e from
        ``entry_start[t]`` to ``entry_start[t + 1] - 1``.
    """

    rows: int
    cols: int
    size: int
    step: int
    taxels: NDArray[np.int32]
    overlap: NDArray[np.float32]
    entry_start: NDArray[np.int32]
    entry_patch: NDArray[np.int32]
    entry_pixel: NDArray[np.int32]

    @property
    def n_patches(self) -> int:
        """Number of patches."""
        return int(self.taxels.shape[0])


def patch_starts(length: int, size: int, step: int) -> list[int]:
    """First row (or column) of the patches along a side of `length` taxels; the last patch ends flush with the edge.

    Raises
    ------
    ArrayError
        When a patch is longer than the side, or the step is not in 1 to `size` (a longer one leaves taxels out).
    """
    if not 1 <= size <= length:
        raise ArrayError(f"patches of {size} x {size} taxels do not fit a side of {length}; use smaller patches")
    if not 1 <= step <= size:
        raise ArrayError(f"patch step {step}: allowed is 1 to the patch size, {size}")
    starts = list(range(0, length - size + 1, step))
    if starts[-1] != length - size:
        starts.append(length - size)
    return starts


def patch_layout(rows: int, cols: int, *, size: int = 8, step: int = 4, borders: Borders | None = None) -> PatchLayout:
    """Cover an array with patches; the defaults are the paper's ("Sparse Recovery and Tactile Reconstruction").

    Parameters
    ----------
    rows, cols, size, step : int
    borders : Borders, optional
        No patch reaches over one. A single taxel among borders, which is no skin, is covered by none.

    Raises
    ------
    ArrayError
        See `patch_starts`.
    """
    corners = [
        (first_row + row, first_col + col)
        for first_row, end_row, first_col, end_col in (borders or borders_of(rows, cols)).rectangles.tolist()
        if borders is None or (end_row - first_row, end_col - first_col) != (1, 1)
        for row in patch_starts(end_row - first_row, size, step)
        for col in patch_starts(end_col - first_col, size, step)
    ]
    if not corners:
        raise ArrayError("patches of the skin of a single taxel: none holds a patch of the recovery; use method fusion")
    pixel = np.arange(size * size)
    in_patch = (pixel % size) * cols + pixel // size
    taxels = np.array([row * cols + col + in_patch for row, col in corners], dtype=np.int32)
    flat = taxels.ravel()
    overlap = np.bincount(flat, minlength=rows * cols)
    order = np.argsort(flat, kind="stable")
    return PatchLayout(
        rows=rows,
        cols=cols,
        size=size,
        step=step,
        taxels=taxels,
        overlap=np.maximum(overlap, 1).astype(np.float32),
        entry_start=np.concatenate(([0], np.cumsum(overlap))).astype(np.int32),
        entry_patch=(order // (size * size)).astype(np.int32),
        entry_pixel=(order % (size * size)).astype(np.int32),
    )
