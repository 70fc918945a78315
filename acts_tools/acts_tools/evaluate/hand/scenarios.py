# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The scenarios by name."""

from __future__ import annotations

from collections.abc import Callable

from acts_tools.evaluate.hand import hand_to_hand, poke, slip, sphere
from acts_tools.evaluate.hand.scenario import Outcome, Run

SCENARIOS: dict[str, Callable[[Run], Outcome]] = {
    "slip": slip.run,
    "hold": slip.hold,
    "sharp": poke.sharp,
    "blunt": poke.blunt,
    "sphere": sphere.run,
    "small_sphere": sphere.small,
    "hand_to_hand": hand_to_hand.run,
}
"""Functions that run a scenario once and return its outcome."""
