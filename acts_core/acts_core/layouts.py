"""Layouts: how the taxels of the readout matrix lie on the skin.

The board reads a matrix of rows and columns of wires. On a square pad the matrix is the picture. On the paper's insole
and glove the same 32 x 32 wires run otherwise: a layout says which taxel of the matrix lies at which place of the
picture. Samples, and everything before the recovery, stay in matrix indices; images and contacts are the picture's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError

_SIDE = 32
_SQUARE_PITCH_M = ArrayGeometry().pitch_m


@dataclass(frozen=True)
class Part:
    """A named rectangle of the picture: rows `first_row` to ``end_row - 1``, columns likewise."""

    name: str
    first_row: int
    end_row: int
    first_col: int
    end_col: int

    def of(self, picture: NDArray[np.generic]) -> NDArray[np.generic]:
        """This part of a picture; a view of shape (end_row - first_row, end_col - first_col)."""
        return picture[self.first_row : self.end_row, self.first_col : self.end_col]

    def holds(self, row: int, col: int) -> bool:
        """Whether a place of the picture belongs to the part."""
        return self.first_row <= row < self.end_row and self.first_col <= col < self.end_col


@dataclass(frozen=True)
class Layout:
    """A permutation of the matrix' taxels into a picture.

    Attributes
    ----------
    name : str
    taxels : np.ndarray [shape=(rows, cols), dtype=uint16, read-only]
        Matrix index (row-major) of the taxel at each place of the picture.
    places : np.ndarray [shape=(rows * cols,), dtype=uint16, read-only]
        The inverse: place in the picture (row-major) of each taxel of the matrix.
    matrix_rows, matrix_cols : int
        Size of the matrix.
    pitch_m, row_pitch_m : float
        Distances of neighbouring columns and rows of the picture on the paper's skin of this layout [m].
    parts : tuple of Part
        Together they cover the picture, none twice.
    """

    name: str
    taxels: NDArray[np.uint16]
    places: NDArray[np.uint16]
    matrix_rows: int
    matrix_cols: int
    pitch_m: float
    row_pitch_m: float
    parts: tuple[Part, ...]

    @property
    def rows(self) -> int:
        """Rows of the picture."""
        return int(self.taxels.shape[0])

    @property
    def cols(self) -> int:
        """Columns of the picture."""
        return int(self.taxels.shape[1])

    def picture(self, matrix: ArrayLike) -> NDArray[np.generic]:
        """Values by matrix taxel, shape (matrix_rows, matrix_cols), as a picture, shape (rows, cols)."""
        values = np.asarray(matrix)
        self._check(values.shape, (self.matrix_rows, self.matrix_cols), "matrix")
        return values.ravel()[self.taxels]

    def matrix(self, picture: ArrayLike) -> NDArray[np.generic]:
        """The inverse of `picture`."""
        values = np.asarray(picture)
        self._check(values.shape, (self.rows, self.cols), "picture")
        return values.ravel()[self.places].reshape(self.matrix_rows, self.matrix_cols)

    def geometry(self, pitch_m: float = 0.0, row_pitch_m: float = 0.0) -> ArrayGeometry:
        """The picture's geometry.

        Parameters
        ----------
        pitch_m, row_pitch_m : float
            Distances of neighbouring columns and rows [m]. Without the second it is the first; without both they are
            those of the paper's skin.
        """
        if not pitch_m:
            return ArrayGeometry(self.rows, self.cols, self.pitch_m, row_pitch_m or self.row_pitch_m)
        return ArrayGeometry(self.rows, self.cols, pitch_m, row_pitch_m or pitch_m)

    def part(self, row: int, col: int) -> Part:
        """The part that holds a place of the picture."""
        for part in self.parts:
            if part.holds(row, col):
                return part
        raise ArrayError(f"place ({row}, {col}): the layout {self.name} has {self.rows} rows and {self.cols} columns")

    def _check(self, given: tuple[int, ...], wanted: tuple[int, ...], what: str) -> None:
        if given != wanted:
            raise ArrayError(f"{what} of shape {given}: the layout {self.name} has {wanted}")


def _insole(matrix: NDArray[np.uint16]) -> NDArray[np.uint16]:
    picture = matrix.reshape((64, 16), order="F")
    picture[:32] = picture[:32][::-1].copy()
    return np.rot90(picture, 2)


def _glove(matrix: NDArray[np.uint16]) -> NDArray[np.uint16]:
    return np.rot90(matrix.reshape(_SIDE, _SIDE))


_FINGERS = ("index", "middle", "ring", "little")
_GLOVE_PARTS = (
    Part("palm", 16, 32, 8, 32),
    Part("thumb", 16, 32, 0, 8),
    *(Part(name, 0, 16, 8 * i, 8 * i + 8) for i, name in enumerate(_FINGERS)),
)

# Picture of the row-major matrix, size of the paper's skin across and along the picture [m] (Fig. S10-2), parts.
_SHAPES: dict[str, tuple[Callable[[NDArray[np.uint16]], NDArray[np.uint16]], float, float, tuple[Part, ...]]] = {
    "insole": (_insole, 0.085, 0.280, (Part("sole", 0, 64, 0, 16),)),
    "glove": (_glove, 0.180, 0.230, _GLOVE_PARTS),
}

LAYOUTS = ("square", *_SHAPES)
"""Names of the layouts; ``square`` is the matrix itself, of any size."""


def layout(name: str, rows: int = _SIDE, cols: int = _SIDE) -> Layout:
    """A layout of a matrix.

    Parameters
    ----------
    name : str
        One of `LAYOUTS`: ``square``, the matrix as it is; ``insole``, 64 x 16; ``glove``, 32 x 32 turned, with the
        parts palm, thumb, index, middle, ring and little. The last two are the authors' (their published analysis).
    rows, cols : int
        Size of the matrix; insole and glove are made of 32 x 32.

    Raises
    ------
    ArrayError
        When there is no such layout, or none of this matrix.
    """
    if name not in LAYOUTS:
        raise ArrayError(f"layout {name!r}: allowed is one of {', '.join(LAYOUTS)}")
    ArrayGeometry(rows, cols)  # refuses sizes that are none
    matrix = np.arange(rows * cols, dtype=np.uint16)
    pitch_m = row_pitch_m = _SQUARE_PITCH_M
    if name == "square":
        taxels = matrix.reshape(rows, cols)
        parts: tuple[Part, ...] = (Part("pad", 0, rows, 0, cols),)
    else:
        if (rows, cols) != (_SIDE, _SIDE):
            raise ArrayError(
                f"layout {name} of a matrix of {rows} x {cols}: it is made of {_SIDE} x {_SIDE}; use square"
            )
        arrange, width_m, height_m, parts = _SHAPES[name]
        taxels = np.ascontiguousarray(arrange(matrix))
        pitch_m, row_pitch_m = width_m / taxels.shape[1], height_m / taxels.shape[0]
    places = np.argsort(taxels.ravel()).astype(np.uint16)
    taxels.flags.writeable = False
    places.flags.writeable = False
    return Layout(name, taxels, places, rows, cols, pitch_m, row_pitch_m, parts)
