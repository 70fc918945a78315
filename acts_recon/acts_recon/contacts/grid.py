# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the kernels of contacts know of an array, and from when on a taxel counts."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import Response, force_table
from acts_recon.images import Borders, borders_of, slope_table


class Grid(NamedTuple):
    """The taxels of an array: how they lie, where patches end, and what force a count is.

    Attributes
    ----------
    bounds : np.ndarray [shape=(rows * cols, 4), dtype=int32]
        See `acts_recon.images.borders.Borders`.
    cols : int
    force_n : np.ndarray [shape=(1025,), dtype=float64]
        The table of `acts_core.skin.force.force_table`, between two counts interpolated [N].
    slope_n : np.ndarray [shape=(1024,), dtype=float64]
        Its slope, see `acts_recon.images.uncertainty.slope_table` [N/count].
    pitch_m, pitch_y_m : float
        From a taxel to the next along x and along y.
    """

    bounds: NDArray[np.int32]
    cols: int
    force_n: NDArray[np.float64]
    slope_n: NDArray[np.float64]
    pitch_m: float
    pitch_y_m: float

    @classmethod
    def of(cls, geometry: ArrayGeometry, response: Response, borders: Borders | None = None) -> Grid:
        """Grid of an array; without `borders` it is one patch.

        Raises
        ------
        ArrayError
            When the borders are of a picture of another size.
        """
        borders = borders or borders_of(geometry.rows, geometry.cols)
        ends = borders.rectangles.max(axis=0, initial=0)
        if (ends[1], ends[3], borders.rectangle_of.size) != (geometry.rows, geometry.cols, geometry.size):
            raise ArrayError(
                f"borders of a picture of {ends[1]} x {ends[3]}: this one is {geometry.rows} x {geometry.cols}; take "
                "borders_of its layout"
            )
        force_n = force_table(response)
        return cls(
            bounds=borders.bounds(),
            cols=geometry.cols,
            force_n=force_n,
            slope_n=slope_table(force_n),
            pitch_m=geometry.pitch_m,
            pitch_y_m=geometry.pitch_y_m,
        )


class Thresholds(NamedTuple):
    """From when on a taxel counts.

    Attributes
    ----------
    touch_counts : float
        A taxel above it is pressed.
    noise_counts, together : float
        Standard deviations beyond the first are of guesses; so many guesses err together.
    """

    touch_counts: float
    noise_counts: float
    together: float
