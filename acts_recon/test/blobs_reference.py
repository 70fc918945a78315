# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference implementation of `acts_recon.contacts.blob_kernels.find_blobs`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from contact_reference import Variances, grown, variances
from numpy.typing import NDArray
from scipy import ndimage

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.skin import Response
from acts_recon.contacts import MAX_BLOBS, BlobConfig
from acts_recon.images import Borders, borders_of


@dataclass(frozen=True)
class Blob:
    """A contact in one image, without regard to the ones before.

    Attributes
    ----------
    taxels : np.ndarray [shape=(n,), dtype=intp]
        Its pressed taxels, row-major indices, growing; also those that only the hysteresis holds.
    active_taxels : int
        Those that count: above the touch threshold, or all where none is.
    x_m, y_m : float
        Centre of pressure [m].
    force_n, peak_counts : float
        Sum of forces [N], largest value [counts].
    moments_m2 : tuple of float
        Central second moments of the force, xx, xy and yy [m^2].
    x_var, y_var, force_var, taxels_var, spread_square_var : float
        Variances of position [m^2], force [N^2], number of taxels and square of the spread [m^4].
    patch : int
        Index of the rectangle that it lies in, see `acts_recon.images.borders.Borders`.
    """

    taxels: NDArray[np.intp]
    active_taxels: int
    x_m: float
    y_m: float
    force_n: float
    peak_counts: float
    moments_m2: tuple[float, float, float]
    x_var: float
    y_var: float
    force_var: float
    taxels_var: float
    spread_square_var: float
    patch: int = 0


def find_blobs(
    image: NDArray[np.floating],
    geometry: ArrayGeometry,
    response: Response,
    config: BlobConfig | None = None,
    *,
    sigma: NDArray[np.floating] | None = None,
    pressed_before: NDArray[np.bool_] | None = None,
    borders: Borders | None = None,
) -> list[Blob]:
    """Find the contacts in an image.

    A contact is a group of pressed taxels that touch along a side or at a corner. The strongest `MAX_BLOBS` are kept.
    Taxels that only the hysteresis holds join a contact together, but do not count in its numbers, so that these
    depend on the image alone; but where a contact has no others.

    `acts_recon.images.uncertainty` says how uncertain these are.

    Parameters
    ----------
    image : np.ndarray [shape=(rows, cols), dtype=float]
        Counts.
    geometry : ArrayGeometry
    response : Response
    config : BlobConfig, optional
    sigma : np.ndarray [shape=(rows, cols), dtype=float], optional
        Standard deviations of the taxels [counts]; without them variances are 0.
    pressed_before : np.ndarray [shape=(rows, cols), dtype=bool], optional
        Which taxels were pressed in the frame before, for the hysteresis.
    borders : Borders, optional
        No contact reaches over one.

    Returns
    -------
    list of Blob
        In the order of their first taxels.
    """
    borders = borders or borders_of(geometry.rows, geometry.cols)
    config = config or BlobConfig()
    before = np.zeros(image.shape, dtype=np.bool_) if pressed_before is None else pressed_before
    threshold = np.where(before, config.release_counts, config.touch_counts).astype(np.float64)
    pressed = image > threshold
    blobs = []
    for whole in _groups(pressed, borders):
        touched = whole & (image > config.touch_counts)
        inside = touched if touched.any() else whole
        least = float(config.touch_counts if touched.any() else config.release_counts)
        edge = grown(whole, borders) & (~pressed | whole) & ~inside
        row, col = np.nonzero(inside)
        x, y = geometry.x_m(col), geometry.y_m(row)
        counts = np.clip(image[inside], 0, COUNT_MAX).astype(np.float64)
        force = response.force_n(counts)
        total = float(force.sum())
        x_m, y_m = float(force @ x) / total, float(force @ y) / total
        moments = [
            float(force @ product) / total for product in ((x - x_m) ** 2, (x - x_m) * (y - y_m), (y - y_m) ** 2)
        ]
        unsure = Variances()
        if sigma is not None:
            unsure = variances(
                image, sigma, inside, edge, least, geometry, response, config.noise_counts, config.err_together
            )
        blobs.append(
            Blob(
                taxels=np.flatnonzero(whole),
                active_taxels=int(inside.sum()),
                x_m=x_m,
                y_m=y_m,
                force_n=total,
                peak_counts=float(counts.max()),
                moments_m2=(moments[0], moments[1], moments[2]),
                x_var=unsure.x,
                y_var=unsure.y,
                force_var=unsure.force,
                taxels_var=unsure.taxels,
                spread_square_var=unsure.spread_square,
                patch=int(borders.rectangle_of[np.flatnonzero(whole)[0]]),
            )
        )
    strongest = sorted(blobs, key=lambda blob: -blob.force_n)[:MAX_BLOBS]
    return [blob for blob in blobs if any(blob is kept for kept in strongest)]


def _groups(pressed: NDArray[np.bool_], borders: Borders) -> list[NDArray[np.bool_]]:
    """Groups of pressed taxels that touch along a side or at a corner, in the order of their first taxels."""
    groups = []
    for first_row, end_row, first_col, end_col in borders.rectangles.tolist():
        there = np.s_[first_row:end_row, first_col:end_col]
        if not pressed[there].any():
            continue
        labels, n_groups = ndimage.label(pressed[there], structure=np.ones((3, 3)))
        for group in range(1, n_groups + 1):
            whole = np.zeros_like(pressed)
            whole[there] = labels == group
            groups.append(whole)
    return sorted(groups, key=lambda whole: int(np.flatnonzero(whole)[0]))
