# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Counts of all taxels under a ball: a sphere pressed into foam over the array.

The foam is an elastic (Winkler) foundation: pressure is stiffness times depth, so inside the contact circle
``p(r) = k (depth - r^2 / (2 R))``. The total force ``pi k R depth^2`` equals the load, which gives the depth. In the
foam, the pressure spreads sideways as a Gaussian. Each taxel carries the mean over its square, and the force response
gives its counts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from acts_core.array import ArrayGeometry
from acts_core.settings import setting, validate
from acts_core.skin import ForceResponse
from acts_sim.ball.ball_kernels import press


@dataclass(frozen=True)
class ContactConfig:
    """The foam over the array.

    The default stiffness is an assumption: that of 8 mm of soft neoprene sponge. Its grade 2A1 of ASTM D1056 needs 14
    to 34 kPa for 25 % compression, so 0.7e7 to 1.7e7 N/m^3. A steel ball of 50 mm then sinks 2.8 mm deep, on a circle
    of 24 mm or 5 taxels of the paper's array. The paper names neoprene foam (S11), but not its thickness or stiffness.
    """

    foam_stiffness_n_per_m3: float = setting(8.0e6, "pressure of the foam per depth [N/m^3]", minimum=1e5, maximum=1e10)
    foam_spread_m: float = setting(
        0.0020, "standard deviation of the sideways spread of pressure in the foam [m]", minimum=0.0, maximum=0.02
    )

    def __post_init__(self) -> None:
        validate(self)


def depth_m(config: ContactConfig, radius_m: float, load_n: float) -> float:
    """Depth of a sphere in the foam under a load [m]; 0 without load."""
    return math.sqrt(max(load_n, 0.0) / (math.pi * config.foam_stiffness_n_per_m3 * radius_m))


class BallContact:
    """Counts of all taxels under a ball, computed in place for speed.

    Parameters
    ----------
    config : ContactConfig
    geometry : ArrayGeometry
    radius_m : float
        Of the ball.

    Attributes
    ----------
    counts : np.ndarray [shape=(rows, cols), dtype=float64]
        ADC counts of the last `press`, before noise and rounding.
    """

    def __init__(self, config: ContactConfig, geometry: ArrayGeometry, radius_m: float) -> None:
        self._config = config
        self._geometry = geometry
        self._radius_m = radius_m
        self._response = ForceResponse()
        self.counts = np.zeros((geometry.rows, geometry.cols))

    def press(self, x_m: float, y_m: float, load_n: float) -> None:
        """Press a ball on the skin at a position [m] with a normal force [N]; 0 N leaves the skin untouched."""
        press(
            self.counts,
            self._geometry.pitch_m,
            self._geometry.pitch_y_m,
            x_m,
            y_m,
            self._radius_m,
            depth_m(self._config, self._radius_m, load_n),
            self._config.foam_stiffness_n_per_m3,
            self._config.foam_spread_m,
            self._response.full_scale_counts,
            self._response.dead_n,
            self._response.half_n,
        )
