# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact in a full tactile image: where, how hard, how large."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import Response
from acts_recon.images import (
    ERR_TOGETHER,
    NOISE_COUNTS,
    Borders,
    Variances,
    borders_of,
    grown,
    root_deviation,
    variances,
)


class Contact(NamedTuple):
    """A contact. Without one every number is 0; none is ever NaN.

    Positions are in the skin's frame (see `ArrayGeometry`). Standard deviations (``_sd_``) are 0 where the uncertainty
    of the image is not known.

    Attributes
    ----------
    in_contact : bool
        Whether at least one taxel is pressed.
    x_m, y_m : float
        Centre of pressure: mean position of the pressed taxels, weighted by force [m].
    force_n : float
        Sum of the forces on the pressed taxels [N].
    peak_counts : float
        Largest value of the image [counts].
    area_m2 : float
        Area of the pressed taxels [m^2].
    active_taxels : int
        Number of pressed taxels.
    spread_m : float
        Root mean square distance of the force from the centre of pressure [m].
    x_sd_m, y_sd_m, force_sd_n, area_sd_m2, spread_sd_m : float
        Standard deviations of what their names say.
    """

    in_contact: bool = False
    x_m: float = 0.0
    y_m: float = 0.0
    force_n: float = 0.0
    peak_counts: float = 0.0
    area_m2: float = 0.0
    active_taxels: int = 0
    spread_m: float = 0.0
    x_sd_m: float = 0.0
    y_sd_m: float = 0.0
    force_sd_n: float = 0.0
    area_sd_m2: float = 0.0
    spread_sd_m: float = 0.0


NO_CONTACT = Contact()


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

    The reference implementation of `acts_recon.contacts.contact_kernels.find_contact`.
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
