# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Layouts: how the taxels of the readout matrix lie on the skin.

The board reads a matrix of rows and columns of wires. On a square pad the matrix is the picture. On the paper's insole
and glove, and on a hand, the same 32 x 32 wires run otherwise: a layout says which taxel of the matrix lies at which
place of the picture, and which rectangles of the picture are patches of skin. Samples, and everything before the
recovery, stay in matrix indices; images and contacts are the picture's. A layout is a file (`layout_file`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin.layout_file import NO_PATCH, in_picture, read_layout
from acts_core.skin.skin_patch import SkinPatch

__all__ = ["LAYOUTS", "NO_PATCH", "Layout", "SkinPatch", "layout", "layout_path"]

LAYOUTS = ("square", "arm", "chest", "end_effector", "glove", "helmet", "insole", "leap_right", "leg")
"""Names of the layouts that come with ACTS; ``square`` is the matrix itself, of any size."""


@dataclass(frozen=True)
class Layout:
    """A permutation of the matrix' taxels into a picture, and the patches of that.

    Attributes
    ----------
    name : str
        As given to `layout`.
    taxels : np.ndarray [shape=(rows, cols), dtype=uint16, read-only]
        Matrix index (row-major) of the taxel at each place of the picture.
    places : np.ndarray [shape=(matrix_rows * matrix_cols,), dtype=uint16, read-only]
        The inverse: place in the picture (row-major) of each taxel of the matrix.
    matrix_rows, matrix_cols : int
        Size of the matrix.
    pitch_m, row_pitch_m : float
        Distances of neighbouring columns and rows of the picture [m].
    patches : tuple of SkinPatch
        None overlap. Their edges are borders: nothing is made of taxels on both sides of one.
    patch_of : np.ndarray [shape=(rows, cols), dtype=uint8, read-only]
        Index in `patches` of the patch at each place of the picture, `NO_PATCH` where there is no skin.
    stood_on : bool or None
        Whether somebody stands and steps on it, as on an insole; None: not known.
    """

    name: str
    taxels: NDArray[np.uint16]
    places: NDArray[np.uint16]
    matrix_rows: int
    matrix_cols: int
    pitch_m: float
    row_pitch_m: float
    patches: tuple[SkinPatch, ...]
    patch_of: NDArray[np.uint8]
    stood_on: bool | None = None

    @property
    def rows(self) -> int:
        """Rows of the picture."""
        return int(self.taxels.shape[0])

    @property
    def cols(self) -> int:
        """Columns of the picture."""
        return int(self.taxels.shape[1])

    @cached_property
    def patch_of_taxel(self) -> NDArray[np.uint8]:
        """`patch_of` by matrix taxel; np.ndarray [shape=(matrix_rows, matrix_cols), dtype=uint8, read-only]."""
        by_taxel = self.patch_of.ravel()[self.places].reshape(self.matrix_rows, self.matrix_cols)
        by_taxel.flags.writeable = False
        return by_taxel

    @cached_property
    def neighbours(self) -> NDArray[np.int32]:
        """The up to eight taxels around each taxel of the matrix, on the skin and on the same patch; none without skin.

        np.ndarray [shape=(matrix_rows * matrix_cols, 8), dtype=int32, read-only]: matrix indices, -1 for none.
        """
        taxels = np.pad(self.taxels.astype(np.int32), 1, constant_values=-1)
        patches = np.pad(self.patch_of, 1, constant_values=NO_PATCH)
        is_skin = self.patch_of != NO_PATCH
        around = []
        for row, col in ((0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1), (2, 2)):
            there = slice(row, row + self.rows), slice(col, col + self.cols)
            around.append(np.where(is_skin & (patches[there] == self.patch_of), taxels[there], np.int32(-1)).ravel())
        by_taxel = np.stack(around, axis=1)[self.places]
        by_taxel.flags.writeable = False
        return by_taxel

    @cached_property
    def is_matrix(self) -> bool:
        """Whether the picture is the matrix itself and one patch, as that of a square pad."""
        taxels = np.arange(self.matrix_rows * self.matrix_cols)
        is_same = (self.rows, self.cols) == (self.matrix_rows, self.matrix_cols)
        return is_same and bool((self.taxels.ravel() == taxels).all() and (self.patch_of == 0).all())

    def picture(self, matrix: ArrayLike) -> NDArray[np.generic]:
        """Values by matrix taxel, shape (matrix_rows, matrix_cols), as a picture, shape (rows, cols)."""
        values = np.asarray(matrix)
        self._check(values.shape, (self.matrix_rows, self.matrix_cols), "matrix")
        return values.ravel()[self.taxels]

    def matrix(self, picture: ArrayLike) -> NDArray[np.generic]:
        """The inverse of `picture`: from shape (rows, cols) to shape (matrix_rows, matrix_cols)."""
        values = np.asarray(picture)
        self._check(values.shape, (self.rows, self.cols), "picture")
        return values.ravel()[self.places].reshape(self.matrix_rows, self.matrix_cols)

    def geometry(self, pitch_m: float = 0.0, row_pitch_m: float = 0.0) -> ArrayGeometry:
        """The picture's geometry.

        Parameters
        ----------
        pitch_m, row_pitch_m : float
            Distances of neighbouring columns and rows [m]. Without the second it is the first; without both they are
            those of the layout.
        """
        if not pitch_m:
            return ArrayGeometry(self.rows, self.cols, self.pitch_m, row_pitch_m or self.row_pitch_m)
        return ArrayGeometry(self.rows, self.cols, pitch_m, row_pitch_m or pitch_m)

    def spaced(self, pitch_m: float = 0.0, row_pitch_m: float = 0.0) -> Layout:
        """The layout with the picture's geometry that `geometry` gives for these distances [m].

        Patches that lie as in the picture become larger or smaller with it. Those with a link or a pose of their own
        stay as they are.
        """
        before, after = self.geometry(), self.geometry(pitch_m, row_pitch_m)
        patches = []
        for patch in self.patches:
            if not patch.link and patch == in_picture(patch, before):
                wider, longer = after.pitch_m / before.pitch_m, after.pitch_y_m / before.pitch_y_m
                sized = replace(patch, pitch_m=wider * patch.pitch_m, row_pitch_m=longer * patch.row_pitch_m)
                patch = in_picture(sized, after)
            patches.append(patch)
        return replace(self, pitch_m=after.pitch_m, row_pitch_m=after.pitch_y_m, patches=tuple(patches))

    def patch(self, row: int, col: int) -> SkinPatch:
        """The patch that holds a place of the picture.

        Raises
        ------
        ArrayError
            None does: the place is without skin, or out of the picture.
        """
        for patch in self.patches:
            if patch.holds(row, col):
                return patch
        raise ArrayError(
            f"place ({row}, {col}): none of the patches of the layout {self.name} holds it; its picture has "
            f"{self.rows} rows and {self.cols} columns"
        )

    def _check(self, given: tuple[int, ...], wanted: tuple[int, ...], what: str) -> None:
        if given != wanted:
            raise ArrayError(f"{what} of shape {given}: the layout {self.name} has {wanted}")


