# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact in an image and its uncertainty in NumPy: reference implementation of `contact_kernels`.

`acts_recon.images.uncertainty` has the formulae.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, special

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.skin import Response, force_table
from acts_recon.contacts import Contact
from acts_recon.contacts.contact import NO_CONTACT
from acts_recon.images import ERR_TOGETHER, FAR, NOISE_COUNTS, Borders, borders_of, slope_table

_TINY_COUNTS = 1e-9


def find_contact(
    image: NDArray[np.floating],
    geometry: ArrayGeometry,
    response: Response,
    *,
    touch_counts: float = 60.0,
    sigma: NDArray[np.floating] | None = None,
    noise_counts: float = NOISE_COUNTS,
    err_together: float = ERR_TOGETHER,
    borders: Borders | None = None,
) -> Contact:
    """Describe the contact in an image.

    A taxel is pressed when its value is above `touch_counts`. Positions are weighted by force, not by counts as in the
    published analysis: counts saturate, which pulls their mean towards the lightly pressed side of an object that is
    not pressed evenly (docs/reconstruction.md has figures).

    Parameters
    ----------
    image : np.ndarray [shape=(rows, cols), dtype=float]
        Counts, finite.
    geometry : ArrayGeometry
    response : Response
        From counts to newtons.
    touch_counts : float
    sigma : np.ndarray [shape=(rows, cols), dtype=float], optional
        Standard deviations of the taxels [counts]; without them those of the contact are 0.
    noise_counts, err_together : float
        See `acts_recon.images.uncertainty`.
    borders : Borders, optional
        What lies behind one is not beside the contact.
    """
    pressed = image > touch_counts
    if not pressed.any():
        return NO_CONTACT
    row, col = np.nonzero(pressed)
    counts = image[pressed]
    x, y = geometry.x_m(col), geometry.y_m(row)
    weight = response.force_n(counts)
    total = float(weight.sum())
    x_m, y_m = float(weight @ x) / total, float(weight @ y) / total
    square = float(weight @ ((x - x_m) ** 2 + (y - y_m) ** 2)) / total
    unsure = Variances()
    if sigma is not None:
        edge = grown(pressed, borders or borders_of(*image.shape)) & ~pressed
        unsure = variances(image, sigma, pressed, edge, touch_counts, geometry, response, noise_counts, err_together)
    return Contact(
        in_contact=True,
        x_m=x_m,
        y_m=y_m,
        force_n=total,
        peak_counts=float(counts.max()),
        area_m2=row.size * geometry.taxel_area_m2,
        active_taxels=int(row.size),
        spread_m=float(np.sqrt(square)),
        x_sd_m=float(np.sqrt(unsure.x)),
        y_sd_m=float(np.sqrt(unsure.y)),
        force_sd_n=float(np.sqrt(unsure.force)),
        area_sd_m2=float(np.sqrt(unsure.taxels)) * geometry.taxel_area_m2,
        spread_sd_m=root_deviation(square, unsure.spread_square),
    )


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


def grown(mask: NDArray[np.bool_], borders: Borders) -> NDArray[np.bool_]:
    """A mask of taxels, shape (rows, cols), with the eight around each on the same side of all borders."""
    result = np.zeros_like(mask)
    for first_row, end_row, first_col, end_col in borders.rectangles.tolist():
        there = np.s_[first_row:end_row, first_col:end_col]
        if mask[there].any():
            result[there] = ndimage.binary_dilation(mask[there], structure=np.ones((3, 3)))
    return result
