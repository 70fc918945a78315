# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Hand-to-hand grasp: every phalanx of a finger presses about as much, while the held hand moves; never above a limit.

Each joint that closes a finger carries one phalanx. Where that phalanx presses less than is wanted the joint closes,
where it presses more the joint opens, so force goes from phalanges with much to those with little, and one that has
lost touch looks for it. Before the comfort limit of force or pressure is reached, the whole finger gives way; all of
them where the palm is pressed, whether or not they have touched yet. No reflex of lower priority closes it meanwhile.

ISO/TS 15066:2016, table A.2, allows 140 N of quasi-static force on hand and fingers and, where it presses hardest,
about 200 to 300 N/cm^2 (2 to 3 MPa). Those are limits of pain; comfort is a small part of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from acts_control.hand.reflexes.base import HandState, Reflex, Sensed, Wish
from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_core.skin import RegionContact


@dataclass(frozen=True)
class HandToHandConfig:
    """How hard another hand is held."""

    hand_to_hand_force_n: float = setting(0.8, "what each phalanx is to press with [N]", minimum=0.05, maximum=20.0)
    hand_to_hand_max_force_n: float = setting(
        10.0,
        "no region is to press with more; ISO/TS 15066 allows 140 [N]",
        minimum=0.5,
        maximum=100.0,
    )
    hand_to_hand_max_pressure_n_m2: float = setting(
        3e5, "or with more on its most pressed taxel; ISO/TS 15066 allows about 2e6 [N/m^2]", minimum=1e4, maximum=1e6
    )
    hand_to_hand_yield_share: float = setting(
        0.6, "fingers give way from this part of these limits on", minimum=0.1, maximum=1.0
    )
    hand_to_hand_steps_per_n: float = setting(0.6, "steps for each newton of difference", minimum=0.01, maximum=20.0)
    hand_to_hand_search_steps: float = setting(0.3, "steps of a phalanx that looks for touch", minimum=0.0, maximum=5.0)
    hand_to_hand_search_s: float = setting(
        0.5, "fingers look for touch for so long after none of them has felt any [s]", minimum=0.0, maximum=60.0
    )
    hand_to_hand_max_steps: float = setting(2.0, "most steps at once", minimum=0.1, maximum=20.0)
    hand_to_hand_deadband_n: float = setting(
        0.2, "differences of less than this have no effect [N]", minimum=0.0, maximum=5.0
    )

    @property
    def yields_n(self) -> float:
        """Force on a region above which its finger gives way [N]."""
        return self.hand_to_hand_yield_share * self.hand_to_hand_max_force_n

    def __post_init__(self) -> None:
        validate(self)
        yields_n = self.yields_n
        if self.hand_to_hand_force_n + self.hand_to_hand_deadband_n >= yields_n:
            raise SettingsError(
                f"hand_to_hand_force_n = {self.hand_to_hand_force_n:g}: with hand_to_hand_deadband_n = "
                f"{self.hand_to_hand_deadband_n:g} it has to be less than {yields_n:g}, where fingers give way "
                f"(hand_to_hand_yield_share times hand_to_hand_max_force_n), or they would close and open in turn"
            )


@dataclass
class HandToHandState:
    """What is remembered.

    Attributes
    ----------
    phalanges : int
        Phalanges in touch at the last step.
    fingers : set of str
        Fingers that have touched what is held.
    touched_s : float
        When any of them last did; -inf before the first [s].
    moves : dict
        For each region of a finger, the joint that moves its link and closes the finger.
    """

    phalanges: int = 0
    fingers: set[str] = field(default_factory=set)
    touched_s: float = -math.inf
    moves: dict[str, int] = field(default_factory=dict)


class HandToHand(Reflex):
    """See the module."""

    Config = HandToHandConfig
    priority = 65  # above slip: it would close a finger that gives way
    states = frozenset({HandState.CLOSING, HandState.HOLDING, HandState.AVOIDING})
    pressing = ("hand_to_hand_force_n",)

    config: HandToHandConfig

    def check(self, grip_force_n: float, max_force_n: float) -> None:
        """See `Reflex.check`."""
        super().check(grip_force_n, max_force_n)
        yields_n = self.config.yields_n
        if grip_force_n >= yields_n:
            raise SettingsError(
                f"grip_force_n = {grip_force_n:g}: with the reflex hand_to_hand allowed is less than {yields_n:g}, "
                f"where fingers give way (hand_to_hand_yield_share times hand_to_hand_max_force_n), or they would "
                f"never have gripped"
            )

    def reset(self) -> None:
        """Forget what was."""
        self.state = HandToHandState()

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps of each finger that touches."""
        config, state = self.config, self.state
        if not state.moves:
            state.moves = sensed.moving_joints()
        steps, why = sensed.steps(), ""
        gives_way = np.zeros(len(steps), dtype=bool)
        state.phalanges = 0
        at_palm = any(map(self._is_too_much, sensed.of_finger("")))
        touching = {finger for finger in sensed.hand.fingers if any(one.in_contact for one in sensed.of_finger(finger))}
        if touching:
            state.fingers |= touching
            state.touched_s = sensed.time_s
        is_there = sensed.time_s - state.touched_s <= config.hand_to_hand_search_s
        for finger in sensed.hand.fingers:
            regions, closing = sensed.of_finger(finger), sensed.closing(finger)
            if at_palm or any(map(self._is_too_much, regions)):
                steps -= config.hand_to_hand_max_steps * closing
                gives_way |= closing != 0.0
                why = f"{finger} gives way"
                continue
            # One that has lost all touch looks for it, too, unless what was held has gone.
            if finger not in state.fingers or not is_there:
                continue
            if sensed.state is HandState.CLOSING:
                continue  # each finger closes by itself, and shares nothing yet
            for region in regions:
                state.phalanges += region.in_contact
                joint = state.moves.get(region.name)
                if joint is not None:
                    steps[joint] += self._wanted(region.force_n, region.in_contact) * closing[joint]
        np.clip(steps, -config.hand_to_hand_max_steps, config.hand_to_hand_max_steps, out=steps)
        if not steps.any():
            return None
        self.note_acting(sensed.time_s)
        return Wish(steps, why or f"force shared among {state.phalanges} phalanges", gives_way)

    def _wanted(self, force_n: float, in_contact: bool) -> float:
        config = self.config
        if not in_contact:
            return config.hand_to_hand_search_steps
        error = config.hand_to_hand_force_n - force_n
        return config.hand_to_hand_steps_per_n * error if abs(error) > config.hand_to_hand_deadband_n else 0.0

    def _is_too_much(self, region: RegionContact) -> bool:
        config = self.config
        if not region.in_contact:
            return False
        pressure = region.peak_n * region.active_taxels / region.area_m2 if region.area_m2 > 0.0 else 0.0
        share = max(region.force_n / config.hand_to_hand_max_force_n, pressure / config.hand_to_hand_max_pressure_n_m2)
        return share > config.hand_to_hand_yield_share
