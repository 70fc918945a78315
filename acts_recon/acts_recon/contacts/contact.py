# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact in a full tactile image: where, how hard, how large."""

from __future__ import annotations

from typing import NamedTuple


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
