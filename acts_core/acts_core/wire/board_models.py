# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Models for a board, ready to be uploaded: a patch dictionary to recover images, or an object library to classify."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from acts_core.array import MAX_SIDE
from acts_core.errors import ArrayError

MODEL_CAPACITY = 262_144
"""Bytes that a board holds."""

PATCH_SIDE_MAX = 8
"""Largest side of a patch that a board recovers, in taxels."""

OBJECTS_MAX = 64
"""Objects that a board tells apart at most."""

_FLOAT = np.dtype("<f4")
_COLUMNS_MAX = 0xFFFF


class ModelKind(IntEnum):
    """What a board holds; 0 is nothing."""

    NONE = 0
    PATCH_DICTIONARY = 1
    OBJECT_LIBRARY = 2


@dataclass(frozen=True)
class BoardModel:
    """A model as it is uploaded; made by `patch_dictionary` or `object_library`.

    Attributes
    ----------
    kind : ModelKind
        What it is.
    rows, columns : int
        Size of its matrix: pixels of a patch and atoms, or taxels of the array and library columns.
    patch_side, patch_step : int
        Side of a patch and distance between neighbouring ones in taxels; 0 for an object library.
    n_objects : int
        Number of objects; 0 for a patch dictionary.
    payload : bytes
        float32, little-endian, row-major; an object library's class numbers (uint8, one a column) follow.
    """

    kind: ModelKind
    rows: int
    columns: int
    patch_side: int
    patch_step: int
    n_objects: int
    payload: bytes

    @property
    def crc32(self) -> int:
        """Checksum of the payload."""
        return zlib.crc32(self.payload)


def patch_dictionary(atoms: ArrayLike, *, patch_step: int = 4) -> BoardModel:
    """A dictionary of square patches for a board.

    Parameters
    ----------
    atoms : array_like [shape=(pixels, n_atoms), dtype=float]
        One atom a column; pixels of a patch numbered as in `acts_recon.sparse.patches`.
    patch_step : int
        Distance between neighbouring patches in taxels, 1 to the patch's side.

    Raises
    ------
    ArrayError
        When the patch is not square, a value is not finite, or the whole does not fit a board.
    """
    matrix = _matrix("atoms", atoms)
    side = math.isqrt(matrix.shape[0])
    if side * side != matrix.shape[0] or side > PATCH_SIDE_MAX:
        raise ArrayError(
            f"atoms of {matrix.shape[0]} pixels: a patch is square, of 1 to {PATCH_SIDE_MAX} taxels a side"
        )
    if not 1 <= patch_step <= side:
        raise ArrayError(f"patch_step = {patch_step}: allowed is 1 to the patch's side, {side}")
    return _fitting(BoardModel(ModelKind.PATCH_DICTIONARY, *matrix.shape, side, patch_step, 0, matrix.tobytes()))


def object_library(columns: ArrayLike, objects: ArrayLike) -> BoardModel:
    """A library of known frames for a board.

    Parameters
    ----------
    columns : array_like [shape=(taxels, n_columns), dtype=float]
        One frame a column, of unit norm.
    objects : array_like [shape=(n_columns,), dtype=integer]
        Which object each column shows, 0 to 63; every number up to the largest occurs.

    Raises
    ------
    ArrayError
        When shapes or numbers do not fit, a value is not finite, or the whole does not fit a board.
    """
    matrix = _matrix("columns", columns)
    numbers = np.asarray(objects)
    if numbers.shape != (matrix.shape[1],) or numbers.dtype.kind not in "iu":
        raise ArrayError(
            f"objects of shape {numbers.shape} and type {numbers.dtype}: allowed is a whole number for each of the "
            f"{matrix.shape[1]} columns"
        )
    present = np.unique(numbers).tolist()
    if present != list(range(len(present))) or len(present) > OBJECTS_MAX:
        raise ArrayError(f"objects {present}: allowed are 0, 1, 2, ... up to {OBJECTS_MAX - 1}, none left out")
    if matrix.shape[0] > MAX_SIDE**2:
        raise ArrayError(f"columns of {matrix.shape[0]} taxels: an array has at most {MAX_SIDE**2}")
    payload = matrix.tobytes() + numbers.astype(np.uint8).tobytes()
    return _fitting(BoardModel(ModelKind.OBJECT_LIBRARY, *matrix.shape, 0, 0, len(present), payload))


def _matrix(name: str, values: ArrayLike) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    matrix = np.asarray(values)
    if matrix.ndim != 2 or 0 in matrix.shape or matrix.dtype.kind not in "fiu":
        raise ArrayError(f"{name} of shape {matrix.shape} and type {matrix.dtype}: allowed is a matrix of numbers")
    if matrix.shape[1] > _COLUMNS_MAX:
        raise ArrayError(f"{name}: {matrix.shape[1]} columns; allowed are up to {_COLUMNS_MAX}")
    with np.errstate(over="ignore"):  # what is too large for float32 is told below
        single = np.ascontiguousarray(matrix, dtype=_FLOAT)
    if not np.isfinite(single).all():
        raise ArrayError(f"{name}: holds values that are not finite in single precision")
    return single


def _fitting(model: BoardModel) -> BoardModel:
    if len(model.payload) > MODEL_CAPACITY:
        raise ArrayError(
            f"a model of {model.rows} x {model.columns} has {len(model.payload)} bytes; a board holds "
            f"{MODEL_CAPACITY}: use fewer columns (`acts library --presses`, `acts train --atoms`)"
        )
    return model
