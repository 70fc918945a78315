# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Calibration of a method's uncertainty: its errors compared with its standard deviations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.kernels import kernel
from acts_core.skin import ForceResponse
from acts_recon.contacts import ContactFinder

ROWS = ("touched", "untouched", "x", "y", "force", "area", "spread")
"""Touched and untouched taxels, then quantities of the contact of all pressed taxels."""

SUMS = (len(ROWS), 4)
"""Shape of the sums: number, sum of (error / sigma)^2, and numbers within 1 and 2 sigma."""

_TOUCHED, _UNTOUCHED = range(2)

# Smaller errors are rounding [counts, m, N, m^2].
_TINY = 1e-9


class Calibration:
    """Compares images, and contacts computed from them, with the truth.

    Parameters
    ----------
    geometry : ArrayGeometry
    live : np.ndarray [shape=(rows, cols), dtype=bool]
        Only these taxels are scored.
    touch_counts : float
        A taxel above it is pressed.
    noise_counts : float
        Standard deviation of a reading, as the recovery of contacts is told it.
    """

    def __init__(
        self, geometry: ArrayGeometry, live: NDArray[np.bool_], touch_counts: float, noise_counts: float
    ) -> None:
        self._live = live.ravel()
        self._touch_counts = touch_counts
        self._finder = ContactFinder(geometry, ForceResponse(), touch_counts, noise_counts)

    def errors(
        self, image: NDArray[np.float32], sigma: NDArray[np.float32], truth: NDArray[np.float32]
    ) -> NDArray[np.float64]:
        """Sums of one image, to be added.

        Parameters
        ----------
        image, sigma, truth : np.ndarray [shape=(taxels,), dtype=float32]
            Estimate, its standard deviation and the truth [counts].

        Returns
        -------
        np.ndarray [shape=SUMS, dtype=float64]
        """
        sums = np.zeros(SUMS)
        add_errors(image, sigma, truth, self._live, self._touch_counts, sums)
        live_image, live_sigma, live_truth = (np.where(self._live, one, np.float32(0)) for one in (image, sigma, truth))
        true, found = self._finder.find(live_truth), self._finder.find(live_image, live_sigma)
        if true.in_contact and found.in_contact:
            of_contact = (
                (found.x_m - true.x_m, found.x_sd_m),
                (found.y_m - true.y_m, found.y_sd_m),
                (found.force_n - true.force_n, found.force_sd_n),
                (found.area_m2 - true.area_m2, found.area_sd_m2),
                (found.spread_m - true.spread_m, found.spread_sd_m),
            )
            for row, (error, deviation) in enumerate(of_contact, start=2):
                _add(abs(error), deviation, sums[row])
        return sums


@kernel
def _add(error: float, deviation: float, sums: NDArray[np.float64]) -> None:
    sums[0] += 1
    # A negligible error is 0 deviations, however small they are.
    if error > _TINY:
        sums[1] += (error / max(deviation, _TINY)) ** 2
    sums[2] += error <= max(deviation, _TINY)
    sums[3] += error <= max(2.0 * deviation, _TINY)


@kernel
def add_errors(
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    truth: NDArray[np.float32],
    live: NDArray[np.bool_],
    threshold: float,
    sums: NDArray[np.float64],
) -> None:
    """Add the errors of one image to the sums.

    Parameters
    ----------
    image, sigma, truth : np.ndarray [shape=(taxels,), dtype=float32]
        Estimate, its standard deviation and the truth [counts].
    live : np.ndarray [shape=(taxels,), dtype=bool]
        Only these count.
    threshold : float
        A taxel is touched where the truth is above half of it [counts].
    sums : np.ndarray [shape=SUMS, dtype=float64]
        Added to.
    """
    for t in range(image.size):
        if not live[t]:
            continue
        error = abs(np.float64(image[t]) - truth[t])
        _add(error, np.float64(sigma[t]), sums[_TOUCHED if truth[t] > 0.5 * threshold else _UNTOUCHED])


def summary(sums: NDArray[np.float64]) -> dict[str, Any] | None:
    """Summary for the report; None where nothing was added, as for methods without standard deviations."""
    if not sums[:, 0].any():
        return None
    return {name: _of(row) for name, row in zip(ROWS, sums.tolist(), strict=True)}


def _of(sums: list[float]) -> dict[str, float | None]:
    number, squares, within_1, within_2 = sums
    if not number:
        return {"ratio": None, "within_1": None, "within_2": None}
    return {"ratio": math.sqrt(squares / number), "within_1": within_1 / number, "within_2": within_2 / number}
