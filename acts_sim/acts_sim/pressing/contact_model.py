# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Counts of the skin when an object is pressed into it: foam, force response and noise.

The foam is an elastic (Winkler) foundation: the pressure at a point is proportional to the object's depth there. In
the foam, the pressure spreads sideways as a Gaussian. Each taxel carries the force on its square; the array's force
response gives its counts, with a sensitivity of its own and noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.settings import setting, validate
from acts_core.skin import ForceResponse
from acts_sim.pressing.objects import ContactObject
from acts_sim.pressing.outlines import Field

_MARGIN_TAXELS = 2
"""Width of the foam that is modelled beyond the array's edge, since pressure there spreads onto the array."""

_TILT = 0.03
"""Standard deviation of the slope of a random press: an arm never holds an object exactly parallel to the skin."""


@dataclass(frozen=True)
class FoamConfig:
    """The foam and the taxels under it.

    The default stiffness is that of 3 mm of soft neoprene foam (Young's modulus 50 kPa over thickness).
    """

    stiffness_n_per_m3: float = setting(1.7e7, "pressure per depth [N/m^3]", minimum=1e5, maximum=1e10)
    spread_m: float = setting(
        0.0020, "standard deviation of the sideways spread of pressure in the foam [m]", minimum=1e-4, maximum=0.05
    )
    subsamples: int = setting(4, "points of the height map along a taxel's side", minimum=1, maximum=16)
    noise_counts: float = setting(3.0, "standard deviation of the noise of one reading", minimum=0, maximum=100)
    gain_spread: float = setting(0.05, "standard deviation of the taxels' sensitivities", minimum=0, maximum=0.5)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class Press:
    """Pose of an object that is pressed into the skin.

    Attributes
    ----------
    x_m, y_m : float
        Its centre in the skin's frame [m].
    angle_rad : float
        Its angle about z, counter-clockwise seen from outside [rad].
    depth_m : float
        Depth of its lowest point below the untouched surface [m].
    scale : float
        Its size relative to the registered one.
    tilt_x, tilt_y : float
        Slope of its underside along x and y: at a distance d from its centre, its depth is less by ``tilt * d``.
    """

    x_m: float = 0.0
    y_m: float = 0.0
    angle_rad: float = 0.0
    depth_m: float = 0.001
    scale: float = 1.0
    tilt_x: float = 0.0
    tilt_y: float = 0.0


class ContactModel:
    """An array under foam.

    Parameters
    ----------
    geometry : ArrayGeometry
    config : FoamConfig
    seed : int
        Seed of the sensitivities and the noise: the same calls in the same order give the same counts.
    """

    def __init__(
        self,
        geometry: ArrayGeometry | None = None,
        config: FoamConfig | None = None,
        *,
        seed: int = 0,
    ) -> None:
        self.geometry = geometry or ArrayGeometry()
        self.config = config or FoamConfig()
        self.response = ForceResponse()
        self._rng = np.random.default_rng(seed)
        shape = (self.geometry.rows, self.geometry.cols)
        self._gain = np.maximum(1 + self.config.gain_spread * self._rng.standard_normal(shape), 0.1)
        col, self._to_cols = _spreading(self.geometry.cols, self.geometry.pitch_m, self.config)
        row, self._to_rows = _spreading(self.geometry.rows, self.geometry.pitch_y_m, self.config)
        self._x, self._y = np.meshgrid(self.geometry.x_m(col), self.geometry.y_m(row))

    def forces_n(self, item: ContactObject, press: Press) -> NDArray[np.float64]:
        """Force on every taxel [N]; np.ndarray [shape=(rows, cols), dtype=float64]."""
        c, s = math.cos(press.angle_rad), math.sin(press.angle_rad)
        dx, dy = (self._x - press.x_m) / press.scale, (self._y - press.y_m) / press.scale
        gap = item.gap_m(c * dx + s * dy, -s * dx + c * dy) * press.scale
        gap += press.tilt_x * (self._x - press.x_m) + press.tilt_y * (self._y - press.y_m)
        return self._carried_n(self.config.stiffness_n_per_m3 * np.maximum(press.depth_m - gap, 0.0))

    def forces_under(self, pressure_pa: Callable[[Field, Field], Field]) -> NDArray[np.float64]:
        """Force on every taxel [N] under a pressure that comes from elsewhere, as from a ball that deforms itself.

        Parameters
        ----------
        pressure_pa : callable
            ``pressure_pa(x_m, y_m)``: pressure on the foam [Pa] at points of the skin's frame, also up to two taxels
            beyond the array's edge; same shape as the arguments.

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=float64]
        """
        return self._carried_n(pressure_pa(self._x, self._y))

    def _carried_n(self, pressure_pa: Field) -> NDArray[np.float64]:
        point_area_m2 = self.geometry.taxel_area_m2 / self.config.subsamples**2
        return self._to_rows @ pressure_pa @ self._to_cols.T * point_area_m2

    def counts(self, forces_n: NDArray[np.float64]) -> NDArray[np.uint16]:
        """One reading of every taxel under these forces, with noise.

        Parameters
        ----------
        forces_n : np.ndarray [shape=(rows, cols), dtype=float64]

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=uint16]
            0 to 1023.
        """
        clean = self.response.counts(forces_n * self._gain)
        noisy = clean + self.config.noise_counts * self._rng.standard_normal(clean.shape)
        return np.clip(np.rint(noisy), 0, COUNT_MAX).astype(np.uint16)

    def random_press(self, item: ContactObject) -> Press:
        """A press of `item` with random position on the array, angle, depth, size and tilt."""
        draw = self._rng.random(5)
        tilt_x, tilt_y = _TILT * self._rng.standard_normal(2)
        half_x, half_y = self.geometry.x_m(self.geometry.cols - 1), self.geometry.y_m(0)
        shallow, deep = item.depth_m
        return Press(
            x_m=float((2 * draw[0] - 1) * half_x),
            y_m=float((2 * draw[1] - 1) * half_y),
            angle_rad=float(2 * np.pi * draw[2]),
            depth_m=float(shallow + (deep - shallow) * draw[3]),
            scale=float(0.8 + 0.4 * draw[4]),
            tilt_x=float(tilt_x),
            tilt_y=float(tilt_y),
        )

    def random_frame(self, item: ContactObject) -> NDArray[np.uint16]:
        """One reading of a random press; np.ndarray [shape=(rows, cols), dtype=uint16]."""
        return self.counts(self.forces_n(item, self.random_press(item)))


def skin_of(rng: np.random.Generator) -> ContactModel:
    """A skin with taxels of random sensitivity, and no noise: whoever samples its frames adds it."""
    # Two points along a taxel's side are enough for round and flat undersides, and four times faster.
    return ContactModel(config=FoamConfig(noise_counts=0.0, subsamples=2), seed=int(rng.integers(2**31)))


def _spreading(taxels: int, pitch_m: float, config: FoamConfig) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the fine grid along one side, and each taxel's share of the force at each of its points.

    Returns
    -------
    position : np.ndarray [shape=(n,), dtype=float64]
        Position as a fractional index of taxels.
    share : np.ndarray [shape=(taxels, n), dtype=float64]
    """
    n = (taxels + 2 * _MARGIN_TAXELS) * config.subsamples
    position = (np.arange(n) + 0.5) / config.subsamples - 0.5 - _MARGIN_TAXELS
    edges = np.arange(taxels + 1) - 0.5
    width = math.sqrt(2) * config.spread_m / pitch_m
    below = np.array([[math.erf((edge - p) / width) for p in position] for edge in edges]) / 2
    return position, np.diff(below, axis=0)
