# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact on one patch of a skin, as the reconstruction passes it to the reflexes of a hand."""

from __future__ import annotations

from typing import NamedTuple

Vector = tuple[float, float, float]

_ZERO: Vector = (0.0, 0.0, 0.0)


class RegionContact(NamedTuple):
    """The contact map of one patch at one moment. Without contact every number is 0; none is ever NaN.

    Attributes
    ----------
    name : str
        Of the patch in the skin's layout.
    link : str
        That carries the patch; `centre_m`, `normal` and `motion_m_s` are in its frame.
    active_taxels : int
        Pressed ones.
    force_n : float
        Total normal force [N].
    centre_m : tuple of float
        Centre of pressure [m].
    normal : tuple of float
        Unit vector out of the skin, at the centre.
    area_m2 : float
        Of the pressed taxels [m^2].
    peak_n : float
        Force on the most pressed taxel [N].
    spread_m : float
        Root mean square distance of the force from the centre [m].
    concentration : float
        `peak_n` over `force_n`: 1 where one taxel carries all of it.
    sharpness : float
        How much likelier a tip is than something blunt, as a natural logarithm; 0 where it is not likelier.
    motion_m_s : tuple of float
        Velocity of the pressure pattern along the skin [m/s]; 0 where it cannot be told from noise.
    slip_m : float
        How far the pattern has moved within the slip detector's window [m]; 0 where that does not count as motion.
    slipping : bool
    """

    name: str
    link: str
    active_taxels: int = 0
    force_n: float = 0.0
    centre_m: Vector = _ZERO
    normal: Vector = _ZERO
    area_m2: float = 0.0
    peak_n: float = 0.0
    spread_m: float = 0.0
    concentration: float = 0.0
    sharpness: float = 0.0
    motion_m_s: Vector = _ZERO
    slip_m: float = 0.0
    slipping: bool = False

    @property
    def in_contact(self) -> bool:
        """Whether at least one taxel is pressed."""
        return self.active_taxels > 0
