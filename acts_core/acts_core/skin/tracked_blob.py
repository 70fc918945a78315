# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One of the contacts on a skin, followed from image to image."""

from __future__ import annotations

from typing import NamedTuple


class TrackedBlob(NamedTuple):
    """A contact with a number; positions are in the skin's frame (see `ArrayGeometry`). None of it is ever NaN.

    Standard deviations (``_sd_``) are 0 where the uncertainty of the image is not known.

    Attributes
    ----------
    number : int
        Which contact this is; from 1.
    merged : int
        Number of other tracks merged into it.
    age_s : float
        Since it began [s].
    x_m, y_m : float
        Centre of pressure: mean position of its taxels, weighted by force [m].
    vx_m_s, vy_m_s : float
        Velocity of the centre of pressure [m/s].
    force_n : float
        Sum of the forces on its taxels [N].
    peak_counts : float
        Its largest value [counts].
    area_m2 : float
        Area of its taxels [m^2].
    active_taxels : int
    spread_m : float
        Root mean square distance of the force from the centre of pressure [m].
    angle_rad : float
        Direction of the longest extent, from x towards y, above -pi/2 to pi/2; 0 where it has none.
    x_sd_m, y_sd_m, vx_sd_m_s, vy_sd_m_s, force_sd_n, area_sd_m2, spread_sd_m : float
        Standard deviations of what their names say.
    """

    number: int
    merged: int
    age_s: float
    x_m: float
    y_m: float
    vx_m_s: float
    vy_m_s: float
    force_n: float
    peak_counts: float
    area_m2: float
    active_taxels: int
    spread_m: float
    angle_rad: float
    x_sd_m: float
    y_sd_m: float
    vx_sd_m_s: float
    vy_sd_m_s: float
    force_sd_n: float
    area_sd_m2: float
    spread_sd_m: float
