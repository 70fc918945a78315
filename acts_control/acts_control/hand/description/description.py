# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a hand is, whatever moves it: its joints in the order of all joint arrays, links, fingers, patches of skin."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.transforms import Transform, Vector

Role = Literal["palm", "proximal", "medial", "distal"]
ROLES: tuple[Role, ...] = ("palm", "proximal", "medial", "distal")
"""Of a patch of skin; the last three along a finger, from its root to its tip."""


@dataclass(frozen=True)
class Joint:
    """One joint, moved by one motor.

    Attributes
    ----------
    name : str
    motor_id : int
        On the bus.
    lower_rad, upper_rad : float
        How far it may turn; positive angles close the hand [rad].
    motor_zero_rad : float
        The motor's own angle where the joint's is 0 [rad].
    direction : int
        1, or -1 where the motor turns against the joint.
    gain_scale : float
        Factor on the motor's P and D gains.
    step_scale : float
        Factor on how far a step of a reflex moves the joint.

    Raises
    ------
    SettingsError
        When made with limits that are not finite or the wrong way round.
    """

    name: str
    motor_id: int
    lower_rad: float
    upper_rad: float
    motor_zero_rad: float = math.pi
    direction: int = 1
    gain_scale: float = 1.0
    step_scale: float = 1.0

    def __post_init__(self) -> None:
        numbers = (self.lower_rad, self.upper_rad, self.motor_zero_rad, self.gain_scale, self.step_scale)
        finite = all(map(math.isfinite, numbers))
        if not finite or not self.lower_rad < self.upper_rad:
            raise SettingsError(
                f"joint {self.name}: limits {self.lower_rad} and {self.upper_rad} rad; allowed are two finite numbers, "
                f"the lower one first"
            )
        scales = (self.gain_scale, self.step_scale)
        if self.direction not in (-1, 1) or not 0 <= self.motor_id <= 252 or not all(0.0 < s <= 10.0 for s in scales):
            raise SettingsError(
                f"joint {self.name}: direction {self.direction}, motor_id {self.motor_id}, gain_scale and step_scale "
                f"{scales}; allowed are 1 or -1, 0 to 252, above 0 to 10"
            )

    def to_motor_rad(self, q_rad: float) -> float:
        """The motor's angle for an angle of the joint."""
        return self.motor_zero_rad + self.direction * q_rad

    def from_motor_rad(self, motor_rad: float) -> float:
        """The joint's angle for an angle of the motor."""
        return self.direction * (motor_rad - self.motor_zero_rad)

    def clipped(self, q_rad: float) -> float:
        """The nearest angle within the limits."""
        return min(max(q_rad, self.lower_rad), self.upper_rad)


@dataclass(frozen=True)
class Link:
    """A rigid part, turned by one joint about an axis through its origin.

    Attributes
    ----------
    name, parent, joint : str
        The parent is another link or the hand's base.
    pose : Transform
        In the parent's frame, where the joint is at 0.
    axis : tuple of float
        In the link's own frame, of length 1.
    """

    name: str
    parent: str
    joint: str
    pose: Transform
    axis: Vector


@dataclass(frozen=True)
class Finger:
    """A finger, or a thumb.

    Attributes
    ----------
    name : str
    closes : mapping of str to float
        The joints that close it, and how much each takes part, compared with the others.
    tip_link : str
    tip_m : tuple of float
        In the frame of `tip_link` [m].
    opposes : bool
        Whether it comes from the other side than most, as a thumb does.
    """

    name: str
    closes: Mapping[str, float]
    tip_link: str
    tip_m: Vector
    opposes: bool = False


@dataclass(frozen=True)
class Region:
    """A patch of the hand's skin.

    Attributes
    ----------
    name : str
        As in the layout of the skin.
    link : str
        That carries it.
    finger : str
        Empty for the palm.
    role : str
        One of `ROLES`.
    centre_m, normal : tuple of float
        Its middle [m] and the unit vector out of the skin there, in the link's frame; of a palm, where an object is
        brought to; of a finger's last region, what it touches small things with. Zeros where nobody asks.
    """

    name: str
    link: str
    finger: str
    role: Role
    centre_m: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class HandDescription:
    """A hand.

    Attributes
    ----------
    name : str
    joints : tuple of Joint
        With different names and motors.
    base : str
        The link that nothing moves.
    links : tuple of Link
        Parents before their children.
    fingers : mapping of str to Finger
    regions : mapping of str to Region
    postures : mapping of str to tuple of float
        Angles of all joints [rad].

    Raises
    ------
    SettingsError
        When two joints share a name or a motor, or there is none.
    """

    name: str
    joints: tuple[Joint, ...]
    base: str = "palm"
    links: tuple[Link, ...] = ()
    fingers: Mapping[str, Finger] = field(default_factory=dict)
    regions: Mapping[str, Region] = field(default_factory=dict)
    postures: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        names, motors = [one.name for one in self.joints], [one.motor_id for one in self.joints]
        if not names or len(set(names)) < len(names) or len(set(motors)) < len(motors):
            raise SettingsError(
                f"hand {self.name}: joints {names} with motors {motors}; at least one is needed, and no name or motor "
                f"may occur twice"
            )

    @property
    def names(self) -> list[str]:
        """Of the joints, in order."""
        return [joint.name for joint in self.joints]

    @cached_property
    def lower_rad(self) -> NDArray[np.float64]:
        """Of all joints, shape (joints,) [rad]."""
        return np.array([joint.lower_rad for joint in self.joints])

    @cached_property
    def upper_rad(self) -> NDArray[np.float64]:
        """Of all joints, shape (joints,) [rad]."""
        return np.array([joint.upper_rad for joint in self.joints])
