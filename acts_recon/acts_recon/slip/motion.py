# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tangential motion of a contact between two images of the same patch, by the method of Lucas and Kanade (1981).

The pattern of pressure is modelled as that of the reference, shifted by d, with its force scaled by g and its width by
1 + s about its centre c. To first order::

    image - reference = (g - 1) reference - d . grad - s (r - c) . grad

This is solved by least squares over all taxels; `grad` is the gradient of the two images' mean. Force and width are
unknowns, too, because a grip that tightens changes both, and neither is slip.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_recon.slip.motion_kernels import normal_equations, solve

# Ridge term: a pattern without gradient, such as equal pressure all over, has no motion.
RIDGE = 1e-6

SMALLEST_SIDE = 3
"""Of a patch, in taxels."""


class Motion(NamedTuple):
    """From the reference to the image.

    Attributes
    ----------
    cols, rows : float
        Shift along the columns and along the rows, towards higher numbers [taxels].
    sd_taxels : float
        Standard deviation of the shift, from the residual of the least squares and the noise [taxels].
    gain : float
        Force relative to the reference.
    growth : float
        Relative change of the width.
    """

    cols: float
    rows: float
    sd_taxels: float
    gain: float
    growth: float

    @property
    def distance_taxels(self) -> float:
        """Length of the shift."""
        return math.hypot(self.cols, self.rows)


class MotionEstimator:
    """Estimates the motion on patches of one size.

    Parameters
    ----------
    rows, cols : int
        Size of the patch, at least 3 by 3.
    noise_counts : float
        Standard deviation of a taxel of the images [counts].

    Raises
    ------
    ArrayError
        For a smaller patch, or noise that is not above 0.
    """

    def __init__(self, rows: int, cols: int, noise_counts: float = 1.5) -> None:
        if min(rows, cols) < SMALLEST_SIDE:
            raise ArrayError(
                f"a patch of {rows} x {cols} taxels: motion is seen on {SMALLEST_SIDE} x {SMALLEST_SIDE} and more"
            )
        if not noise_counts > 0.0:
            raise ArrayError(f"noise_counts = {noise_counts}: allowed is a number above 0")
        self._shape = (rows, cols)
        self._noise = noise_counts
        self._matrix = np.zeros((4, 5))
        self._inverse = np.zeros((4, 4))

    def between(self, reference: NDArray[np.float32], image: NDArray[np.float32]) -> Motion | None:
        """The motion from one image to another.

        Parameters
        ----------
        reference, image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts above the baseline, finite.

        Returns
        -------
        Motion or None
            None where nothing presses.

        Raises
        ------
        ArrayError
            When one has another shape or type.
        """
        for given in (reference, image):
            if given.shape != self._shape or given.dtype != np.float32:
                raise ArrayError(
                    f"an image of shape {given.shape}, {given.dtype}: needed is {self._shape}, float32 (counts)"
                )
        squares, count = normal_equations(reference, image, self._matrix)
        if not count:
            return None
        return Motion(*solve(self._matrix, self._inverse, squares, count, self._noise, RIDGE))
