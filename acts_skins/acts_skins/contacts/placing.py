# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Transform contacts from a skin's frame to the robot's. Does not depend on ROS."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.transforms import Transform, Vector

# Numbers of contacts have 32 bits; the limit is larger than any measurement, and its square is finite.
_LARGEST = 2.0**32


@dataclass(frozen=True)
class Touch:
    """One contact in the skin's frame; the fields are those of acts_msgs/TrackedContact, in SI units."""

    number: int
    age_s: float
    position_m: Vector
    velocity_m_s: Vector
    force_n: float
    peak_counts: float
    area_m2: float
    active_taxels: int
    spread_m: float
    position_sd_m: Vector
    velocity_sd_m_s: Vector
    force_sd_n: float
    area_sd_m2: float
    spread_sd_m: float

    def can_be(self) -> bool:
        """Whether all numbers are possible for a skin; NaN is not."""
        numbers = (number for value in astuple(self) for number in (value if isinstance(value, tuple) else (value,)))
        return all(abs(number) <= _LARGEST for number in numbers)


@dataclass(frozen=True)
class PlacedTouch:
    """A contact in the robot's frame.

    Attributes
    ----------
    position_m, velocity_m_s : tuple of float
        Centre of pressure and its velocity along the skin, in the robot's frame.
    normal : tuple of float
        Unit vector out of the skin.
    force_n : tuple of float
        Force on the robot [N].
    position_sd_m, velocity_sd_m_s : tuple of float
        Standard deviations along the axes of the robot's frame.
    touch : Touch
        The contact in the skin's frame.
    """

    position_m: Vector
    velocity_m_s: Vector
    normal: Vector
    force_n: Vector
    position_sd_m: Vector
    velocity_sd_m_s: Vector
    touch: Touch


class Placement:
    """Position and orientation of a skin on the robot.

    Parameters
    ----------
    transform : Transform
        From the skin's frame to the robot's.
    """

    def __init__(self, transform: Transform) -> None:
        self._rotation = transform.rotation()
        self._squares = self._rotation**2
        self._origin_m = np.asarray(transform.position_m)
        self.normal = _vector(self._rotation[:, 2])

    def place(self, touch: Touch) -> PlacedTouch:
        """Transform a contact of the skin to the robot's frame."""
        # Errors along the skin's axes are independent: the variances are diag(R S R') with S diagonal.
        deviations = np.sqrt(np.array([touch.position_sd_m, touch.velocity_sd_m_s]) ** 2 @ self._squares.T)
        return PlacedTouch(
            position_m=_vector(self._rotation @ np.asarray(touch.position_m) + self._origin_m),
            velocity_m_s=_vector(self._rotation @ np.asarray(touch.velocity_m_s)),
            normal=self.normal,
            force_n=_vector(-touch.force_n * self._rotation[:, 2]),
            position_sd_m=_vector(deviations[0]),
            velocity_sd_m_s=_vector(deviations[1]),
            touch=touch,
        )


def _vector(values: NDArray[np.float64]) -> Vector:
    x, y, z = values.tolist()
    return x, y, z
