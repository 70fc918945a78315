# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Soft objects of the paper's figure 6: how large the contact is at a depth, and how the pressure lies in it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from acts_core.registry import named

Array = NDArray[np.float64]

_CORNERS = 180
"""Of an outline."""


class Body(ABC):
    """A soft object that comes down along z, and the skin under it.

    Attributes
    ----------
    name : str
    touch_s : float
        How long it touches [s].
    depth_m : float
        Deepest, about [m].
    """

    name: ClassVar[str]
    touch_s: ClassVar[float]
    depth_m: ClassVar[float]

    @abstractmethod
    def outline_m(self, depth_m: float) -> Array:
        """Corners of the contact's edge around the place where it first touches [m]; shape (n, 2), not closed."""

    @abstractmethod
    def pressure_pa(self, x_m: Array, y_m: Array, depth_m: float) -> Array:
        """Pressure at points around that place [Pa]; 0 outside of the edge."""


@dataclass(frozen=True)
class RoundBody(Body):
    """What touches on a disc whose radius grows with the root of the depth."""

    @abstractmethod
    def radius_m(self, depth_m: float) -> float:
        """Of the disc [m]."""

    def outline_m(self, depth_m: float) -> Array:
        """See `Body`."""
        angle = 2 * np.pi * np.arange(_CORNERS) / _CORNERS
        return self.radius_m(depth_m) * np.column_stack((np.cos(angle), np.sin(angle)))


@dataclass(frozen=True)
class TennisBall(RoundBody):
    """A ball of rubber and felt: Hertz's disc and pressure, as in `acts_sim.impacts`."""

    name: ClassVar[str] = "tennis"
    touch_s: ClassVar[float] = 0.008
    depth_m: ClassVar[float] = 0.009
    ball_radius_m: float = 0.0335
    stiffness_n_per_m15: float = 89.6e3

    def radius_m(self, depth_m: float) -> float:
        """See `RoundBody`."""
        return float(np.sqrt(self.ball_radius_m * depth_m))

    def pressure_pa(self, x_m: Array, y_m: Array, depth_m: float) -> Array:
        """See `Body`."""
        square_m2 = self.ball_radius_m * depth_m
        top_pa = 1.5 * self.stiffness_n_per_m15 * depth_m**1.5 / (np.pi * square_m2)
        pressure: Array = top_pa * np.sqrt(np.maximum(1.0 - (x_m**2 + y_m**2) / square_m2, 0.0))
        return pressure


@dataclass(frozen=True)
class Balloon(RoundBody):
    """A thin skin full of air: what touches is flat, and presses with the pressure of the air."""

    name: ClassVar[str] = "balloon"
    touch_s: ClassVar[float] = 0.030
    depth_m: ClassVar[float] = 0.008
    balloon_radius_m: float = 0.11
    air_pa: float = 4000.0

    def radius_m(self, depth_m: float) -> float:
        """See `RoundBody`."""
        return float(np.sqrt(max(2 * self.balloon_radius_m * depth_m - depth_m**2, 0.0)))

    def pressure_pa(self, x_m: Array, y_m: Array, depth_m: float) -> Array:
        """See `Body`."""
        pressure: Array = np.where(np.hypot(x_m, y_m) <= self.radius_m(depth_m), self.air_pa, 0.0)
        return pressure


@dataclass(frozen=True)
class SiliconeBlock(Body):
    """A cube that lands on a corner, and not straight: a triangle with unequal sides that grows with the depth.

    The pressure is that of a cone on an elastic ground (Sneddon), over triangles instead of circles.
    """

    name: ClassVar[str] = "block"
    touch_s: ClassVar[float] = 0.010
    depth_m: ClassVar[float] = 0.016
    modulus_pa: float = 60e3
    down: tuple[float, float, float] = (0.75, 0.50, 0.43)
    """The way down in the cube's own frame, its three edges at the corner; about of length 1."""

    def _sides(self) -> tuple[Array, Array]:
        """Directions across the triangle's sides, and how far they are from the corner for each metre of depth."""
        down = np.array(self.down) / np.linalg.norm(self.down)
        flat = np.sqrt(1.0 - down**2)
        # Angles between the cube's faces, seen from above.
        apart = [np.arccos(-down[0] * down[k] / (flat[0] * flat[k])) for k in (1, 2)]
        angle = np.array([0.0, apart[0], -apart[1]])
        return np.column_stack((np.cos(angle), np.sin(angle))), down / flat

    def outline_m(self, depth_m: float) -> Array:
        """See `Body`."""
        across, reach = self._sides()
        corners = []
        for pair in ([0, 1], [1, 2], [2, 0]):
            corners.append(np.linalg.solve(across[pair], depth_m * reach[pair]))
        share = np.arange(_CORNERS // 3)[:, None] / (_CORNERS // 3)
        return np.concatenate([corners[k] + share * (corners[(k + 1) % 3] - corners[k]) for k in range(3)])

    def pressure_pa(self, x_m: Array, y_m: Array, depth_m: float) -> Array:
        """See `Body`."""
        across, reach = self._sides()
        away = np.maximum.reduce([(across[k, 0] * x_m + across[k, 1] * y_m) / (depth_m * reach[k]) for k in range(3)])
        pressure: Array = self.modulus_pa * np.where(away < 1, np.arccosh(1 / np.clip(away, 0.02, 1.0)), 0.0)
        return pressure


BODIES: dict[str, Body] = {body.name: body for body in (TennisBall(), SiliconeBlock(), Balloon())}
"""Every body by its name."""


def body_named(name: str) -> Body:
    """Look a body up.

    Raises
    ------
    SettingsError
        Naming those that exist.
    """
    return named(name, BODIES, "body")
