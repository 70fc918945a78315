# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Rate of change of the skin as a whole, by which the sigma of taxels that were not measured since is inflated.

An object that comes down presses many taxels at once. A taxel that was not measured since still reads untouched, and
its own past does not show the change. The rate r at which other pressed taxels changed does:
``inflated sigma^2 = sigma^2 + (age r)^2``.

`RateOfChange` follows it over frames by `rate_of_change_kernels`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_recon.objects import rate_of_change_kernels as kernels

_KEPT = 0.6
"""Factor of the exponential average of the rate, per frame."""

_SHORTEST_S = 0.0005
_LONGEST_S = 1.0
"""Limits of the time between two measurements, and of the age of one [s]."""

_NOISE_COUNTS = 10.0
"""Smaller changes are noise."""


class RateOfChange:
    """Exponential average of the rate over frames, and the sigma it inflates; allocates nothing.

    Parameters
    ----------
    rows, cols : int
    touch_counts : float
        Above it a taxel is pressed.

    Attributes
    ----------
    rate_counts_per_s : float
        Root mean square of the rates of change of the taxels that are or were pressed, averaged over the last frames;
        0 without any.
    """

    def __init__(self, rows: int, cols: int, touch_counts: float) -> None:
        self._touch_counts = float(touch_counts)
        self._values = np.zeros(rows * cols, dtype=np.float32)
        self._ages_s = np.zeros(rows * cols, dtype=np.float32)
        self._inflated_sigma = np.zeros((rows, cols), dtype=np.float32)
        self.reset()

    def reset(self) -> None:
        """Start anew."""
        self._values.fill(0)
        self._ages_s.fill(_LONGEST_S)
        self.rate_counts_per_s = 0.0

    def step(
        self, image: NDArray[np.float32], sigma: NDArray[np.float32], age_s: NDArray[np.float32], period_s: float
    ) -> NDArray[np.float32]:
        """Update the rate by the next image, and inflate sigma.

        Parameters
        ----------
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts; measured taxels have their measured value.
        sigma : np.ndarray [shape=(rows, cols), dtype=float32]
            Standard deviation of each, from its own past [counts].
        age_s : np.ndarray [shape=(rows, cols), dtype=float32]
            Time since each was measured [s]; inf: never.
        period_s : float
            Time since the last image [s].

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=float32]
            Inflated sigma: standard deviation with what each taxel may have changed since it was measured [counts];
            overwritten by the next image.

        Raises
        ------
        ArrayError
            When there is a NaN, an infinite count or deviation, or a negative deviation or age. Everything is left as
            it was.
        """
        flat = image.ravel(), sigma.ravel(), age_s.ravel()
        if not kernels.possible(*flat):
            raise ArrayError(
                "image with NaN, infinite counts or sigma, or negative sigma or age_s: needed are the fields of one "
                "estimate (acts_recon.fusion.fusion)"
            )
        self.rate_counts_per_s = kernels.follow(
            *flat,
            period_s,
            self._touch_counts,
            _NOISE_COUNTS,
            _SHORTEST_S,
            _LONGEST_S,
            _KEPT,
            self.rate_counts_per_s,
            self._values,
            self._ages_s,
            self._inflated_sigma.ravel(),
        )
        return self._inflated_sigma