def layout_path(name_or_path: str) -> Path:
    """The file of a layout: one that comes with ACTS, or any that the text names by a path.

    Raises
    ------
    ArrayError
        When it is neither a known name nor looks like a path. Whether there is such a file is not asked.
    """
    if name_or_path in LAYOUTS:
        return Path(__file__).with_name("skin_layouts") / f"{name_or_path}.yaml"
    if "/" in name_or_path or name_or_path.endswith((".yaml", ".yml")):
        try:
            return Path(name_or_path).expanduser()
        except RuntimeError as error:  # ~somebody who does not exist
            raise ArrayError(f"layout {name_or_path!r}: {error}") from None
    raise ArrayError(
        f"layout {name_or_path!r}: allowed is one of {', '.join(LAYOUTS)}, or the path of a layout file (.yaml)"
    )


def layout(name_or_path: str, rows: int | None = None, cols: int | None = None) -> Layout:
    """A layout of a matrix.

    Parameters
    ----------
    name_or_path : str
        One of `LAYOUTS`: ``square``, the matrix as it is; ``insole``, 64 x 16; ``glove``, 32 x 32 turned, with palm,
        thumb and four fingers (both as in the authors' published analysis); ``leap_right``, the right LEAP hand, 13
        patches; ``arm``, ``chest``, ``end_effector``, ``helmet`` and ``leg``, the matrix as it is, with the size and
        the bend of each. Or the path of a layout file of one's own.
    rows, cols : int or None
        Size of the matrix; None for that of the file, or 32 where the layout is for matrices of any size.

    Raises
    ------
    ArrayError
        When there is no such layout, or it is made for another matrix.
    SettingsError
        When the file is not a layout; with file and line.
    """
    path = layout_path(name_or_path)
    read = read_layout(path, rows, cols)
    places = np.argsort(read.taxels.ravel()).astype(np.uint16)
    for array in (read.taxels, read.patch_of, places):
        array.flags.writeable = False
    return Layout(
        name_or_path,
        read.taxels,
        places,
        *read.matrix,
        read.pitch_m,
        read.row_pitch_m,
        read.patches,
        read.patch_of,
        read.stood_on,
    )
