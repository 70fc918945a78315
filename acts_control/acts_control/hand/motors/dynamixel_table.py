# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control table of the motors of a LEAP hand: which registers are used, their units, what their values mean.

Source: the e-manual of the XC330-M288; the XL330-M288 has the same addresses.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class Register(NamedTuple):
    """One item of the control table: its address, and its size in bytes."""

    address: int
    size: int


RETURN_DELAY, DRIVE_MODE, MODE, HOMING_OFFSET = Register(9, 1), Register(10, 1), Register(11, 1), Register(20, 4)
SECONDARY_ID, PWM_LIMIT, CURRENT_LIMIT = Register(12, 1), Register(36, 2), Register(38, 2)
STARTUP, SHUTDOWN = Register(60, 1), Register(63, 1)
TORQUE, RETURN_LEVEL, HARDWARE_ERROR = Register(64, 1), Register(68, 1), Register(70, 1)
D_GAIN, I_GAIN, P_GAIN = Register(80, 2), Register(82, 2), Register(84, 2)
WATCHDOG, GOAL_PWM, GOAL_CURRENT, GOAL_POSITION = Register(98, 1), Register(100, 2), Register(102, 2), Register(116, 4)
PROFILE_ACCELERATION, PROFILE_VELOCITY = Register(108, 4), Register(112, 4)
CURRENT, POSITION, TEMPERATURE = Register(126, 2), Register(132, 4), Register(146, 1)
INDIRECT_ADDRESSES = tuple(Register(address, 2) for address in range(168, 208, 2))
INDIRECT_DATA = 208

MODELS = {1240: "XC330-M288", 1200: "XL330-M288"}
CURRENT_BASED_POSITION = 5
REVERSED, TORQUE_ON_BY_GOAL = 1 << 0, 1 << 3  # of the drive mode
TORQUE_ON_AT_START = 1 << 0  # of the start-up configuration
PROTECTING = 1 << 2 | 1 << 4 | 1 << 5  # of the shutdown: heat, electrical shock, overload
LARGEST_GAIN = 16383
LARGEST_PWM = 885

WATCHDOG_UNIT_S = 0.02
WATCHDOG_EXPIRED = 255
LONGEST_WATCHDOG = 127

TICKS_PER_RAD = 4096 / (2.0 * math.pi)
RAD_S_PER_UNIT = 0.229 * 2.0 * math.pi / 60.0

# In a status packet's error number: look at the hardware error.
ALERT = 0x80

_FAULTS = {0: "input voltage", 2: "overheating", 3: "encoder", 4: "electrical shock", 5: "overload"}

# Current (2), speed (4) and position (4) follow one another in the control table.
GATHERED = (
    *range(CURRENT.address, CURRENT.address + 10),
    *(register.address for register in (HARDWARE_ERROR, TEMPERATURE, WATCHDOG, TORQUE, RETURN_LEVEL)),
)
"""Addresses of the bytes that are read each cycle, by indirect addresses; `Gathered` takes them apart."""


class Gathered(NamedTuple):
    """What one motor says in a cycle, in its own units."""

    current: int
    speed: int
    ticks: int
    hardware_error: int
    temperature_c: int
    watchdog: int
    torque: int
    return_level: int

    @classmethod
    def of(cls, data: bytes) -> Gathered:
        """From the bytes of `GATHERED`."""
        return cls(signed(data[0:2]), signed(data[2:6]), signed(data[6:10]), *data[10:15])

    @property
    def is_what_was_chosen(self) -> bool:
        """Whether these are the bytes of `GATHERED`: a motor that has lost its power has forgotten which to gather.

        No motor that answers at all has a return level of 0, which is what such a motor has in all these places.
        """
        return self.return_level != 0


def signed(data: bytes) -> int:
    """The number of a register of several bytes."""
    return int.from_bytes(data, "little", signed=True)


def fault_words(hardware_error: int) -> str:
    """A hardware error in words; empty for none."""
    return ", ".join(words for bit, words in _FAULTS.items() if hardware_error >> bit & 1)
