"""What every scenario gives, and which there are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from acts_sim.hand import HandWorldConfig
from acts_tools.evaluate.hand.rig import HandRig, RigOptions


@dataclass(frozen=True)
class Run:
    """How a scenario is run once.

    Attributes
    ----------
    seed : int
    reflex : bool
        Whether the reflex that it is about acts.
    rate_hz : float
    settings : mapping
        Of supervisor and reflexes, where they are not the usual ones.
    rig : callable
        Makes the hand: `HandRig`, or what can do the same over the real interfaces (`acts_tools.live_hand.rigs`).
    """

    seed: int
    reflex: bool = True
    rate_hz: float = 250.0
    settings: Mapping[str, Any] = field(default_factory=dict)
    rig: Callable[[HandWorldConfig, RigOptions], Any] = HandRig

    def draw(self) -> np.random.Generator:
        """For what differs from seed to seed."""
        return np.random.default_rng([self.seed, 7])


@dataclass
class Outcome:
    """What came of it; None where it does not apply or did not happen.

    Attributes
    ----------
    ok : bool
        Whether all that is asked of the scenario was met.
    noticed_ms : float or None
        From 0.2 mm of motion, or from the contact of the tip, until the reflex acted.
    stopped_ms : float or None
        From then until the object stood, or the joints had begun to open.
    kept : bool or None
        Whether the object is still in the hand, or other contacts still touch.
    penetration_mm : float or None
        Deepest that the tip was in the skin.
    offset_mm : float or None
        How far the object was moved by what happened, or is from the palm's centre at the end.
    details : dict
        What belongs to this scenario alone.
    """

    ok: bool = False
    noticed_ms: float | None = None
    stopped_ms: float | None = None
    kept: bool | None = None
    penetration_mm: float | None = None
    offset_mm: float | None = None
    details: dict[str, Any] = field(default_factory=dict)
