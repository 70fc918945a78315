# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Options and outcome of a scenario."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from acts_sim.hand import HandWorldConfig
from acts_tools.hand_rigs.rig import HandRig, RigOptions


@dataclass(frozen=True)
class Run:
    """Options of one run of a scenario.

    Attributes
    ----------
    seed : int
    reflex : bool
        Whether the reflex of the scenario is on.
    rate_hz : float
    also : tuple of str
        Further reflexes that act, besides those of the scenario.
    settings : mapping
        Settings of supervisor and reflexes that are not the defaults; they override those of the scenario.
    rig : callable
        Makes the hand: `HandRig`, or its equivalent over the real interfaces (`acts_tools.hand_rigs.live_rigs`).
    """

    seed: int
    reflex: bool = True
    rate_hz: float = 250.0
    also: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    rig: Callable[[HandWorldConfig, RigOptions], Any] = HandRig

    @property
    def world_seed(self) -> int:
        """Seed of the simulated hand and its object, which a parameter of a node must hold."""
        return self.seed % 2**31

    def draw(self) -> np.random.Generator:
        """Random generator of the run's variation."""
        return np.random.default_rng([self.seed, 7])

    def options(self, *reflexes: str, **settings: Any) -> RigOptions:
        """Options of the scenario's hand: its reflexes and settings, and those of this run."""
        names = tuple(dict.fromkeys((*reflexes, *self.also)))
        return RigOptions(self.rate_hz, names, settings={**settings, **self.settings})


@dataclass
class Outcome:
    """Outcome of a run; None for what does not apply or did not happen.

    Attributes
    ----------
    ok : bool
        Whether all criteria of the scenario were met.
    noticed_ms : float or None
        Time from 0.2 mm of motion, or from the contact of the tip, until the reflex acted.
    stopped_ms : float or None
        Time from then until the object stopped, or the joints began to open.
    kept : bool or None
        Whether the object is still in the hand, or the other contacts persist; False where nothing was grasped.
    penetration_mm : float or None
        Largest depth of the tip in the skin.
    offset_mm : float or None
        Displacement of the object by the event, or its distance from the palm's centre at the end.
    details : dict
        Further results of this scenario.
    """

    ok: bool = False
    noticed_ms: float | None = None
    stopped_ms: float | None = None
    kept: bool | None = None
    penetration_mm: float | None = None
    offset_mm: float | None = None
    details: dict[str, Any] = field(default_factory=dict)


def between_ms(first_s: float | None, then_s: float | None) -> float | None:
    """From one moment to a later one [ms]; None where one of them did not come."""
    return None if first_s is None or then_s is None else 1e3 * (then_s - first_s)
