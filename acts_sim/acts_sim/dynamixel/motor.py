# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One motor: its control table with the rules for reads and writes, its errors, its torque."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum, IntFlag

from acts_sim.dynamixel.control_table import EEPROM_END, INDIRECT_COUNT, INDIRECT_DATA, LARGEST_PWM, SIZE, Model
from acts_sim.dynamixel.drive import (
    RAD_PER_TICK,
    RAD_S_PER_VELOCITY_UNIT,
    PositionControl,
    Shaft,
    Trajectory,
    torque_nm,
)

BASE_DELAY_S = 2e-6
"""Unit of the return delay time [s]."""

_WATCHDOG_UNIT_S = 0.02
_WATCHDOG_EXPIRED = 255

# Read-only while the bus watchdog has expired.
_GOALS = {"goal_pwm", "goal_current", "goal_velocity", "goal_position"}

# Goals, and the registers that say how large they may be.
_LIMITS = {"goal_pwm": "pwm_limit", "goal_current": "current_limit", "goal_velocity": "velocity_limit"}

# Computed when they are read.
_MEASURED = {"present_position", "present_velocity", "moving", "position_trajectory", "realtime_tick"}

# Back to their values of the start where the operating mode changes; the limits of PWM and current are apart.
_OF_THE_MODE = (
    "velocity_i_gain",
    "velocity_p_gain",
    "position_d_gain",
    "position_i_gain",
    "position_p_gain",
    "feedforward_2nd_gain",
    "feedforward_1st_gain",
    "profile_acceleration",
    "profile_velocity",
)

_STILL_RAD_S = 0.05


class StatusError(IntEnum):
    """Error number of a status packet; the bit `ALERT` is added while `hardware_error_status` is not 0."""

    NONE = 0
    RESULT_FAIL = 1
    INSTRUCTION = 2
    CRC = 3
    DATA_RANGE = 4
    DATA_LENGTH = 5
    DATA_LIMIT = 6
    ACCESS = 7
    ALERT = 0x80


class HardwareError(IntFlag):
    """Bits of ``hardware_error_status``."""

    INPUT_VOLTAGE = 1 << 0
    OVERHEATING = 1 << 2
    ENCODER = 1 << 3
    ELECTRICAL_SHOCK = 1 << 4
    OVERLOAD = 1 << 5


class OperatingMode(IntEnum):
    """Control mode. Velocity and PWM control are not simulated, and are refused as out of range."""

    CURRENT = 0
    POSITION = 3
    EXTENDED_POSITION = 4
    CURRENT_BASED_POSITION = 5


# Plain integers: comparing enum members takes several times as long.
_CURRENT, _CURRENT_BASED_POSITION = int(OperatingMode.CURRENT), int(OperatingMode.CURRENT_BASED_POSITION)


@dataclass(frozen=True)
class OverloadLaw:
    """Condition of the overload error; an assumption, since the manual does not say.

    Attributes
    ----------
    after_s : float
        Time without motion after which the error occurs [s]; 0: never.
    current_ma : float
        Current that must flow during all of that time, at least [mA].
    """

    after_s: float = 0.0
    current_ma: float = 300.0


