# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A solid ball that rolls without slipping on the moving plate."""

from __future__ import annotations

import math
from dataclasses import dataclass

from acts_core.settings import setting, validate
from acts_sim.ball.ball_kernels import roll
from acts_sim.ball.ball_plate import PlateMotion


@dataclass(frozen=True)
class BallConfig:
    """The ball; by default of steel, 0.51 kg.

    The coefficient of rolling resistance is an assumption between those of a steel wheel on a rail (about 0.001) and of
    a car's tyre on asphalt (about 0.01 to 0.015): foam is soft, but the ball sinks in only a few millimetres.
    """

    diameter_m: float = setting(0.050, "diameter of the ball [m]", minimum=0.005, maximum=0.2)
    density_kg_per_m3: float = setting(7800.0, "density of the ball [kg/m^3]", minimum=10.0, maximum=25000.0)
    rolling_resistance: float = setting(
        0.005, "coefficient of rolling resistance: force over normal load", minimum=0.0, maximum=0.2
    )

    def __post_init__(self) -> None:
        validate(self)

    @property
    def radius_m(self) -> float:
        """[m]"""
        return self.diameter_m / 2

    @property
    def mass_kg(self) -> float:
        """[kg]"""
        return self.density_kg_per_m3 * math.pi / 6 * self.diameter_m**3


@dataclass(frozen=True)
class BallState:
    """State of the ball in the skin's frame.

    Attributes
    ----------
    x_m, y_m : float
        Position of its centre over the skin [m].
    vx_m_s, vy_m_s : float
        Velocity relative to the plate [m/s].
    load_n : float
        Normal force on the plate during the last step [N].
    """

    x_m: float = 0.0
    y_m: float = 0.0
    vx_m_s: float = 0.0
    vy_m_s: float = 0.0
    load_n: float = 0.0


def step(config: BallConfig, state: BallState, plate: PlateMotion, dt_s: float) -> BallState:
    """Advance the ball by one time step.

    Parameters
    ----------
    config : BallConfig
    state : BallState
    plate : PlateMotion
        Motion of the plate during the step.
    dt_s : float
        Length of the step [s].

    Returns
    -------
    BallState
        The ball stays in the plate's plane: where the plate accelerates downwards faster than the ball would fall, the
        load is 0, and the flight is not simulated.
    """
    x_m, y_m, vx_m_s, vy_m_s, load = roll(
        state.x_m,
        state.y_m,
        state.vx_m_s,
        state.vy_m_s,
        plate.rows,
        config.radius_m,
        config.rolling_resistance,
        dt_s,
    )
    return BallState(x_m, y_m, vx_m_s, vy_m_s, load * config.mass_kg)
