# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What somebody may have set in the EEPROM of the motors, which a hand cannot be moved with, or not well.

The limits of the position are not looked at: they do not count in current-based position control. Nor is that of the
velocity, which is one of the goal velocity alone.
"""

from __future__ import annotations

from collections.abc import Sequence

from acts_control.hand.description import Joint
from acts_control.hand.motors import dynamixel_table as table
from acts_control.hand.motors.bus import HandError
from acts_control.hand.motors.dynamixel_config import DynamixelConfig
from acts_control.hand.motors.dynamixel_port import DynamixelPort, name_of
from acts_core.words import counted

# Register, the bits of it that have to be 0, and what they do otherwise.
_REFUSED = (
    (table.DRIVE_MODE, table.REVERSED, "they turn the other way (drive mode, register 10, bit 0)"),
    (table.DRIVE_MODE, table.TORQUE_ON_BY_GOAL, "a goal switches their torque on (drive mode, register 10, bit 3)"),
    (table.HOMING_OFFSET, 0xFFFFFFFF, "their zero is elsewhere (homing offset, register 20)"),
    (
        table.STARTUP,
        table.TORQUE_ON_AT_START,
        "power switches their torque on (startup configuration, register 60, bit 0)",
    ),
)


def check_eeprom(port: DynamixelPort, joints: Sequence[Joint], config: DynamixelConfig) -> list[str]:
    """Refuse motors that would move otherwise than they are told; tell what else is not as it should be.

    Parameters
    ----------
    port : DynamixelPort
    joints : sequence of Joint
        Their motors' torque is off.
    config : DynamixelConfig

    Returns
    -------
    list of str
        What a person should know of, in sentences.

    Raises
    ------
    HandError
        Naming all motors that turn the other way, count from another zero, switch their torque on by themselves, or do
        what another motor is told; or all that allow less current than the settings.
    """
    registers = dict.fromkeys(register for register, _, _ in _REFUSED)
    values = {register: [port.read(joint, register) for joint in joints] for register in registers}
    wrong = []
    for register, bits, words in _REFUSED:
        those = [joint for joint, value in zip(joints, values[register], strict=True) if value & bits]
        if those:
            wrong.append(f"{words}: {_names(those)}")
    following = _following(port, joints)
    if following:
        wrong.append(f"they do what another motor is told, too (secondary ID, register 12): {following}")
    if wrong:
        raise HandError(
            f"motors are set up as this hand cannot be moved: {'; '.join(wrong)}. Set these to 0, a secondary ID to "
            f"255, with DYNAMIXEL Wizard; where a joint really turns the other way or has another zero, its "
            f"description says so (zero_rad and direction)"
        )
    _check_current_limit(port, joints, config.max_current_ma)
    return [
        *_unprotected(port, joints),
        *_weakened(port, joints),
        *_return_delay(port, joints, set_return_delay=config.set_return_delay),
    ]


def _following(port: DynamixelPort, joints: Sequence[Joint]) -> str:
    """Motors that take the goals of others of this hand, with those others, for a person; empty for none."""
    others = {joint.motor_id: joint for joint in joints}
    found = []
    for joint in joints:
        secondary_id = port.read(joint, table.SECONDARY_ID)
        if secondary_id in others and secondary_id != joint.motor_id:
            found.append(f"{name_of(joint)} follows {name_of(others[secondary_id])}")
    return ", ".join(found)


def _check_current_limit(port: DynamixelPort, joints: Sequence[Joint], max_current_ma: int) -> None:
    """The motors would refuse the goal current, without saying why."""
    limits_ma = [port.read(joint, table.CURRENT_LIMIT) for joint in joints]
    those = [joint for joint, limit_ma in zip(joints, limits_ma, strict=True) if limit_ma < max_current_ma]
    if those:
        raise HandError(
            f"max_current_ma = {max_current_ma}: motors allow less in their EEPROM (current limit, register 38), the "
            f"least {min(limits_ma)} mA: {_names(those)}; lower max_current_ma, or raise the limit with DYNAMIXEL "
            f"Wizard"
        )


def _unprotected(port: DynamixelPort, joints: Sequence[Joint]) -> list[str]:
    those = [joint for joint in joints if ~port.read(joint, table.SHUTDOWN) & table.PROTECTING]
    if not those:
        return []
    return [
        f"motors that do not switch themselves off at overheating, electrical shock or overload (shutdown, register "
        f"63), and may burn: {_names(those)}: set it to {table.PROTECTING} with DYNAMIXEL Wizard"
    ]


def _weakened(port: DynamixelPort, joints: Sequence[Joint]) -> list[str]:
    limits = [port.read(joint, table.PWM_LIMIT) for joint in joints]
    those = [joint for joint, limit in zip(joints, limits, strict=True) if limit < table.LARGEST_PWM]
    if not those:
        return []
    return [
        f"motors that are weaker and slower than they can be, for their PWM is limited (PWM limit, register 36), the "
        f"most to {100 * min(limits) / table.LARGEST_PWM:.0f} %: {_names(those)}: set it to {table.LARGEST_PWM} with "
        f"DYNAMIXEL Wizard"
    ]


def _return_delay(port: DynamixelPort, joints: Sequence[Joint], *, set_return_delay: bool) -> list[str]:
    slow = [joint for joint in joints if port.read(joint, table.RETURN_DELAY)]
    if not slow:
        return []
    if set_return_delay:
        for joint in slow:
            port.write(joint, table.RETURN_DELAY, 0)
        return [f"the return delay of {counted(len(slow), 'motor')} has been set to 0 in their EEPROM"]
    waiting = counted(len(slow), "motor waits before it answers", "motors wait before they answer")
    return [
        f"{waiting} (return delay, register 9, up to 0.5 ms each): "
        f"start once with set_return_delay true, which sets it to 0"
    ]


def _names(joints: Sequence[Joint]) -> str:
    return ", ".join(map(name_of, joints))
