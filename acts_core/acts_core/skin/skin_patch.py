# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A patch: a piece of skin without a border in it, and where its taxels lie on the link that carries it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.transforms import Transform

T = TypeVar("T", bound=np.generic)

_AT_THE_ORIGIN = Transform()


@dataclass(frozen=True)
class SkinPatch:
    """A named rectangle of the picture: rows `first_row` to ``end_row - 1``, columns likewise.

    The frame of a patch is that of an `ArrayGeometry`: origin at its middle, x along the columns, y from the last row
    to the first, z out of the skin.

    Attributes
    ----------
    name : str
    first_row, end_row, first_col, end_col : int
    link : str
        The link that carries it; empty: the frame of the whole skin.
    pitch_m, row_pitch_m : float
        Distances of neighbouring columns and rows along the skin [m].
    pose : Transform
        Where the frame of the patch lies in that of the link.
    radius_m, row_radius_m : float
        Of the bend along a row and along a column, 0 where there is none [m]. Positive where the middle stands out:
        one of them makes a cylinder, both make a dome.
    """

    name: str
    first_row: int
    end_row: int
    first_col: int
    end_col: int
    link: str = ""
    pitch_m: float = ArrayGeometry().pitch_m
    row_pitch_m: float = ArrayGeometry().pitch_m
    pose: Transform = _AT_THE_ORIGIN
    radius_m: float = 0.0
    row_radius_m: float = 0.0

    @property
    def rows(self) -> int:
        """Rows of the patch."""
        return self.end_row - self.first_row

    @property
    def cols(self) -> int:
        """Columns of the patch."""
        return self.end_col - self.first_col

    @property
    def bounds(self) -> tuple[int, int, int, int]:
        """``first_row, end_row, first_col, end_col``, as kernels take them."""
        return self.first_row, self.end_row, self.first_col, self.end_col

    @cached_property
    def geometry(self) -> ArrayGeometry:
        """The patch as an array of its own, laid flat."""
        return ArrayGeometry(self.rows, self.cols, self.pitch_m, self.row_pitch_m)

    @property
    def origin_m(self) -> NDArray[np.float64]:
        """Middle of the patch in the link's frame; np.ndarray [shape=(3,), dtype=float64] [m]."""
        return np.array(self.pose.position_m)

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Axes of the patch in the link's frame; np.ndarray [shape=(3, 3), dtype=float64], columns x, y and z."""
        return self.pose.rotation()

    def points_m(self) -> NDArray[np.float64]:
        """Taxels in the link's frame; np.ndarray [shape=(rows, cols, 3), dtype=float64] [m]."""
        along, across = self._angles()
        x, y = np.meshgrid(self._x_m(), self._y_m())
        if self.radius_m:
            x = self.radius_m * np.sin(along)
        z = self.radius_m * (np.cos(along) - 1.0)
        if self.row_radius_m:
            y = (self.row_radius_m + z) * np.sin(across)
            z = (self.row_radius_m + z) * np.cos(across) - self.row_radius_m
        points_m = np.stack((x, y, z), axis=-1)
        return self.pose.points(points_m.reshape(-1, 3)).reshape(points_m.shape)

    def normals(self) -> NDArray[np.float64]:
        """Unit vectors out of the skin, in the link's frame; np.ndarray [shape=(rows, cols, 3), dtype=float64]."""
        along, across = self._angles()
        local = np.stack((np.sin(along), np.cos(along) * np.sin(across), np.cos(along) * np.cos(across)), axis=-1)
        return local @ self.rotation.T

    def of(self, picture: NDArray[T]) -> NDArray[T]:
        """This patch of a picture; a view of shape (end_row - first_row, end_col - first_col)."""
        return picture[self.first_row : self.end_row, self.first_col : self.end_col]

    def holds(self, row: int, col: int) -> bool:
        """Whether a place of the picture belongs to the patch."""
        return self.first_row <= row < self.end_row and self.first_col <= col < self.end_col

    def _x_m(self) -> NDArray[np.float64]:
        return self.geometry.x_m(np.arange(self.cols))

    def _y_m(self) -> NDArray[np.float64]:
        return self.geometry.y_m(np.arange(self.rows))

    def _angles(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """By how much the skin is turned at each taxel [rad], along the row and along the column."""
        along = self._x_m() / self.radius_m if self.radius_m else np.zeros(self.cols)
        across = self._y_m() / self.row_radius_m if self.row_radius_m else np.zeros(self.rows)
        first, second = np.meshgrid(along, across)
        return first, second