class Motor:
    """A motor on the bus.

    Parameters
    ----------
    model : Model
    motor_id : int
        0 to 252.
    return_delay_time : int
        Initial value in the EEPROM, in units of 2 us.
    operating_mode : OperatingMode
        Initial value in the EEPROM.
    overload : OverloadLaw

    Attributes
    ----------
    shaft : Shaft
        Set by the mechanics.
    torque_nm : float
        Present torque [N m].
    """

    def __init__(
        self,
        model: Model,
        motor_id: int,
        return_delay_time: int = 250,
        operating_mode: OperatingMode = OperatingMode.POSITION,
        overload: OverloadLaw = OverloadLaw(),
    ) -> None:
        self.model = model
        self.shaft = Shaft()
        self.torque_nm = 0.0
        self._values = {one.name: one.initial for one in model.registers.values()}
        # Register, and index of the byte in it, of every address in use.
        self._at = {one.address + k: (one, k) for one in model.registers.values() for k in range(one.size)}
        self._control = PositionControl()
        self._trajectory = Trajectory(0.0)
        self._overload = overload
        self._stalled_s = 0.0
        self._silent_s = 0.0
        self._since_start_s = 0.0
        self._registered: tuple[int, bytes] | None = None
        self._values["id"] = motor_id
        self._values["return_delay_time"] = return_delay_time
        self._values["operating_mode"] = operating_mode
        self._reset_limits(operating_mode)

    # --- the control table

    def __getitem__(self, name: str) -> int:
        """Value of a register by name."""
        if name in _MEASURED:
            self._sense()
        return self._values[name]

    @property
    def motor_id(self) -> int:
        """Its ID on the bus."""
        return self["id"]

    @property
    def return_delay_s(self) -> float:
        """Delay of its replies [s]."""
        return self["return_delay_time"] * BASE_DELAY_S

    @property
    def alert(self) -> int:
        """`ALERT` bit of the status packet's error: set while ``hardware_error_status`` is not 0."""
        return StatusError.ALERT if self["hardware_error_status"] else 0

    def heard(self) -> None:
        """Restart the bus watchdog: an instruction has arrived."""
        self._silent_s = 0.0

    def read(self, address: int, size: int) -> tuple[int, bytes]:
        """Error and data of a read; unused addresses read as 0."""
        if size == 0 or address + size > SIZE:
            return StatusError.DATA_RANGE, b""
        self._sense()
        return StatusError.NONE, bytes(self._byte(self._direct(where)) for where in range(address, address + size))

    def write(self, address: int, data: bytes) -> int:
        """Write all bytes, or none where one is not allowed; return the error number."""
        if not data or address + len(data) > SIZE:
            return StatusError.DATA_RANGE
        places = [self._direct(address + k) for k in range(len(data))]
        wanted: list[tuple[str, int]] = []
        k = 0
        while k < len(data):
            register, first = self._at.get(places[k], (None, 0))
            if register is None or not register.writable:
                return StatusError.ACCESS
            if first or places[k : k + register.size] != list(
                range(register.address, register.address + register.size)
            ):
                return StatusError.DATA_LENGTH
            value = int.from_bytes(data[k : k + register.size], "little", signed=register.signed)
            error = self._objection(register.name, value)
            if error:
                return error
            wanted.append((register.name, value))
            k += register.size
        for name, value in wanted:
            self._write(name, value)
        return StatusError.NONE

    def register_write(self, parameters: bytes) -> int:
        """Store a write until `action`; return the error number."""
        if len(parameters) < 3:
            return StatusError.DATA_LENGTH
        self._registered = (int.from_bytes(parameters[:2], "little"), parameters[2:])
        self._values["registered_instruction"] = 1
        return StatusError.NONE

    def action(self) -> int:
        """Execute the stored write; return the error number, also where none is stored."""
        if self._registered is None:
            return StatusError.INSTRUCTION
        address, data = self._registered
        self._registered = None
        self._values["registered_instruction"] = 0
        return self.write(address, data)

    def _direct(self, address: int) -> int:
        """Address that an address of the indirect data refers to."""
        if not INDIRECT_DATA <= address < INDIRECT_DATA + INDIRECT_COUNT:
            return address
        return self._values[f"indirect_address_{address - INDIRECT_DATA + 1}"]

    def _byte(self, address: int) -> int:
        if address not in self._at:
            return 0
        register, k = self._at[address]
        return self._values[register.name] >> 8 * k & 0xFF

    def _objection(self, name: str, value: int) -> int:
        """Error number of a write of a value, 0 if it is allowed."""
        register = self.model.registers[name]
        assert register.minimum is not None
        assert register.maximum is not None
        if register.address < EEPROM_END and self["torque_enable"]:
            return StatusError.ACCESS
        if not register.minimum <= value <= register.maximum:
            return StatusError.DATA_RANGE
        if name == "operating_mode" and value not in OperatingMode.__members__.values():
            return StatusError.DATA_RANGE
        if self["bus_watchdog"] == _WATCHDOG_EXPIRED and (name in _GOALS or (name == "bus_watchdog" and value)):
            return StatusError.DATA_RANGE
        if name in _LIMITS and abs(value) > self[_LIMITS[name]]:
            return StatusError.DATA_LIMIT
        if (
            name == "goal_position"
            and self["operating_mode"] == OperatingMode.POSITION
            and not self["min_position_limit"] <= value <= self["max_position_limit"]
        ):
            return StatusError.DATA_LIMIT
        if name == "torque_enable" and value and self["hardware_error_status"] & self["shutdown"]:
            return StatusError.RESULT_FAIL  # until a reboot
        return StatusError.NONE

    def _write(self, name: str, value: int) -> None:
        if name == "torque_enable" and value != self["torque_enable"]:
            self._hold_still()
        if name == "operating_mode" and value != self["operating_mode"]:
            for register in _OF_THE_MODE:
                self._values[register] = self.model.registers[register].initial
            self._reset_limits(value)
        self._values[name] = value

    def _reset_limits(self, mode: int) -> None:
        """Set goal PWM and goal current as at the start in a mode: a current that flows is none, limits are whole."""
        self._values["goal_pwm"] = self._values["pwm_limit"]
        self._values["goal_current"] = 0 if mode == _CURRENT else self._values["current_limit"]

    def _hold_still(self) -> None:
        """Set the goal to the present position, when the torque is switched on or off."""
        ticks = round(self.shaft.position_rad / RAD_PER_TICK)
        self._values["goal_position"] = ticks
        self._trajectory.reset(ticks)
        self._control.reset()

    # --- errors

    def fail(self, error: HardwareError) -> None:
        """Cause a hardware error; if its bit is in the shutdown mask, the torque is switched off."""
        self._values["hardware_error_status"] = self["hardware_error_status"] | error
        if error & self["shutdown"]:
            self._values["torque_enable"] = 0

    def reboot(self) -> None:
        """Reboot: reset the RAM and all errors, keep the EEPROM."""
        for register in self.model.registers.values():
            if register.address >= EEPROM_END:
                self._values[register.name] = register.initial
        self._reset_limits(self["operating_mode"])
        self._registered = None
        self._since_start_s = self._silent_s = self._stalled_s = 0.0
        self._hold_still()

    # --- time

    def step(self, dt_s: float) -> float:
        """Advance by `dt_s`, with the shaft as the mechanics have set it.

        Returns
        -------
        float
            Torque until the next step [N m].
        """
        self._since_start_s += dt_s
        self._watch_bus(dt_s)
        current_ma = self._wanted_current_ma(dt_s) if self._values["torque_enable"] else 0.0
        duty = min(abs(self._values["goal_pwm"]), self._values["pwm_limit"]) / LARGEST_PWM
        current_ma, self.torque_nm = torque_nm(self.model, current_ma, self.shaft.velocity_rad_s, duty)
        self._values["present_current"] = round(current_ma)
        self._watch_load(current_ma, dt_s)
        if self._values["present_temperature"] > self._values["temperature_limit"]:
            self.fail(HardwareError.OVERHEATING)
        return self.torque_nm

    def _wanted_current_ma(self, dt_s: float) -> float:
        # Reads `_values` directly for speed: this runs for every motor at every step.
        values = self._values
        mode = values["operating_mode"]
        limit = float(values["current_limit"])
        if mode == _CURRENT:
            return min(max(float(values["goal_current"]), -limit), limit)
        cap = min(abs(float(values["goal_current"])), limit) if mode == _CURRENT_BASED_POSITION else limit
        where = self._trajectory.advance(
            values["goal_position"], values["profile_velocity"], values["profile_acceleration"], dt_s
        )
        error_ticks = where - self.shaft.position_rad / RAD_PER_TICK
        gains = (values["position_p_gain"], values["position_i_gain"], values["position_d_gain"])
        return self._control.current_ma(error_ticks, gains, cap, dt_s)

    def _watch_load(self, current_ma: float, dt_s: float) -> None:
        law = self._overload
        if law.after_s == 0.0:
            return
        stalls = abs(current_ma) >= law.current_ma and abs(self.shaft.velocity_rad_s) < _STILL_RAD_S
        self._stalled_s = self._stalled_s + dt_s if stalls else 0.0
        if self._stalled_s > law.after_s:
            self.fail(HardwareError.OVERLOAD)

    def _watch_bus(self, dt_s: float) -> None:
        allowed = self._values["bus_watchdog"]
        if allowed in (0, _WATCHDOG_EXPIRED) or not self._values["torque_enable"]:
            return
        self._silent_s += dt_s
        if self._silent_s > allowed * _WATCHDOG_UNIT_S:
            self._values["bus_watchdog"] = _WATCHDOG_EXPIRED
            self._hold_still()
            if self._values["operating_mode"] == _CURRENT:
                self._values["goal_current"] = 0

    @property
    def _is_on_its_way(self) -> bool:
        """Whether the profile has not reached the goal yet."""
        values = self._values
        has_profile = values["torque_enable"] and values["profile_velocity"] and values["operating_mode"] != _CURRENT
        return bool(has_profile) and self._trajectory.ticks != values["goal_position"]

    def _sense(self) -> None:
        """Write the measured values to the control table."""
        shaft, values = self.shaft, self._values
        values["present_position"] = math.floor(shaft.position_rad / RAD_PER_TICK)
        values["present_velocity"] = round(shaft.velocity_rad_s / RAD_S_PER_VELOCITY_UNIT)
        moves = abs(shaft.velocity_rad_s) > values["moving_threshold"] * RAD_S_PER_VELOCITY_UNIT
        values["moving"] = int(moves or self._is_on_its_way)
        values["position_trajectory"] = round(self._trajectory.ticks)
        values["realtime_tick"] = int(self._since_start_s * 1e3) % 32768
