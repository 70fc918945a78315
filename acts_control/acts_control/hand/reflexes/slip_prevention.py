# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Slip prevention: grip up while what is held slips, then ease slowly to what holds.

Slip is told by the regions (docs/slip.md). They look back over a window, so slip is told for a while after it has
ceased; whether the pattern still moves is seen by its distance in the window still growing. All fingers that touch grip
together, for one that grips alone pushes the object away. What was added is kept for a while, then taken back until a
share is left of what was added since the object began to slip last, so that it is held by more than did not hold it.
Around something firm a goal comes to its limits (`StepRule`) before all of that is added: of each joint's goal no more
is taken back than it has moved by.

Where weight shifts from one part of the skin to another, or a grip moves the object, a pattern moves as in a slip, but
slowly and not far. For what is fragile, the first sign of a slip can be answered by a little of the grip
(`slip_first_steps`), and only one that goes on by all of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes.base import HandState, Reflex, Sensed, Wish
from acts_core.settings import setting, validate

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SlipPreventionConfig:
    """How a slip is answered."""

    slip_grip_steps: float = setting(
        16.0, "steps by which fingers grip harder while the object slips", minimum=0.1, maximum=50.0
    )
    slip_max_added_steps: float = setting(
        11.0, "most that is added to the grip, in steps of a cycle at 60 Hz", minimum=0.1, maximum=200.0
    )
    slip_first_steps: float = setting(
        200.0,
        "steps that the first sign of a slip is answered with, up to slip_max_added_steps; 1 for what is fragile",
        minimum=0.0,
        maximum=200.0,
    )
    slip_soon_m: float = setting(
        1e-4,
        "slip_max_added_steps are added where a pattern moves on by more than this within slip_soon_s [m]",
        minimum=0.0,
        maximum=1e-2,
    )
    slip_soon_s: float = setting(
        0.013, "see slip_soon_m; a loop with a longer cycle adds them at once [s]", minimum=0.0, maximum=1.0
    )
    slip_far_m: float = setting(
        6e-4, "they are also added where it has moved on by more than this [m]", minimum=0.0, maximum=1e-2
    )
    slip_settle_s: float = setting(
        0.2, "a sign of a slip is a first one again when nothing has moved for longer [s]", minimum=0.0, maximum=5.0
    )
    slip_growth_m: float = setting(
        1e-5,
        "a growth of the distance by less than this from touch to touch counts as none [m]",
        minimum=0.0,
        maximum=1e-3,
    )
    slip_quiet_s: float = setting(
        0.012, "slip has ceased when the distance has not grown for longer [s]", minimum=0.0, maximum=1.0
    )
    slip_min_force_n: float = setting(
        0.1, "a region that feels less than this is ignored [N]", minimum=0.0, maximum=10.0
    )
    slip_keep_s: float = setting(1.0, "how long the added grip is kept [s]", minimum=0.0, maximum=60.0)
    slip_ease_steps: float = setting(
        0.03, "steps by which the added grip is eased after that", minimum=0.0, maximum=5.0
    )
    slip_kept_share: float = setting(
        0.6, "share of the grip added since the last slip began that is not eased", minimum=0.0, maximum=1.0
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass
class SlipPreventionState:
    """What is remembered.

    Attributes
    ----------
    distance_m : dict
        Of each region when it was last looked at.
    grown_s : float
        When one of them has last grown.
    first_s : float
        When that began, at the first sign.
    on_m : dict
        By how much each has grown since the first sign.
    most : float
        Most that may be added for the present, in steps of a cycle at 60 Hz.
    added, peak, floor : float
        Added grip now, the most of it, and what it was at the last slip, in steps of a cycle at 60 Hz.
    is_slipping : bool
    goals : AddedGoals or None
        What that has made of the goals of the joints; None before the first slip.
    """

    distance_m: dict[str, float] = field(default_factory=dict)
    grown_s: float = -1e9
    first_s: float = -1e9
    on_m: dict[str, float] = field(default_factory=dict)
    most: float = 0.0
    added: float = 0.0
    peak: float = 0.0
    floor: float = 0.0
    is_slipping: bool = False
    goals: AddedGoals | None = None


class AddedGoals:
    """How far the goals of the joints have really moved since the grip was first added to.

    Parameters
    ----------
    goal_rad : np.ndarray [shape=(joints,)]
        Where they are when the object begins to slip [rad].
    """

    def __init__(self, goal_rad: Array) -> None:
        self._highest_rad = self._floor_rad = goal_rad

    def slips_again(self, goal_rad: Array) -> None:
        """It did not hold with these: easing ends above."""
        self._floor_rad = np.maximum(self._floor_rad, goal_rad)

    def may_be_eased(self, goal_rad: Array, kept_share: float) -> NDArray[np.bool_]:
        """Whose goals are still above what is kept; to be called in each step."""
        self._highest_rad = np.maximum(self._highest_rad, goal_rad)
        kept_rad = self._floor_rad + kept_share * (self._highest_rad - self._floor_rad)
        above: NDArray[np.bool_] = goal_rad > kept_rad
        return above


class SlipPrevention(Reflex):
    """See the module."""

    Config = SlipPreventionConfig
    priority = 60
    states = frozenset({HandState.HOLDING, HandState.AVOIDING})

    config: SlipPreventionConfig

    def reset(self) -> None:
        """Forget what was."""
        self.state = SlipPreventionState()

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps of all fingers that touch; None while nothing slips and nothing is to be eased."""
        config, state = self.config, self.state
        told = self._grown(sensed) if sensed.is_new else ""
        if told:
            self._note_slip(sensed)
        elif sensed.time_s - state.grown_s > config.slip_quiet_s:
            state.is_slipping = False
        cycles = sensed.dt_s * 60.0
        above = state.goals.may_be_eased(sensed.goal_rad, config.slip_kept_share) if state.goals is not None else None
        if state.is_slipping:
            steps = min(config.slip_grip_steps, (state.most - state.added) / cycles)
            why = f"{told or 'object'} slips: grip up"
        elif state.added > self._end() and sensed.time_s - state.grown_s > config.slip_keep_s:
            steps, why = -min(config.slip_ease_steps, (state.added - self._end()) / cycles), "easing the grip"
        else:
            return None
        state.added += steps * cycles
        state.peak = max(state.peak, state.added)
        wanted = sensed.steps()
        for finger in sensed.hand.fingers:
            if any(one.in_contact for one in sensed.of_finger(finger)):
                wanted += steps * sensed.closing(finger)
        if steps < 0.0 and above is not None:
            wanted *= above
        return Wish(wanted, why, at_once=steps > 0.0)

    def _note_slip(self, sensed: Sensed) -> None:
        """Note that a pattern has moved on: whether a slip begins with it, and how much may be added to the grip."""
        config, state = self.config, self.state
        if not state.is_slipping:
            self.events += 1
            # It did not hold with this: easing ends above.
            state.floor = max(state.floor, state.added)
            state.goals = state.goals or AddedGoals(sensed.goal_rad)
            state.goals.slips_again(sensed.goal_rad)
        if sensed.time_s - state.grown_s > config.slip_settle_s:
            state.first_s, state.on_m = sensed.time_s, {}
            state.most = min(state.added + config.slip_first_steps, config.slip_max_added_steps)
        if self._goes_on(sensed):
            state.most = config.slip_max_added_steps
        state.is_slipping = True
        state.grown_s = sensed.time_s

    def _goes_on(self, sensed: Sensed) -> bool:
        config, state = self.config, self.state
        if sensed.dt_s > config.slip_soon_s:
            return True
        on_m = max(state.on_m.values(), default=0.0)
        is_soon = sensed.time_s - state.first_s <= config.slip_soon_s
        return on_m > config.slip_far_m or (is_soon and on_m > config.slip_soon_m)

    def _end(self) -> float:
        state = self.state
        return state.floor + self.config.slip_kept_share * (state.peak - state.floor)

    def _grown(self, sensed: Sensed) -> str:
        """A region in which the pattern moves on; empty where there is none."""
        state, found = self.state, ""
        for name, region in sensed.regions.items():
            distance = region.slip_m if region.slipping and region.force_n >= self.config.slip_min_force_n else 0.0
            before = state.distance_m.get(name, 0.0)
            if distance > before + self.config.slip_growth_m:
                found = found or name
                # What a region tells first has moved for some time.
                state.on_m[name] = state.on_m.get(name, 0.0) + (distance - before if before > 0.0 else 0.0)
            state.distance_m[name] = distance
        return found
