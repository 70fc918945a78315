# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control table of the XC330-M288-T and XL330-M288-T: registers and their addresses.

These motors are those of the LEAP hand. Source: https://emanual.robotis.com/docs/en/dxl/x/xc330-m288/ and
.../xl330-m288/. Both have the same addresses; they differ in model number, limits of current and velocity, gains
and shutdown.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

EEPROM_END = 64
"""Addresses below can be written only while the torque is off."""

SIZE = 256

INDIRECT_COUNT = 20
INDIRECT_ADDRESS = 168
INDIRECT_DATA = 208

TICKS_PER_TURN = 4096

LARGEST_PWM = 885
"""The whole voltage."""

NO_SECONDARY_ID = 253
"""From here on a secondary ID is none."""


@dataclass(frozen=True)
class Register:
    """One item of the control table.

    Attributes
    ----------
    name : str
    address, size : int
        First address, and number of bytes, lowest first.
    initial : int
        Value after power-on.
    minimum, maximum : int or None
        Range of values that may be written; None for both: read-only.
    """

    name: str
    address: int
    size: int
    initial: int = 0
    minimum: int | None = None
    maximum: int | None = None

    @property
    def signed(self) -> bool:
        """Whether its values may be negative."""
        return self.name in _SIGNED

    @property
    def writable(self) -> bool:
        """Whether it can be written at all."""
        return self.minimum is not None


_SIGNED = {
    "homing_offset",
    "goal_pwm",
    "goal_current",
    "goal_velocity",
    "goal_position",
    "present_pwm",
    "present_current",
    "present_velocity",
    "present_position",
    "velocity_trajectory",
    "position_trajectory",
}

_TURNS = 256 * TICKS_PER_TURN

_REGISTERS = (
    Register("model_number", 0, 2, 1240),
    Register("model_information", 2, 4),
    Register("firmware_version", 6, 1, 47),
    Register("id", 7, 1, 1, 0, 252),
    Register("baud_rate", 8, 1, 6, 0, 6),
    Register("return_delay_time", 9, 1, 250, 0, 254),
    Register("drive_mode", 10, 1, 0, 0, 13),
    Register("operating_mode", 11, 1, 3, 0, 16),
    Register("secondary_id", 12, 1, 255, 0, 255),
    Register("protocol_type", 13, 1, 2, 2, 2),
    Register("homing_offset", 20, 4, 0, -1_044_479, 1_044_479),
    Register("moving_threshold", 24, 4, 10, 0, 1023),
    Register("temperature_limit", 31, 1, 70, 0, 100),
    Register("max_voltage_limit", 32, 2, 70, 31, 70),
    Register("min_voltage_limit", 34, 2, 35, 31, 70),
    Register("pwm_limit", 36, 2, LARGEST_PWM, 0, LARGEST_PWM),
    Register("current_limit", 38, 2, 2352, 0, 2352),
    Register("velocity_limit", 44, 4, 350, 0, 2047),
    Register("max_position_limit", 48, 4, 4095, 0, 4095),
    Register("min_position_limit", 52, 4, 0, 0, 4095),
    Register("startup_configuration", 60, 1, 0, 0, 3),
    Register("pwm_slope", 62, 1, 140, 1, 255),
    Register("shutdown", 63, 1, 52, 0, 255),
    Register("torque_enable", 64, 1, 0, 0, 1),
    Register("led", 65, 1, 0, 0, 1),
    Register("status_return_level", 68, 1, 2, 0, 2),
    Register("registered_instruction", 69, 1),
    Register("hardware_error_status", 70, 1),
    Register("velocity_i_gain", 76, 2, 1600, 0, 16383),
    Register("velocity_p_gain", 78, 2, 50, 0, 16383),
    Register("position_d_gain", 80, 2, 500, 0, 16383),
    Register("position_i_gain", 82, 2, 0, 0, 16383),
    Register("position_p_gain", 84, 2, 1100, 0, 16383),
    Register("feedforward_2nd_gain", 88, 2, 0, 0, 16383),
    Register("feedforward_1st_gain", 90, 2, 0, 0, 16383),
    # Units of 20 ms; 255 reads as expired.
    Register("bus_watchdog", 98, 1, 0, 0, 127),
    Register("goal_pwm", 100, 2, LARGEST_PWM, -LARGEST_PWM, LARGEST_PWM),
    Register("goal_current", 102, 2, 2352, -2352, 2352),
    Register("goal_velocity", 104, 4, 0, -2047, 2047),
    Register("profile_acceleration", 108, 4, 0, 0, 32767),
    Register("profile_velocity", 112, 4, 0, 0, 32767),
    Register("goal_position", 116, 4, 2048, -_TURNS, _TURNS),
    Register("realtime_tick", 120, 2),
    Register("moving", 122, 1),
    Register("moving_status", 123, 1),
    Register("present_pwm", 124, 2),
    Register("present_current", 126, 2),
    Register("present_velocity", 128, 4),
    Register("present_position", 132, 4, 2048),
    Register("velocity_trajectory", 136, 4),
    Register("position_trajectory", 140, 4),
    Register("present_input_voltage", 144, 2, 50),
    Register("present_temperature", 146, 1, 32),
    Register("backup_ready", 147, 1),
    *(
        Register(f"indirect_address_{k + 1}", INDIRECT_ADDRESS + 2 * k, 2, INDIRECT_DATA + k, EEPROM_END, 227)
        for k in range(INDIRECT_COUNT)
    ),
    *(Register(f"indirect_data_{k + 1}", INDIRECT_DATA + k, 1, 0, 0, 255) for k in range(INDIRECT_COUNT)),
)


@dataclass(frozen=True)
class Model:
    """A kind of motor.

    Attributes
    ----------
    name : str
    registers : dict of str to Register
    stall_torque_nm, stall_current_ma : float
        At 5 V, from the e-manual.
    no_load_speed_rad_s : float
        At 5 V.
    """

    name: str
    registers: dict[str, Register]
    stall_torque_nm: float
    stall_current_ma: float
    no_load_speed_rad_s: float


def _changed(registers: Iterable[Register], **initial: int) -> dict[str, Register]:
    return {one.name: replace(one, initial=initial.get(one.name, one.initial)) for one in registers}


def _limited(registers: dict[str, Register], limit_ma: int) -> dict[str, Register]:
    """Registers with another current limit."""
    limit = replace(registers["current_limit"], initial=limit_ma, maximum=limit_ma)
    goal = replace(registers["goal_current"], initial=limit_ma, minimum=-limit_ma, maximum=limit_ma)
    return {**registers, "current_limit": limit, "goal_current": goal}


XC330 = Model("XC330-M288-T", _changed(_REGISTERS), 0.93, 1800.0, 8.48)
XL330 = Model(
    "XL330-M288-T",
    _limited(
        _changed(
            _REGISTERS,
            model_number=1200,
            velocity_limit=445,
            velocity_p_gain=180,
            position_d_gain=0,
            position_p_gain=400,
            shutdown=53,
        ),
        limit_ma=1750,
    ),
    0.52,
    1470.0,
    10.79,
)
MODELS = {"xc330": XC330, "xl330": XL330}
