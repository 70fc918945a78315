# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the control loop knows of a robot: it tilts a plate, tells its state, and stops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import radians
from typing import NamedTuple, Protocol

from acts_core.errors import RobotError
from acts_core.settings import Changeable, setting, validate


@dataclass(frozen=True)
class TiltLimits:
    """How far and how fast the plate may be tilted, whatever carries it."""

    max_tilt_rad: float = setting(
        round(radians(6.0), 6),
        "largest angle between plate and level [rad]",
        minimum=0.001,
        maximum=0.35,
        changeable=Changeable.RUNNING,
    )
    max_tilt_rate_rad_s: float = setting(
        1.0,
        "largest rate of the tilt about each axis [rad/s]",
        minimum=0.01,
        maximum=3.0,
        changeable=Changeable.RUNNING,
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class RobotConfig(TiltLimits):
    """Settings that every robot looks at; those of a robot are a subclass of this."""

    control_rate_hz: int = setting(
        125, "rate of control steps and commands [Hz]: 125, 250 or 500", minimum=125, maximum=500
    )
    loopback_only: bool = setting(
        False, "for a simulated skin: refuse a real robot, and a robot_ip that is no numeric address of this machine"
    )

    def __post_init__(self) -> None:
        validate(self)


class RobotStoppedError(RobotError):
    """A safety function holds the robot, or it is not ready to move; a person has to change that at the robot."""


class CommandRefusedError(RobotError):
    """The robot's own last check has refused a tilt. Nothing was sent; other tilts may follow."""


class RobotReading(NamedTuple):
    """What a robot says of itself.

    Attributes
    ----------
    connected : bool
    time_s : float
        The robot's own clock, which stands still when the robot is lost [s].
    joints : tuple of float
        Positions of its joints, of any number [rad, or m where a joint slides].
    off_level : float
        How far the joint that is farthest from the level pose is from it, in the joint's unit.
    tilt_rad : (float, float)
        Measured tilt of the plate: rotation vector about the skin's x and y axes, away from level [rad].
    stopped : str
        Why the robot does not do what it is told, in words; empty while it does.
    waiting_s : float
        How long the oldest command that has not been taken yet has been waiting [s].
    silent_s : float
        How long the robot had told nothing before this: what is not connected any more may have been silent first [s].
    """

    connected: bool
    time_s: float
    joints: tuple[float, ...]
    off_level: float
    tilt_rad: tuple[float, float]
    stopped: str = ""
    waiting_s: float = 0.0
    silent_s: float = 0.0


class Robot(Protocol):
    """A robot that carries the plate. Nothing but `connect` waits; every method may raise `RobotError`.

    After a `RobotError` the robot counts as lost and only `disconnect` is called. Their order otherwise: `connect`;
    `begin_levelling`, and `end_levelling` where it is broken off; `tilt` again and again, then `end_tilting`;
    `release`, `disconnect`. `read` may be called at any time after `connect`.
    """

    @property
    def address(self) -> str:
        """Where it is, for messages to people."""

    @property
    def longest_step_rad(self) -> float:
        """How far a tilt may be from the one before it, about each axis [rad]; beyond that it may be refused."""

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        """Connect and take control; soon gives up, with a `RobotError`, when it is not wanted any more.

        Raises
        ------
        RobotStoppedError
            When a person has to release the robot, or to make it ready, first.
        """

    def read(self) -> RobotReading:
        """The newest state; costs microseconds."""

    @property
    def is_busy(self) -> bool:
        """Whether something that was asked for has not been carried out yet. (Levelling counts once it has begun.)"""

    def begin_levelling(self) -> float:
        """Start to move to the level pose; the longest time that this may take [s]."""

    def end_levelling(self) -> None:
        """Break that off; the robot comes to rest."""

    def tilt(self, tilt_x_rad: float, tilt_y_rad: float) -> tuple[float, ...]:
        """Aim for a tilt of the plate; to be called `control_rate_hz` times a second, from the level pose on.

        Parameters
        ----------
        tilt_x_rad, tilt_y_rad : float
            Rotation vector about the skin's x and y axes, away from level [rad].

        Returns
        -------
        tuple of float
            The joint positions that were sent for it, like those of `RobotReading`.

        Raises
        ------
        CommandRefusedError
            When the tilt, or a joint position or speed that it needs, is not finite or beyond its limit.
        """

    def end_tilting(self) -> None:
        """Stop following; the robot holds its pose."""

    def release(self) -> None:
        """Give up control of the robot. Does nothing where there is no connection."""

    def disconnect(self) -> None:
        """Cut the connection; no command is sent any more. May be called again."""
