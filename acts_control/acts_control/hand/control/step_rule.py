# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From what the reflexes ask for to the goals of the joints: the one place that moves a goal.

A reflex asks for steps. One step moves a joint's goal by the base step times the scale of its motor; how quickly the
number of steps may change is shaped for each motor, except for steps that a reflex wants at once: these also end at
once, for a tail would move the goal farther than was asked for. The goals stay within the joints' limits and never
farther ahead of the joints than `max_lead_rad`: a position-controlled motor presses in proportion to that lead, so this
bounds the grip, and an opening finger begins to open with its first step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import HandDescription
from acts_control.hand.reflexes import Wish
from acts_core.settings import setting, validate

Array = NDArray[np.float64]

# The rate of the paper's loop, in whose cycles steps are counted: at any other rate a hand is as fast.
STEP_RATE_HZ = 60.0


@dataclass(frozen=True)
class StepRuleConfig:
    """How far and how fast goals move."""

    base_step_rad: float = setting(
        0.02, "how far one step moves a joint's goal, in the time of a cycle at 60 Hz [rad]", minimum=1e-4, maximum=0.2
    )
    max_steps: float = setting(
        20.0, "most steps that a joint is moved in the time of a cycle at 60 Hz", minimum=0.1, maximum=100.0
    )
    steps_rise_per_s: float = setting(
        120.0,
        "how fast the number of steps of a motor may change, but for reflexes that act at once [1/s]",
        minimum=1.0,
        maximum=1e5,
    )
    max_lead_rad: float = setting(
        0.13,
        "a goal is never farther ahead of its joint than this over the joint's gain_scale [rad]",
        minimum=0.005,
        maximum=1.0,
    )
    max_grip_current_ma: float = setting(
        340.0, "a joint whose motor takes more is not closed any further [mA]", minimum=1.0, maximum=2000.0
    )

    def __post_init__(self) -> None:
        validate(self)


class StepRule:
    """Moves the goals of a hand.

    Parameters
    ----------
    hand : HandDescription
    config : StepRuleConfig

    Attributes
    ----------
    refused : int
        Answers of reflexes with numbers that are not finite; they are left out.
    step_rad_s : np.ndarray [shape=(joints,)]
        How fast one step moves each joint's goal [rad/s].
    """

    def __init__(self, hand: HandDescription, config: StepRuleConfig) -> None:
        self.refused = 0
        self._config = config
        self.step_rad_s = config.base_step_rad * STEP_RATE_HZ * np.array([joint.step_scale for joint in hand.joints])
        self._hand = hand
        self._lead = config.max_lead_rad / np.array([joint.gain_scale for joint in hand.joints])
        self._steps = np.zeros(len(hand.joints))

    def reset(self) -> None:
        """The goals stand still."""
        self._steps[:] = 0.0

    def is_usable(self, wish: Wish) -> bool:
        """Whether its steps are finite; one with others is counted in `refused`."""
        usable = bool(np.isfinite(wish.steps).all())
        self.refused += not usable
        return usable

    def goals(self, goal_rad: Array, q_rad: Array, current_ma: Array, wishes: Sequence[Wish], dt_s: float) -> Array:
        """The next goals.

        Parameters
        ----------
        goal_rad, q_rad, current_ma : np.ndarray [shape=(joints,)]
            Where each joint was sent last, where it is [rad], and its motor's current [mA].
        wishes : sequence of Wish
            That of the highest priority first.
        dt_s : float
            Since the step before [s].

        Returns
        -------
        np.ndarray [shape=(joints,)]
            Finite, as long as `goal_rad` and `q_rad` are [rad].
        """
        config = self._config
        free = np.ones(len(goal_rad), dtype=bool)
        wanted = np.zeros(len(goal_rad))
        lasting = np.zeros(len(goal_rad))  # what of it is not to be at once
        at_once = np.zeros(len(goal_rad), dtype=bool)
        for wish in filter(self.is_usable, wishes):
            wanted[free] += wish.steps[free]
            if wish.at_once:
                at_once |= free & (wish.steps != 0.0)
            else:
                lasting[free] += wish.steps[free]
            if wish.claimed is not None:
                free &= ~wish.claimed
        for steps in (wanted, lasting):
            np.clip(steps, -config.max_steps, config.max_steps, out=steps)
        rise = config.steps_rise_per_s * dt_s
        shaped = np.clip(wanted, self._steps - rise, self._steps + rise)
        self._steps = np.where(at_once, lasting, shaped)
        now = np.where(at_once, wanted, shaped)
        is_exhausted = current_ma > config.max_grip_current_ma
        for steps in (now, self._steps):
            steps[is_exhausted & (steps > 0.0)] = 0.0  # closed no further: it may only open
        moved = goal_rad + self.step_rad_s * now * dt_s
        moved = np.clip(moved, q_rad - self._lead, q_rad + self._lead)
        result: Array = np.clip(moved, self._hand.lower_rad, self._hand.upper_rad)
        return result
