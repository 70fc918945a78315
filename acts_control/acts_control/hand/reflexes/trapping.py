# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Trapping: a sphere too small for several fingertips is pressed into the palm by the finger that has got hold of it.

The palm tells where it lies, the finger how large it is. Only that finger presses, and no reflex of lower priority
moves a joint meanwhile: fingers that close around something small push it out from under the one that holds it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from acts_control.hand.reflexes.base import HandState, Reflex, Sensed, Wish
from acts_control.hand.reflexes.spheres import aiming
from acts_core.settings import setting, validate


@dataclass(frozen=True)
class TrappingConfig:
    """What is small, and how it is held."""

    trap_force_n: float = setting(
        2.0, "what a finger presses a small sphere into the palm with [N]", minimum=0.05, maximum=20.0
    )
    trap_compliance_m_s_n: float = setting(
        0.02,
        "speed at which a finger presses harder or yields, for each newton of difference [m/s/N]",
        minimum=0.0,
        maximum=1.0,
    )
    trap_spread_m: float = setting(
        0.008, "a contact of the palm with more spread than this is not of a small sphere [m]", minimum=0.0, maximum=0.1
    )
    trap_damping_m: float = setting(
        0.01, "keeps the joints slow where a finger is stretched [m/rad]", minimum=1e-4, maximum=0.1
    )

    def __post_init__(self) -> None:
        validate(self)


class Trapping(Reflex):
    """See the module.

    Attributes
    ----------
    radius_m : float
        Of what is held, when it was last felt by palm and finger; 0 before [m].
    """

    Config = TrappingConfig
    priority = 75  # above balancing and slip: they would close all fingers
    states = frozenset({HandState.HOLDING, HandState.AVOIDING})
    pressing = ("trap_force_n",)

    config: TrappingConfig

    def reset(self) -> None:
        """Forget what was."""
        self.radius_m = 0.0

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps of the fingers that touch what is small; None for anything else."""
        config = self.config
        fingers = [one for name, one in sensed.regions.items() if one.in_contact and sensed.finger(name)]
        felt = aiming.felt_by_palm(sensed, config.trap_spread_m)
        if felt is not None and fingers:
            points = [sensed.pose.point(one.link, one.centre_m) for one in fingers]
            self.radius_m = aiming.radius_on_palm(*felt, points) or self.radius_m
        if not fingers or not 0.0 < self.radius_m < aiming.SMALL_M:
            return None
        self.note_acting(sensed.time_s)
        rates = sensed.steps()
        for one in fingers:
            speed_m_s = config.trap_compliance_m_s_n * (config.trap_force_n - one.force_n)
            rates += aiming.press(sensed, one, speed_m_s, config.trap_damping_m)
        why = f"a sphere of {1e3 * self.radius_m:.0f} mm is trapped"
        return Wish(rates / sensed.step_rad_s, why, claimed=np.ones(len(rates), dtype=bool))
