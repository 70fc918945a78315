# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images of a skin as panels: seen from outside, in millimetres from the middle."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from acts_core.array import ArrayGeometry
from acts_tools.figures.sheet import Panel, Picture


def skin_panel(
    title: str,
    values: ArrayLike,
    geometry: ArrayGeometry | None = None,
    *,
    unit: str = "counts",
    lowest: float = 0.0,
    highest: float,
    logarithmic: bool = False,
) -> Panel:
    """An image as a panel.

    Parameters
    ----------
    title : str
    values : array_like [size=rows * cols]
        Of the taxels, the first row at the top.
    geometry : ArrayGeometry, optional
        The paper's array by default.
    unit : str
        Of the values.
    lowest, highest : float
        Ends of the colour scale.
    logarithmic : bool
        Whether the colour scale is.
    """
    geometry = geometry or ArrayGeometry()
    image = np.asarray(values, dtype=float).reshape(geometry.rows, geometry.cols)
    half_x_mm = 500 * geometry.cols * geometry.pitch_m
    half_y_mm = 500 * geometry.rows * geometry.pitch_y_m
    picture = Picture(
        image.tolist(),
        unit,
        -half_x_mm,
        half_x_mm,
        -half_y_mm,
        half_y_mm,
        lowest=lowest,
        highest=highest,
        logarithmic=logarithmic,
    )
    return Panel(title, "x [mm]", "y [mm]", picture=picture, equal=True)
