# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a reflex is given, and what it answers with."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import HandDescription, HandKinematics, HandPose, Role
from acts_core.errors import SettingsError
from acts_core.skin import RegionContact

Array = NDArray[np.float64]

# A reflex that did not act for no longer has not been set off again: at the edge of what sets it off it comes and goes.
_PAUSE_S = 0.5


class HandState(IntEnum):
    """What the hand does; the numbers are those of the message HandStatus."""

    STOPPED = 0
    OPEN = 1
    CLOSING = 2
    HOLDING = 3
    AVOIDING = 4


@dataclass(frozen=True)
class Sensed:
    """One moment of the hand, in the order of its joints.

    Attributes
    ----------
    time_s : float
        By a clock that never goes back [s].
    dt_s : float
        Since the step before [s].
    state : HandState
    kinematics : HandKinematics
    q_rad, goal_rad : np.ndarray [shape=(joints,)]
        Where each joint is, and where it was sent last [rad].
    current_ma : np.ndarray [shape=(joints,)]
        Positive where the motor closes the joint [mA].
    step_rad_s : np.ndarray [shape=(joints,)]
        How fast one step moves each joint's goal [rad/s].
    regions : mapping of str to RegionContact
        The newest of each patch; those that the hand's description does not have are left out.
    is_new : bool
        Whether they have come since the step before.
    is_shaped : bool
        Whether a hand that closes has come into the shape from which it does.
    """

    time_s: float
    dt_s: float
    state: HandState
    kinematics: HandKinematics
    q_rad: Array
    goal_rad: Array
    current_ma: Array
    step_rad_s: Array
    regions: Mapping[str, RegionContact]
    is_new: bool = True
    is_shaped: bool = True

    @property
    def hand(self) -> HandDescription:
        """The hand."""
        return self.kinematics.hand

    @cached_property
    def pose(self) -> HandPose:
        """Where its links are; worked out when somebody asks."""
        return self.kinematics.at(self.q_rad)

    def role(self, region: str) -> Role:
        """What part of the hand a region is."""
        return self.hand.regions[region].role

    def finger(self, region: str) -> str:
        """Whose region it is; empty for the palm."""
        return self.hand.regions[region].finger

    def of_finger(self, finger: str) -> list[RegionContact]:
        """The regions of one finger, in the order of the description; of the palm for an empty name."""
        return [one for name, one in self.regions.items() if self.hand.regions[name].finger == finger]

    def steps(self) -> Array:
        """An answer of no step, to be filled in; shape (joints,)."""
        return np.zeros(len(self.q_rad))

    def moving_joints(self) -> dict[str, int]:
        """For each region of a finger, the last joint before its link that closes the finger."""
        links = {link.name: link for link in self.hand.links}
        number = {name: k for k, name in enumerate(self.hand.names)}
        found = {}
        for name, region in self.hand.regions.items():
            link = links.get(region.link)
            while link is not None and region.finger:
                if link.joint in self.hand.fingers[region.finger].closes:
                    found[name] = number[link.joint]
                    break
                link = links.get(link.parent)
        return found

    def closing(self, finger: str) -> Array:
        """How much each joint takes part when a finger closes, shape (joints,); 1 for the one that takes most part."""
        return _closing(self.hand, finger)


class Wish(NamedTuple):
    """What a reflex asks for in one step.

    Attributes
    ----------
    steps : np.ndarray [shape=(joints,)]
        How fast each joint's goal is to move, in units of `Sensed.step_rad_s`; positive closes. A wish lasts for this
        step of the loop only, and the speed is the same at any rate. See `acts_control.hand.control.step_rule`.
    why : str
        In words, for a person.
    claimed : np.ndarray [shape=(joints,), dtype=bool] or None
        Joints that reflexes of lower priority are to leave alone.
    at_once : bool
        Whether the steps are made without the rate shaping.
    avoids : bool
        Whether the hand is to count as avoiding something.
    holds : bool
        Whether a hand that closes is to count as holding.
    """

    steps: Array
    why: str
    claimed: NDArray[np.bool_] | None = None
    at_once: bool = False
    avoids: bool = False
    holds: bool = False


class Reflex(ABC):
    """A behaviour; `config` is an instance of its `Config`.

    Attributes
    ----------
    events : int
        How often it has been set off.
    """

    Config: ClassVar[type]
    """Dataclass of `acts_core.settings.setting` fields; their names begin with its own, for all become parameters."""
    priority: ClassVar[int]
    """The highest is asked first."""
    states: ClassVar[frozenset[HandState]]
    """In which it is asked."""
    pressing: ClassVar[tuple[str, ...]] = ()
    """Its settings that are forces to press with [N]."""

    def __init__(self, config: Any) -> None:
        self.config = config
        self.events = 0
        self._acted_s = -math.inf  # when it acted last, for those that act for as long as something lasts
        self.reset()

    def note_acting(self, time_s: float) -> None:
        """Count that it has been set off, unless it did nothing but pause: to be called in each step in which it acts.

        Parameters
        ----------
        time_s : float
            Of the step [s].
        """
        self.events += time_s - self._acted_s > _PAUSE_S
        self._acted_s = time_s

    def check(self, grip_force_n: float, max_force_n: float) -> None:
        """Refuse settings that do not go together with those of the hand.

        Parameters
        ----------
        grip_force_n, max_force_n : float
            What a finger that closes is to feel, and what it gives way at, whatever is asked for [N].

        Raises
        ------
        SettingsError
            With what is allowed.
        """
        for name in self.pressing:
            force_n = getattr(self.config, name)
            if force_n >= max_force_n:
                raise SettingsError(
                    f"{name} = {force_n:g}: allowed is less than max_force_n = {max_force_n:g}, at which a finger "
                    f"gives way, or it would press and open in turn"
                )

    @abstractmethod
    def reset(self) -> None:
        """Forget what was: a new grasp begins, or touch has come back after a pause."""

    @abstractmethod
    def step(self, sensed: Sensed) -> Wish | None:
        """What it asks for now; None for nothing."""


# With the description itself, so that no other one gets its identity meanwhile.
_CLOSING: dict[tuple[int, str], tuple[HandDescription, Array]] = {}


def _closing(hand: HandDescription, finger: str) -> Array:
    # Asked for many times a step, and the same for the life of a description.
    key = (id(hand), finger)
    if key not in _CLOSING:
        shares = hand.fingers[finger].closes
        # Whatever unit a description has for them, a finger that gives way opens as fast as is asked for.
        _CLOSING[key] = hand, np.array([shares.get(name, 0.0) for name in hand.names]) / max(shares.values())
    return _CLOSING[key][1]
