# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""First-order propagation of the taxels' variances to force, centre, spread and area of a contact.

This is the reference implementation; `uncertainty_kernels` is the same in numba.

A taxel of `c` counts, standard deviation `s` and force `f(c)` has two errors. A pressed one changes the force by
``f'(c) s``. With probability ``q = Phi(-abs(c - threshold) / s)`` a taxel is on the wrong side of its threshold: then
the force of a pressed one should be missing, and an untouched neighbour should be there with the threshold's force.
The variance of a taxel's force is ``e**2 = (f' s)**2 + q f**2``. Sums over the taxels give the variances of:

- force F: ``sum(e**2)``
- centre of pressure: ``sum(e**2 (x_taxel - x)**2) / F**2``
- square of the spread: ``sum(e**2 (r_taxel**2 - spread**2)**2) / F**2``
- number of taxels: ``sum(q)``

These formulae are for independent errors, as the noise of readings is. Errors of estimated taxels are correlated: a
contact that moved further than predicted is wrong at many taxels. So each term is multiplied by a factor between 1, for
``s <= noise_counts``, and `err_together`: ``together - (together - 1) noise**2 / s**2``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.skin import Response, force_table

NOISE_COUNTS = 2.0
"""Standard deviation of a reading where nobody has told it; what an image's is beyond it is that of a guess."""

LEAST_NOISE_COUNTS = 0.29
"""Smallest standard deviation of a reading: whole counts are rounded, ``1 / sqrt(12)``."""

ERR_TOGETHER = 5.0
"""Guesses that err together: as many as this are one independent error."""

FAR = 6.0
"""Standard deviations from the threshold beyond which q is taken as 0."""

_TINY_COUNTS = 1e-9


class Variances(NamedTuple):
    """Variances of a contact's centre of pressure [m^2], force [N^2], taxels and square of the spread [m^4]."""

    x: float = 0.0
    y: float = 0.0
    force: float = 0.0
    taxels: float = 0.0
    spread_square: float = 0.0


def variances(
    image: NDArray[np.floating],
    sigma: NDArray[np.floating],
    inside: NDArray[np.bool_],
    edge: NDArray[np.bool_],
    least: float,
    geometry: ArrayGeometry,
    response: Response,
    noise_counts: float,
    err_together: float,
) -> Variances:
    """Variances of the contact that is made of the taxels `inside`.

    Parameters
    ----------
    image, sigma : np.ndarray [shape=(rows, cols), dtype=float]
        Counts, and their standard deviations.
    inside, edge : np.ndarray [shape=(rows, cols), dtype=bool]
        The taxels that count, at least one, and those around that do not.
    least : float
        Threshold between the two [counts].
    geometry : ArrayGeometry
    response : Response
    noise_counts, err_together : float
        See above.
    """
    # Here: half the time a node takes to start would go by importing it, and nodes use the kernels.
    from scipy import special

    counts = np.clip(image, 0, COUNT_MAX).astype(np.float64)
    sigma = sigma.astype(np.float64)
    table = force_table(response)
    # What reads 0 is pressed by 0 N, but what is above a threshold of 0 by more than the force that reads nothing.
    force = np.where(inside, response.force_n(counts), float(response.force_n(least)) if least > 0 else table[0])
    slopes = slope_table(table)[counts.astype(np.intp)]
    unsure = (inside | edge) & (np.abs(counts - least) <= FAR * sigma) & (sigma > 0)
    wrong = np.zeros(image.shape)
    with np.errstate(over="ignore"):  # a sigma of next to nothing: infinitely far, and rightly so
        wrong[unsure] = special.ndtr(-np.abs(counts[unsure] - least) / sigma[unsure])
    square = wrong * force**2 + np.where(inside, (slopes * sigma) ** 2, 0.0)
    guessed = np.maximum(sigma / max(noise_counts, _TINY_COUNTS), 1.0)
    factor = err_together - (err_together - 1.0) / guessed**2
    square *= factor
    wrong *= factor

    x, y = geometry.x_m(np.arange(geometry.cols))[None, :], geometry.y_m(np.arange(geometry.rows))[:, None]
    weight = np.where(inside, force, 0.0)
    total = float(weight.sum())
    away = (x - (weight * x).sum() / total) ** 2, (y - (weight * y).sum() / total) ** 2
    apart = away[0] + away[1]
    spread_square = (weight * apart).sum() / total
    return Variances(
        x=float((square * away[0]).sum()) / total**2,
        y=float((square * away[1]).sum()) / total**2,
        force=float(square.sum()),
        taxels=float(wrong.sum()),
        spread_square=float((square * (apart - spread_square) ** 2).sum()) / total**2,
    )


def root_deviation(square: float, variance: float) -> float:
    """Standard deviation of a root whose square has this variance; also where the square is next to 0."""
    return math.sqrt(square + math.sqrt(variance)) - math.sqrt(square)


def slope_table(force_n: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope of a force table; where the table ends flat because the taxel is saturated, the last slope before.

    Parameters
    ----------
    force_n : np.ndarray [shape=(1025,), dtype=float64]
        See `acts_core.skin.force.force_table`.

    Returns
    -------
    np.ndarray [shape=(1024,), dtype=float64]
        Newtons a count, between each count and the next.
    """
    slope = np.diff(force_n)
    rising = np.flatnonzero(slope > 0)
    if rising.size:
        # The table may end within the last step that rises, which then is too flat.
        slope[rising[-1] :] = slope[rising[-2:]].max()
    return slope
