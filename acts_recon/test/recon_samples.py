"""Frames with a contact, and samples of them, for the tests of this folder."""

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import adaptive, measure_in


def bump(
    geometry: ArrayGeometry, row: float, col: float, *, width: float = 1.5, peak: float = 700
) -> NDArray[np.uint16]:
    """A round contact; counts (rows, cols)."""
    r, c = np.indices((geometry.rows, geometry.cols))
    return np.rint(peak * np.exp(-((r - row) ** 2 + (c - col) ** 2) / (2 * width**2))).astype(np.uint16)


def sample(frame: NDArray[np.uint16], m: int) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
    """Adaptive samples of a frame."""
    return adaptive(measure_in(frame), *frame.shape, m, threshold_counts=60)
