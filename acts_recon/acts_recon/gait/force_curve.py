# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From images of an insole to force and centre of pressure."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError

Array = NDArray[np.float64]


def force_and_centre(frames: NDArray[np.generic], length_m: float, width_m: float) -> tuple[Array, Array, Array]:
    """Force and centre of pressure of each frame.

    Parameters
    ----------
    frames : np.ndarray [shape=(n, rows, cols)]
        Rows across the foot, those of the toes first; numbers that grow with the force, as counts do.
    length_m, width_m : float
        Of the insole [m].

    Returns
    -------
    force : np.ndarray [shape=(n,), dtype=float64]
        Sum of each frame. Not a number where one of its numbers is none.
    x_m, y_m : np.ndarray [shape=(n,), dtype=float64]
        Centre across and along the foot, from the middle of the insole, y towards the toes; 0 without force [m].

    Raises
    ------
    ArrayError
        When the frames have another shape.
    """
    if frames.ndim != 3 or 0 in frames.shape[1:]:
        raise ArrayError(f"frames of shape {frames.shape}: needed is (n, rows, cols)")
    values = frames.astype(np.float64)
    rows, cols = values.shape[1:]
    force: Array = values.sum((1, 2))
    across = (np.arange(cols) - (cols - 1) / 2) * (width_m / cols)
    along = ((rows - 1) / 2 - np.arange(rows)) * (length_m / rows)
    whole = np.where(force == 0.0, 1.0, force)
    return force, values.sum(1) @ across / whole, values.sum(2) @ along / whole
