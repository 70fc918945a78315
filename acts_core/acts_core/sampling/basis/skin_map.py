# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a board is told of a layout: which taxels are neighbours on the skin, and where its patches end.

The schemes that look for neighbours (adaptive, tracking, and hybrid in part) walk the picture of the skin place by
place; frames name taxels of the matrix as ever. In C++ it is ``acts::SkinMap``; `docs/wire_protocol.md` has the bytes.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from acts_core.array import MAX_SIDE
from acts_core.errors import ArrayError
from acts_core.skin import MAX_PATCHES, NO_PATCH, Layout

_HEAD = struct.Struct("<BBBB")
_PATCH_SHIFT = 12


@dataclass(frozen=True)
class SkinMap:
    """The picture of a skin, place by place, row-major.

    Attributes
    ----------
    rows, cols : int
        Of the picture.
    taxels : tuple of int
        Matrix index of the taxel at each place.
    patches : tuple of int
        Patch of each place, 0 to 15.
    no_skin : int
        The patch that is no skin: never taken for pressed; `NO_PATCH` where all is skin.
    """

    rows: int
    cols: int
    taxels: tuple[int, ...]
    patches: tuple[int, ...]
    no_skin: int = NO_PATCH

    @classmethod
    def of(cls, layout: Layout, dead: NDArray[np.bool_] | None = None) -> SkinMap:
        """That of a layout.

        Parameters
        ----------
        layout : Layout
        dead : np.ndarray [shape=(matrix rows, matrix cols), dtype=bool], optional
            Broken taxels: as if there were no skin, so that none is taken for pressed, whatever it reads.

        Raises
        ------
        ArrayError
            When it has more patches than a map can tell.
        """
        patches = layout.patch_of.astype(int).ravel()
        bare = patches == NO_PATCH
        if dead is not None:
            bare |= layout.picture(dead).ravel().astype(np.bool_)
        n = len(layout.patches) + bool(bare.any())
        if n > MAX_PATCHES:
            raise ArrayError(
                f"layout {layout.name}: {n} patches, with the places without skin; a board takes {MAX_PATCHES}"
            )
        return cls(
            layout.rows,
            layout.cols,
            tuple(layout.taxels.ravel().tolist()),
            tuple(np.where(bare, n - 1, patches).tolist()),
            n - 1 if bare.any() else NO_PATCH,
        )

    @classmethod
    def of_matrix(cls, rows: int, cols: int) -> SkinMap:
        """That of a matrix that is the picture itself, and one patch: what a board has that was told none.

        Raises
        ------
        ArrayError
            For a size that no board has.
        """
        if not (1 <= rows <= MAX_SIDE and 1 <= cols <= MAX_SIDE):
            raise ArrayError(f"matrix of {rows} x {cols}: allowed is 1 to {MAX_SIDE} each")
        return cls(rows, cols, tuple(range(rows * cols)), (0,) * (rows * cols))

    def has_skin(self, place: int) -> bool:
        """Whether there is skin at a place."""
        return self.patches[place] != self.no_skin

    def joined(self, one: int, other: int) -> bool:
        """Whether two places are on the same patch."""
        return self.patches[one] == self.patches[other]

    def entries(self) -> bytes:
        """Taxel and patch of every place as a board takes them: uint16, little-endian."""
        taxels, patches = np.array(self.taxels), np.array(self.patches)
        return (taxels | patches << _PATCH_SHIFT).astype("<u2").tobytes()

    def head(self) -> bytes:
        """What precedes the entries in the checksum."""
        return _HEAD.pack(self.rows, self.cols, self.no_skin, 0)

    @cached_property
    def crc32(self) -> int:
        """By which a board tells what it has."""
        return zlib.crc32(self.head() + self.entries())
