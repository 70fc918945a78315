# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the control of a hand needs of its motors, whichever they are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from acts_core.errors import ActsError, SettingsError
from acts_core.settings import setting, validate


class HandError(ActsError):
    """The hand cannot be reached, refuses a command, or has switched itself off."""


class HandLostError(HandError):
    """The port of the hand is gone; it has to be connected anew."""


@dataclass(frozen=True)
class BusConfig:
    """The setting that motors of every make have; those of a make are a subclass of this."""

    port: str = setting("/dev/ttyUSB0", "serial port of the motors")

    def __post_init__(self) -> None:
        validate(self)
        if not self.port.strip():
            raise SettingsError("port is empty: needed is the serial port of the motors, such as /dev/ttyUSB0")

    def check_rate(self, rate_hz: float) -> None:
        """Refuse a rate of the hand's loop at which these motors would stop by themselves; any is right here.

        Raises
        ------
        SettingsError
            With what is allowed.
        """

    def check_grip_current(self, max_grip_current_ma: float) -> None:
        """Refuse a limit of the grip that the current of these motors never reaches; any is right here.

        Raises
        ------
        SettingsError
            With what is allowed.
        """


class HandReading(NamedTuple):
    """What the motors say of themselves, in the order of the joints.

    Attributes
    ----------
    q_rad, qd_rad_s : tuple of float
        Angle and speed of each joint.
    current_ma : tuple of float
        Positive where the motor closes the joint [mA].
    temperature_c : tuple of int
    faults : tuple of str
        In words; empty for a motor that is well.
    is_stopped : bool
        Whether a motor has heard nothing for so long that it takes no goals any more, until the torque is switched on
        again.
    """

    q_rad: tuple[float, ...]
    qd_rad_s: tuple[float, ...]
    current_ma: tuple[float, ...]
    temperature_c: tuple[int, ...]
    faults: tuple[str, ...]
    is_stopped: bool = False

    def not_finite(self) -> str:
        """Which of its numbers are not finite, in words; empty where all are.

        A current that is none would be below every limit.
        """
        told = {"angles": self.q_rad, "speeds": self.qd_rad_s, "currents": self.current_ma}
        for what, numbers in told.items():
            if not all(map(math.isfinite, numbers)):
                return f"{what} that are not finite: {numbers}"
        return ""


def finite_angles(q_rad: Sequence[float], joints: int) -> list[float]:
    """The angles of so many joints, for who sends them and looks at them last [rad].

    Raises
    ------
    HandError
        When one is not finite, or their number is wrong.
    """
    q = [float(angle) for angle in q_rad]
    if len(q) != joints or not all(map(math.isfinite, q)):
        raise HandError(f"joint angles {q} cannot be sent: {joints} finite numbers are needed")
    return q


class HandBus(Protocol):
    """The motors of a hand. Every method may raise `HandError`: it is logged, and the motors are connected anew.

    That of `read` and `command` is only counted, unless it is a `HandLostError` or goes on for `silence_s`.

    The hand's loop (`acts_control.hand.control.HandLoop`) calls all of them, from one thread. Motors that hear nothing
    for a while have to stop by themselves.
    """

    def connect(self) -> list[str]:
        """Find all motors and set them up, with the torque off; what a person should know of, in sentences.

        Called again and again until it succeeds, each time after `disconnect`. Motors that have switched themselves
        off are told by `read`.
        """

    def enable(self) -> None:
        """Switch the torque on; every joint holds where it is."""

    def release(self) -> None:
        """Switch the torque off."""

    def read(self) -> HandReading:
        """The newest state of all motors; called at the rate of the loop, also while the torque is off."""

    def command(self, q_rad: Sequence[float]) -> None:
        """Send every joint to an angle; finite, near the angle before.

        It is within the limits of the joint, or on the way back to them from where the joint was at `enable`.
        """

    def recover(self, joint: int) -> None:
        """Bring a motor back that has switched itself off; its torque stays off."""

    def disconnect(self) -> None:
        """Give the port back, until the next `connect`; the hand stays this program's own."""

    def close(self) -> None:
        """Give port and hand back; the torque stays as it is."""
