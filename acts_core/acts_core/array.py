# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Geometry of a tactile array: which index is which taxel, and where it lies on the skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.errors import ArrayError

MAX_SIDE = 64
"""Largest number of rows or columns; the wire format and the firmware are sized for it."""

COUNT_MAX = 1023
"""Largest ADC count: the board reads 10 bit."""

TOUCH_COUNTS = 60
"""A taxel above is pressed where nothing else is said, as in the paper's recognition of objects [counts]."""


@dataclass(frozen=True)
class ArrayGeometry:
    """A rectangular array of taxels.

    The index of a taxel is ``row * cols + col``, row-major in image coordinates: row 0 is the top of the picture,
    seen from outside the skin. The skin's frame is right-handed with its origin at the pad's centre: x points along
    the columns (to the right), y from the last row to the first (up in the picture), z out of the skin.

    Attributes
    ----------
    rows, cols : int
        1 to 64.
    pitch_m : float
        Distance between neighbouring columns, and rows where nothing else is said [m]. The default is the paper's
        original array, 140 mm for 32 taxels (Fig. S10-2).
    row_pitch_m : float, optional
        Distance between neighbouring rows where it is another [m].
    """

    rows: int = 32
    cols: int = 32
    pitch_m: float = 0.140 / 32
    row_pitch_m: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("rows", self.rows), ("cols", self.cols)):
            # A caller without types may give 8.0, which no index can be made of.
            if not isinstance(value, (int, np.integer)) or not 1 <= value <= MAX_SIDE:
                raise ArrayError(f"{name} = {value}: an array has 1 to {MAX_SIDE} {name}, a whole number")
        for name, pitch_m in (("pitch_m", self.pitch_m), ("row_pitch_m", self.pitch_y_m)):
            if not (np.isfinite(pitch_m) and pitch_m > 0):
                raise ArrayError(f"{name} = {pitch_m}: the pitch is a positive number of metres")

    @property
    def size(self) -> int:
        """Number of taxels."""
        return self.rows * self.cols

    @property
    def pitch_y_m(self) -> float:
        """Distance between neighbouring rows [m]."""
        return self.pitch_m if self.row_pitch_m is None else self.row_pitch_m

    @property
    def taxel_area_m2(self) -> float:
        """Area that one taxel stands for [m^2]."""
        return self.pitch_m * self.pitch_y_m

    def x_m(self, col: ArrayLike) -> NDArray[np.float64]:
        """x of a column, which may be fractional [m]; same shape as `col`."""
        return (np.asarray(col, dtype=np.float64) - (self.cols - 1) / 2) * self.pitch_m

    def y_m(self, row: ArrayLike) -> NDArray[np.float64]:
        """y of a row, which may be fractional [m]; same shape as `row`."""
        return ((self.rows - 1) / 2 - np.asarray(row, dtype=np.float64)) * self.pitch_y_m

    def col_of(self, x_m: ArrayLike) -> NDArray[np.float64]:
        """Fractional column of an x [m]; same shape as `x_m`."""
        return np.asarray(x_m, dtype=np.float64) / self.pitch_m + (self.cols - 1) / 2

    def row_of(self, y_m: ArrayLike) -> NDArray[np.float64]:
        """Fractional row of a y [m]; same shape as `y_m`."""
        return (self.rows - 1) / 2 - np.asarray(y_m, dtype=np.float64) / self.pitch_y_m


def check_untouched(name: str, counts: NDArray[np.float32], valid: NDArray[np.bool_], size: int) -> None:
    """Refuse what no board can read of untouched taxels.

    Parameters
    ----------
    name : str
        What it is, for the message: baseline or noise.
    counts : np.ndarray [shape=(size,), dtype=float32]
    valid : np.ndarray [shape=(size,), dtype=bool]
        Where `counts` is known.
    size : int
        Number of taxels.

    Raises
    ------
    ArrayError
        For another size, what are no arrays of numbers and of bool, or values beyond those of counts.
    """
    for what, values, kinds in ((name, counts, "fiu"), ("valid", valid, "b")):
        # Lists come from callers without types.
        if not isinstance(values, np.ndarray) or values.dtype.kind not in kinds:
            given = values.dtype if isinstance(values, np.ndarray) else type(values).__name__
            needed = "bool" if kinds == "b" else "float32"
            raise ArrayError(f"{what} is {given}: needed is an array of numpy, of {needed}")
    if counts.shape != (size,) or valid.shape != (size,):
        raise ArrayError(f"{name} {counts.shape} and valid {valid.shape}: needed are {size} values of each")
    known = counts[valid]
    # Written so that NaN fails, too.
    if not ((known >= 0).all() and (known <= COUNT_MAX).all()):
        raise ArrayError(f"the {name} has values that are not within 0 to {COUNT_MAX} counts")
