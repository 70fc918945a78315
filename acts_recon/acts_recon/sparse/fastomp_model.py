# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Dictionary and buffers of the kernels of FastOMP, allocated once."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_recon.sparse.fastomp import SPARSITY_RATIO, sparsity
from acts_recon.sparse.patches import PatchLayout

_CACHE_LINE_BYTES = 64

MEASURED, PRESSED, ALLOWED, N_CHOSEN, ORDER, BEST, CHOSEN = range(7)
"""Rows of `Problems.table`, see there; from `CHOSEN` on a row for each atom."""

Y_ROWS, RESIDUAL_ROWS, Q_ROWS = range(3)
"""First index of `Problems.rows`, see there; from `Q_ROWS` on one for each atom."""

BLOCK = 512
"""Atoms whose correlations are computed together. (Of 128 to 1024 all are about as fast.)"""


def in_blocks(atoms: NDArray[np.floating]) -> NDArray[np.float32]:
    """Lay a dictionary out for `acts_recon.sparse.fastomp_kernels.choose`.

    Parameters
    ----------
    atoms : np.ndarray [shape=(n_pixels, n_atoms), dtype=float]

    Returns
    -------
    np.ndarray [shape=(n_blocks, n_pixels, BLOCK), dtype=float32]
        Filled up with atoms of zeros, which are never chosen.
    """
    n_pixels, n_atoms = atoms.shape
    n_blocks = -(-n_atoms // BLOCK)
    filled = np.zeros((n_pixels, n_blocks * BLOCK), dtype=np.float32)
    filled[:, :n_atoms] = atoms
    return _aligned(filled.reshape(n_pixels, n_blocks, BLOCK).transpose(1, 0, 2))


class PatchModel(NamedTuple):
    """A dictionary and a layout as `acts_recon.sparse.fastomp_kernels.recover_image` takes them.

    Pixels of a patch are numbered row by row here, as taxels are: whole rows of a patch go to the image at once.

    Attributes
    ----------
    blocks : np.ndarray [shape=(n_blocks, n_pixels, BLOCK), dtype=float32]
        See `in_blocks`.
    atoms : np.ndarray [shape=(n_atoms, n_pixels), dtype=float32]
    corners : np.ndarray [shape=(n_patches,), dtype=uint32]
        First taxel of each patch.
    holders : np.ndarray [shape=(n_taxels, 1 + 2 * most), dtype=uint32]
        For every taxel how many patches hold it, then for each of them which patch, and which pixel of it.
    share : np.ndarray [shape=(n_taxels,), dtype=float32]
        One over the number of patches that hold a taxel.
    side, stride : int
        Taxels in a row of a patch, and of the image.
    """

    blocks: NDArray[np.float32]
    atoms: NDArray[np.float32]
    corners: NDArray[np.uint32]
    holders: NDArray[np.uint32]
    share: NDArray[np.float32]
    side: int
    stride: int

    @classmethod
    def of(cls, layout: PatchLayout, atoms: NDArray[np.floating]) -> PatchModel:
        """Of a layout and a dictionary.

        Parameters
        ----------
        layout : PatchLayout
        atoms : np.ndarray [shape=(size * size, n_atoms), dtype=float]
            Pixels numbered as by `PatchLayout`.
        """
        # This numbering is its own inverse.
        column_first = np.arange(layout.size**2).reshape(layout.size, layout.size).T.ravel()
        by_rows = atoms[column_first]
        return cls(
            blocks=in_blocks(by_rows),
            atoms=_aligned(by_rows.T),
            corners=layout.taxels[:, 0].astype(np.uint32),
            holders=_holders(layout, column_first),
            share=(1 / layout.overlap).astype(np.float32),
            side=layout.size,
            stride=layout.cols,
        )


class Problems(NamedTuple):
    """The buffers of `acts_recon.sparse.fastomp_kernels.pursue`.

    Attributes
    ----------
    pixels : np.ndarray [shape=(n, n_pixels), dtype=uint32]
        Given: which pixels of each problem were measured, those that do not read 0 first.
    table : np.ndarray [shape=(CHOSEN + n_atoms, n), dtype=int32]
        Given: how many pixels were measured (`MEASURED`), how many of them do not read 0 (`PRESSED`), how many atoms
        are `ALLOWED`, and which problems there are (`ORDER`; overwritten). Found: how many atoms were chosen
        (`N_CHOSEN`), and which (from `CHOSEN` on). The others are for work.
    rows : np.ndarray [shape=(Q_ROWS + n_atoms, n, n_pixels), dtype=float32]
        Given: what was measured (`Y_ROWS`). For work: the residuals (`RESIDUAL_ROWS`), and the orthogonalised
        atoms (from `Q_ROWS` on).
    systems : np.ndarray [shape=(n, n_atoms, n_atoms + 1), dtype=float32]
        Found: the triangular system of equations, the right side in the last column.
    sums : np.ndarray [shape=(BLOCK,), dtype=float32]
    largest : np.ndarray [shape=(n,), dtype=float32]
        For work: correlations with the atoms of a block, and the largest of each problem.
    """

    pixels: NDArray[np.uint32]
    table: NDArray[np.int32]
    rows: NDArray[np.float32]
    systems: NDArray[np.float32]
    sums: NDArray[np.float32]
    largest: NDArray[np.float32]

    @classmethod
    def empty(cls, n: int, n_pixels: int, n_atoms: int) -> Problems:
        """For at most `n` problems, each with at most so many measured pixels and allowed atoms."""
        return cls(
            pixels=np.zeros((n, n_pixels), dtype=np.uint32),
            table=np.zeros((CHOSEN + n_atoms, n), dtype=np.int32),
            rows=_aligned(np.zeros((Q_ROWS + n_atoms, n, n_pixels))),
            systems=np.zeros((n, n_atoms, n_atoms + 1), dtype=np.float32),
            sums=_aligned(np.zeros(BLOCK)),
            largest=np.zeros(n, dtype=np.float32),
        )


def workspace(layout: PatchLayout, ratio: float = SPARSITY_RATIO) -> Problems:
    """The buffers that `recover_image` works in, with `ratio` atoms per measured pixel."""
    n_pixels = layout.size**2
    return Problems.empty(layout.n_patches, n_pixels, sparsity(n_pixels, ratio))


def _holders(layout: PatchLayout, pixel_of: NDArray[np.integer]) -> NDArray[np.uint32]:
    """`PatchModel.holders`."""
    counts = np.diff(layout.entry_start)
    holders = np.zeros((counts.size, 1 + 2 * int(counts.max())), dtype=np.uint32)
    holders[:, 0] = counts
    taxel = np.repeat(np.arange(counts.size), counts)
    place = np.arange(taxel.size) - layout.entry_start[taxel]
    holders[taxel, 1 + 2 * place] = layout.entry_patch
    holders[taxel, 2 + 2 * place] = pixel_of[layout.entry_pixel]
    return holders


def _aligned(values: NDArray) -> NDArray[np.float32]:
    """A copy that begins where a line of the cache does: vectors that straddle two lines take half as long again."""
    size = 4 * math.prod(values.shape)
    buffer = np.zeros(size + _CACHE_LINE_BYTES, dtype=np.uint8)
    skip = -buffer.ctypes.data % _CACHE_LINE_BYTES
    array = buffer[skip : skip + size].view(np.float32).reshape(values.shape)
    array[:] = values
    return array
