# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Balls that are dropped and thrown: mass, size, and how they meet the skin."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.registry import named
from acts_core.settings import setting, validate


@dataclass(frozen=True)
class Ball:
    """A ball on the foam of a skin. Ball and foam together are one spring and damper (Hunt and Crossley).

    The normal force is ``stiffness * depth^1.5 * (1 + damping * rate of depth)``, Hertz's law with losses; it never
    pulls. The footprint is Hertz's: a disc of radius ``sqrt(radius * depth)``, so it grows with the force.
    """

    mass_kg: float = setting(0.0577, "mass [kg]", minimum=1e-4, maximum=10.0)
    radius_m: float = setting(0.0335, "radius [m]", minimum=0.001, maximum=0.5)
    inertia: float = setting(0.6, "moment of inertia over mass and radius squared", minimum=0.1, maximum=1.0)
    stiffness_n_per_m15: float = setting(89.6e3, "stiffness [N/m^1.5]", minimum=1.0, maximum=1e9)
    damping_s_per_m: float = setting(0.185, "losses: damping over stiffness [s/m]", minimum=0.0, maximum=10.0)
    friction: float = setting(0.6, "coefficient of friction on the skin", minimum=0.0, maximum=5.0)

    def __post_init__(self) -> None:
        validate(self)


DROP_HEIGHT_M = 0.75
"""Table height, from which the paper dropped its tennis balls."""

# Masses and sizes are those of the rules of tennis and golf; the rubber ball is one of 45 mm. Stiffness is set so that
# a drop from `DROP_HEIGHT_M` touches for the 8.7 ms of the paper's tennis ball, and for 6 ms (rubber) and 4 ms (golf),
# which are ours: the paper gives none. Losses are set for the usual heights of bounce.
BALLS: dict[str, Ball] = {
    "tennis": Ball(),
    "rubber": Ball(
        mass_kg=0.045,
        radius_m=0.0225,
        inertia=0.4,
        stiffness_n_per_m15=164.5e3,
        damping_s_per_m=0.096,
        friction=0.7,
    ),
    "golf": Ball(
        mass_kg=0.0459,
        radius_m=0.02135,
        inertia=0.4,
        stiffness_n_per_m15=472.5e3,
        damping_s_per_m=0.128,
        friction=0.3,
    ),
}
"""Every ball by its name."""


def ball_named(name: str) -> Ball:
    """Look a ball up.

    Raises
    ------
    SettingsError
        Naming those that exist.
    """
    return named(name, BALLS, "ball")
