# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sharp-object avoidance: the finger that feels a tip opens at once, its neighbours keep holding.

How much likelier a tip is than something blunt is told by the skin (`RegionContact.sharpness`).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from acts_control.hand.reflexes.base import HandState, Reflex, Sensed, Wish
from acts_core.settings import setting, validate

# A region that feels less than this share of the force of the cycle before is being let go.
_KEPT_SHARE = 0.9


@dataclass(frozen=True)
class SharpAvoidanceConfig:
    """What counts as sharp, and how the finger gives way."""

    sharp_min_sharpness: float = setting(
        4.0,
        "a region feels a tip where its sharpness is larger: how much likelier a tip is than something blunt, as a "
        "natural logarithm",
        minimum=0.0,
        maximum=100.0,
    )
    sharp_felt_s: float = setting(
        0.003,
        "how long a region must feel the tip, cycle after cycle; 0: one cycle is enough [s]. An image of something "
        "that moves fast can look like a tip, because its taxels are measured one after the other",
        minimum=0.0,
        maximum=1.0,
    )
    sharp_open_steps: float = setting(20.0, "steps by which the finger opens", minimum=0.1, maximum=100.0)
    sharp_open_rad: float = setting(
        0.5, "largest angle by which each joint that closes the finger is opened [rad]", minimum=0.01, maximum=3.0
    )
    sharp_away_s: float = setting(
        0.5, "how long the finger stays away once the tip is not felt any more [s]", minimum=0.0, maximum=60.0
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass
class SharpAvoidanceState:
    """What is remembered.

    Attributes
    ----------
    since_s : dict
        Since when each region has felt a tip without a break, where one does.
    force_n : dict
        What each region felt in the cycle before [N].
    until_s : dict
        Until when each finger stays away; the palm is the empty name.
    from_rad : dict
        Joint angles when it began [rad].
    """

    since_s: dict[str, float] = field(default_factory=dict)
    force_n: dict[str, float] = field(default_factory=dict)
    until_s: dict[str, float] = field(default_factory=dict)
    from_rad: dict[str, np.ndarray] = field(default_factory=dict)


class SharpAvoidance(Reflex):
    """See the module."""

    Config = SharpAvoidanceConfig
    priority = 100
    states = frozenset({HandState.OPEN, HandState.CLOSING, HandState.HOLDING, HandState.AVOIDING})

    config: SharpAvoidanceConfig

    def reset(self) -> None:
        """Forget what was."""
        self.state = SharpAvoidanceState()

    def step(self, sensed: Sensed) -> Wish | None:
        """Open the fingers concerned, and keep them for a while from whatever else asks for them."""
        state, config = self.state, self.config
        state.until_s = {finger: until_s for finger, until_s in state.until_s.items() if sensed.time_s <= until_s}
        if sensed.is_new:
            self._look(sensed)
        away = list(state.until_s)
        if not away:
            return None
        steps = sensed.steps()
        claimed = np.zeros(len(steps), dtype=bool)
        # A tip in the palm: whatever holds it there lets go.
        fingers = list(sensed.hand.fingers) if "" in away else away
        for finger in fingers:
            closing = sensed.closing(finger)
            opened = state.from_rad[finger if finger in away else ""] - sensed.goal_rad
            steps -= np.where(opened < config.sharp_open_rad, config.sharp_open_steps * closing, 0.0)
            claimed |= closing > 0.0
        return Wish(steps, f"{', '.join(fingers)} away from a tip", claimed, at_once=True, avoids=True)

    def _look(self, sensed: Sensed) -> None:
        state, config = self.state, self.config
        # Of a region that a message left out nothing is known in between.
        state.since_s = {name: since_s for name, since_s in state.since_s.items() if name in sensed.regions}
        state.force_n = {name: force_n for name, force_n in state.force_n.items() if name in sensed.regions}
        for name, region in sensed.regions.items():
            before_n, state.force_n[name] = state.force_n.get(name, 0.0), region.force_n
            # A tip that goes in presses more and more; an image of what lifts off can look like one.
            is_sharp = region.sharpness > config.sharp_min_sharpness and region.force_n >= _KEPT_SHARE * before_n
            if not is_sharp:
                state.since_s.pop(name, None)
                continue
            if sensed.time_s - state.since_s.setdefault(name, sensed.time_s) < config.sharp_felt_s:
                continue
            finger = sensed.finger(name)
            if finger not in state.until_s:
                self.events += 1
                state.from_rad[finger] = sensed.q_rad.copy()
            state.until_s[finger] = sensed.time_s + config.sharp_away_s
