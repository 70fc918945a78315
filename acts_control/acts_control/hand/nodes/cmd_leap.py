# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The LEAP hand through the LEAP team's own ROS node: angles go out on `cmd_leap`, nothing comes back.

That node (package `leap_hand` of LEAP_Hand_API) takes sensor_msgs/JointState with 16 positions in the order of the
motors, open and flat at pi, and opens the hand when it starts. It publishes no joint states and cannot switch the
torque off, so what is told here as read is what was sent, and before that the open hand.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from acts_control.hand.description import HandDescription
from acts_control.hand.motors import HandReading, finite_angles
from acts_core.errors import SettingsError

_JOINTS = 16

TORQUE_STAYS = (
    "nothing is sent until enable is called; the torque stays on: it is the LEAP team's node's, which cannot switch it "
    "off; cut the power of the hand, or move it by interface:=dynamixel"
)
"""What a person should know who asks for the torque to be switched off."""


class CmdLeapBus:
    """A hand that somebody else's node moves.

    Parameters
    ----------
    hand : HandDescription
    publish : callable
        Takes the motors' angles, in the order of their IDs [rad]; raises `HandError` where they are not sent.

    Raises
    ------
    SettingsError
        When the hand has another number of joints than the LEAP team's node moves.
    """

    def __init__(self, hand: HandDescription, publish: Callable[[list[float]], None]) -> None:
        if len(hand.joints) != _JOINTS:
            raise SettingsError(
                f"interface = cmd_leap: the LEAP team's node moves {_JOINTS} joints; {hand.name} has "
                f"{len(hand.joints)}: move it by its own motors, as with interface:=dynamixel"
            )
        self._hand = hand
        self._publish = publish
        self._order = sorted(range(len(hand.joints)), key=lambda k: hand.joints[k].motor_id)
        self._q = tuple(joint.clipped(0.0) for joint in hand.joints)

    def connect(self) -> list[str]:
        """Nothing to connect to; what a person should know of."""
        return [
            "through cmd_leap nothing is read from the motors, and no watchdog stops them: faults are not seen, and "
            "enable sends the angles of the open hand first, or after a release those that were sent last"
        ]

    def enable(self) -> None:
        """From here on angles are sent, first those that `read` tells."""

    def release(self) -> None:
        """Send nothing more; the torque is the other node's, see `TORQUE_STAYS`."""

    def read(self) -> HandReading:
        """What was sent last; before that the open hand."""
        count = len(self._q)
        return HandReading(self._q, (0.0,) * count, (0.0,) * count, (0,) * count, ("",) * count)

    def command(self, q_rad: Sequence[float]) -> None:
        """Publish the motors' angles.

        Raises
        ------
        HandError
            When an angle is not finite, their number is wrong, or they are not published: nothing is sent then.
        """
        joints = self._hand.joints
        finite = finite_angles(q_rad, len(joints))
        q = tuple(joint.clipped(angle) for joint, angle in zip(joints, finite, strict=True))
        self._publish([joints[k].to_motor_rad(q[k]) for k in self._order])
        self._q = q

    def recover(self, joint: int) -> None:
        """Nothing can be done from here."""

    def disconnect(self) -> None:
        """Nothing to give back."""

    def close(self) -> None:
        """Nothing to give back."""
