# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand of Dynamixel motors (XC330, XL330), such as the LEAP hand.

A group read drops the motors' error bytes, so the hardware error is read as a register, and all that is read each cycle
is gathered by indirect addresses.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from acts_control.hand.description import HandDescription, Joint
from acts_control.hand.motors import dynamixel_table as table
from acts_control.hand.motors.bus import HandError, HandLostError, HandReading, finite_angles
from acts_control.hand.motors.dynamixel_config import DynamixelConfig
from acts_control.hand.motors.dynamixel_eeprom import check_eeprom
from acts_control.hand.motors.dynamixel_port import DynamixelPort, name_of
from acts_control.hand.motors.port_words import usb_latency

# A motor that has been told to start anew does not answer meanwhile.
_REBOOT_TIMEOUT_S = 2.0


class DynamixelHand:
    """A hand of Dynamixel motors.

    Parameters
    ----------
    hand : HandDescription
    config : DynamixelConfig

    Raises
    ------
    SettingsError
        When a gain times the gain_scale of a joint is more than its motor takes.
    """

    def __init__(self, hand: HandDescription, config: DynamixelConfig) -> None:
        self._hand = hand
        self._config = config
        self._gains = [config.gains(joint) for joint in hand.joints]
        self._port = DynamixelPort(config)
        self._is_on = False  # whether the torque of all motors was switched on
        self._is_set_up = [False] * len(hand.joints)
        self._goal_rad = [joint.clipped(0.0) for joint in hand.joints]
        # Of each motor what it said last; none before.
        self._said: list[table.Gathered | None] = [None] * len(hand.joints)

    def connect(self) -> list[str]:
        """Open the port, find all motors, set them up with the torque off.

        A motor that has switched itself off is set up by `recover`: `read` tells of it.

        Returns
        -------
        list of str
            What a person should know of, in sentences.

        Raises
        ------
        HandError
            When the port cannot be opened, or a motor is missing (all of them are named), of another kind, or refuses,
            or its EEPROM lets it move otherwise than it is told. The torque of the others is off.
        """
        self._is_on = False
        self._said = [None] * len(self._hand.joints)
        self._port.open()
        try:
            # What a crashed program has left on is off from here on, whatever fails below. Motors that hear this and
            # cannot answer would hear all that is said to the others, too, and not be stopped by their watchdog.
            self._switch_all_off()
            self._find_all()
            # With torque, the operating mode would be locked.
            self._each(table.TORQUE, 0)
            # Where it has stopped a motor, that would refuse the goal current.
            self._each(table.WATCHDOG, 0)
            told = check_eeprom(self._port, self._hand.joints, self._config)
            told += usb_latency(Path(self._config.port))
            if not self._config.motor_watchdog_s:
                told.append("motor_watchdog_s is 0: nothing stops the motors when this program hangs or dies")
            for index, joint in enumerate(self._hand.joints):
                self._is_set_up[index] = not self._port.read(joint, table.HARDWARE_ERROR)
                if self._is_set_up[index]:
                    self._set_up(index)
                self._choose_what_is_read(joint)
        except HandError:
            self.disconnect()
            raise
        motor_ids = [joint.motor_id for joint in self._hand.joints]
        self._port.choose(motor_ids, table.INDIRECT_DATA, len(table.GATHERED))
        return told

    def enable(self) -> None:
        """Switch the torque on; every joint holds where it is. Where that fails half-way, it is switched off again.

        A motor that switches itself off meanwhile is told by `read`, and the others hold.
        """
        watchdog = math.ceil(self._config.motor_watchdog_s / table.WATCHDOG_UNIT_S)
        try:
            for index, joint in enumerate(self._hand.joints):
                self._port.write(joint, table.WATCHDOG, 0)
                # One whose power was gone for a moment has forgotten it, and would press as hard as it can.
                self._port.write(joint, table.GOAL_CURRENT, self._config.max_current_ma)
                position = self._port.read(joint, table.POSITION)
                self._port.write(joint, table.GOAL_POSITION, position)
                self._goal_rad[index] = _angle_rad(joint, table.signed(position.to_bytes(4, "little")))
                self._switch_on(joint)
                # What comes in between, such as a cable torn off, leaves no motor on without a watchdog.
                self._port.write(joint, table.WATCHDOG, table.LONGEST_WATCHDOG if watchdog else 0)
            for joint in self._hand.joints:
                self._watch(joint, watchdog)
        except HandError:
            with suppress(HandError):
                self.release()
            raise
        self._is_on = True

    def _switch_on(self, joint: Joint) -> None:
        """Switch the torque of a motor on, unless it has switched itself off, which it then refuses to undo."""
        try:
            self._port.write(joint, table.TORQUE, 1)
        except HandLostError:
            raise
        except HandError:
            if not self._port.read(joint, table.HARDWARE_ERROR):
                raise

    def _watch(self, joint: Joint, watchdog: int) -> None:
        """Set the watchdog of a motor, also where that has stopped it since it was switched on."""
        try:
            self._port.write(joint, table.WATCHDOG, watchdog)
        except HandLostError:
            raise
        except HandError:
            # This program has stood still: such a motor takes nothing but 0.
            self._port.write(joint, table.WATCHDOG, 0)
            self._port.write(joint, table.WATCHDOG, watchdog)

    def release(self) -> None:
        """Switch the torque off, also where some motors do not answer.

        Raises
        ------
        HandError
            Naming the motors that did not say that they have done so.
        """
        self._is_on = False
        # To all at once first: one after the other, each that is silent would keep the torque of those after it on.
        try:
            self._switch_all_off()
        except HandLostError:
            raise
        except HandError:
            pass  # each is asked below
        silent = []
        for joint in self._hand.joints:
            try:
                self._port.write(joint, table.TORQUE, 0)
            except HandLostError:
                raise
            except HandError:
                silent.append(name_of(joint))
        if silent:
            raise HandError(f"motors {', '.join(silent)} did not answer when they were switched off")

    def read(self) -> HandReading:
        """The newest state of all motors; of one that has lost its power, that from before.

        Raises
        ------
        HandError
            When the answer does not come, or is damaged, or a motor has lost its power before it has said anything.
        HandLostError
            When the port is gone.
        """
        joints = self._hand.joints
        states = [table.Gathered.of(data) for data in self._port.gather()]
        known = [one if one.is_what_was_chosen else said for one, said in zip(states, self._said, strict=True)]
        pairs = []
        for joint, one in zip(joints, known, strict=True):
            if one is None:
                raise HandError(f"motor {name_of(joint)} has lost its power")
            pairs.append((joint, one))
        self._said = known
        return HandReading(
            tuple(_angle_rad(joint, one.ticks) for joint, one in pairs),
            tuple(joint.direction * one.speed * table.RAD_S_PER_UNIT for joint, one in pairs),
            tuple(float(joint.direction * one.current) for joint, one in pairs),
            tuple(one.temperature_c for _, one in pairs),
            tuple(table.fault_words(one.hardware_error) or self._unwell(k, one) for k, one in enumerate(states)),
            any(one.watchdog == table.WATCHDOG_EXPIRED for one in states),
        )

    def _unwell(self, index: int, state: table.Gathered) -> str:
        """What is to be told of a motor that has no error now."""
        if not self._is_set_up[index]:
            return "it had switched itself off"
        # Its power was gone for a moment.
        if self._is_on and not state.torque:
            return "torque is off, as after a loss of power"
        return "" if state.is_what_was_chosen else "its settings are gone, as after a loss of power"

    def command(self, q_rad: Sequence[float]) -> None:
        """Send every joint to an angle, in one packet that nobody answers.

        A joint that was beyond a limit when the torque came on may be sent back from there, but no farther out.

        Raises
        ------
        HandError
            When an angle is not finite, or their number is wrong: nothing is sent then.
        """
        joints = self._hand.joints
        q = finite_angles(q_rad, len(joints))
        self._goal_rad = [
            min(max(angle, min(joint.lower_rad, before)), max(joint.upper_rad, before))
            for joint, angle, before in zip(joints, q, self._goal_rad, strict=True)
        ]
        self._port.send(
            table.GOAL_POSITION,
            {
                joint.motor_id: round(joint.to_motor_rad(angle) * table.TICKS_PER_RAD)
                for joint, angle in zip(joints, self._goal_rad, strict=True)
            },
        )

    def recover(self, joint: int) -> None:
        """Start a motor anew that has switched itself off, and set it up; its torque stays off.

        Raises
        ------
        HandError
            When it does not come back within two seconds.
        """
        self._is_on = False
        motor = self._hand.joints[joint]
        try:
            self._port.reboot(motor)
        except HandLostError:
            raise
        except HandError:
            pass  # its answer may have been lost: it starts anew, and does not answer where it is asked again
        deadline_s = time.monotonic() + _REBOOT_TIMEOUT_S
        while True:
            try:
                self._port.ping(motor)
                break
            except HandLostError:
                raise
            except HandError:
                if time.monotonic() > deadline_s:
                    raise
        self._set_up(joint)
        self._is_set_up[joint] = True
        self._choose_what_is_read(motor)

    def close(self) -> None:
        """Give port and hand back; the torque stays as it is."""
        self._port.close()

    def disconnect(self) -> None:
        """Give the port back, until the next `connect`; a program that waits for the hand does not get it meanwhile."""
        self._port.disconnect()

    # --- one after the other

    def _switch_all_off(self) -> None:
        """In one packet that nobody answers."""
        self._port.send(table.TORQUE, {joint.motor_id: 0 for joint in self._hand.joints})

    def _each(self, register: table.Register, value: int) -> None:
        for joint in self._hand.joints:
            self._port.write(joint, register, value)

    def _find_all(self) -> None:
        missing, found = [], []
        for joint in self._hand.joints:
            try:
                model = self._port.ping(joint)
            except HandLostError:
                raise
            except HandError:
                missing.append(name_of(joint))
                continue
            if model not in table.MODELS:
                kinds = " and ".join(f"{number} ({name})" for number, name in table.MODELS.items())
                raise HandError(f"motor {name_of(joint)} is of model {model}; known are {kinds}")
            found.append(joint)
        if missing:
            for joint in found:
                # Where what nobody answers has been lost, their torque is on, with nobody who commands them.
                with suppress(HandError):
                    self._port.write(joint, table.TORQUE, 0)
            raise HandError(
                f"motors {', '.join(missing)} do not answer at {self._config.port} with {self._config.baud} baud; "
                f"check the power, the cables in front of the first of them, and their IDs"
            )

    def _set_up(self, index: int) -> None:
        joint = self._hand.joints[index]
        # Another mode brings the gains and the current back to its own: they come after it. An EEPROM wears out by
        # being written.
        if self._port.read(joint, table.MODE) != table.CURRENT_BASED_POSITION:
            self._port.write(joint, table.MODE, table.CURRENT_BASED_POSITION)
        for register, gain in zip((table.P_GAIN, table.I_GAIN, table.D_GAIN), self._gains[index], strict=True):
            self._port.write(joint, register, gain)
        self._port.write(joint, table.GOAL_CURRENT, self._config.max_current_ma)
        # What another program has left would weaken the motor.
        self._port.write(joint, table.GOAL_PWM, self._port.read(joint, table.PWM_LIMIT))
        # Goals come at a limited speed already; what another program has left would be a second limit.
        for register in (table.PROFILE_ACCELERATION, table.PROFILE_VELOCITY):
            self._port.write(joint, register, 0)

    def _choose_what_is_read(self, joint: Joint) -> None:
        for register, address in zip(table.INDIRECT_ADDRESSES, table.GATHERED, strict=False):
            self._port.write(joint, register, address)


def _angle_rad(joint: Joint, ticks: int) -> float:
    return joint.from_motor_rad(ticks / table.TICKS_PER_RAD)
