# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Uniform sampling: a grid that moves from frame to frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.sampling.basis import CommonSettings, Measure, Samples, SamplingScheme, SkinMap


class Uniform(SamplingScheme):
    """The frames of `uniform`, one after the other."""

    name = "uniform"
    number = 1
    description = "a grid that moves from frame to frame"

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        super().__init__(config, skin_map)
        self._frame = 0

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        indices = uniform(self.config.rows, self.config.cols, self.config.m, self._frame)
        self._frame += 1
        return self.measured(measure, indices)

    @classmethod
    def check_m(cls, rows: int, cols: int, m: int) -> None:
        """Refuse what is no grid, see `uniform_spacing`."""
        uniform_spacing(rows, cols, m)


def uniform_spacing(rows: int, cols: int, m: int) -> tuple[int, int]:
    """Spacing of rows and columns of a uniform grid of `m` taxels.

    The grid of spacing ``(s, t)`` has ``ceil(rows / s) * ceil(cols / t)`` taxels. Of all that have `m`, the one with
    the most equal spacings is taken, the larger one along the rows. On 32 x 32 that is the published table.

    Raises
    ------
    SettingsError
        When no grid of this array has `m` taxels; names the nearest that exist.
    """
    found = _spacing(rows, cols, m)
    if found is None:
        # One taxel and all taxels are grids of every array.
        fewer, more = range(min(m - 1, rows * cols), 0, -1), range(max(m + 1, 1), rows * cols + 1)
        below = next((other for other in fewer if _spacing(rows, cols, other) is not None), 1)
        above = next((other for other in more if _spacing(rows, cols, other) is not None), rows * cols)
        raise SettingsError(
            f"m = {m}: no uniform grid of {rows} x {cols} has so many taxels; the nearest have {below} and {above}"
        )
    return found


def _spacing(rows: int, cols: int, m: int) -> tuple[int, int] | None:
    best: tuple[int, int] | None = None
    for grid_rows in range(1, rows + 1):
        grid_cols, rest = divmod(m, grid_rows)
        if rest or not 1 <= grid_cols <= cols:
            continue
        s, t = -(-rows // grid_rows), -(-cols // grid_cols)
        if -(-rows // s) != grid_rows or -(-cols // t) != grid_cols:
            continue
        # Ratio of the larger to the smaller spacing, compared without division.
        if best is None or (max(s, t) * min(best), s < t) < (max(best) * min(s, t), best[0] < best[1]):
            best = (s, t)
    return best


def uniform(rows: int, cols: int, m: int, frame: int) -> NDArray[np.uint16]:
    """Taxels of the `frame`-th uniform frame, row by row.

    The grid moves by one column a frame and, when it has been through the columns, by one row, so that after
    ``s * t`` frames every taxel was seen. Where the moved grid's last row or column falls off the array, the array's
    last row or column is taken instead, as by the authors' program: every frame has `m` taxels.

    Returns
    -------
    np.ndarray [shape=(m,), dtype=uint16]
    """
    s, t = uniform_spacing(rows, cols, m)
    first_row, first_col = divmod(frame % (s * t), t)
    grid_rows = np.minimum(np.arange(first_row, first_row + rows, s)[: -(-rows // s)], rows - 1)
    grid_cols = np.minimum(np.arange(first_col, first_col + cols, t)[: -(-cols // t)], cols - 1)
    return (grid_rows[:, None] * cols + grid_cols).astype(np.uint16).ravel()
