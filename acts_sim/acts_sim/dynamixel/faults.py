# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Faults of a bus and its motors, as text commands while it runs."""

from __future__ import annotations

import json
from typing import Protocol

from acts_core.errors import ActsError, SettingsError
from acts_sim.dynamixel.bus import Bus
from acts_sim.dynamixel.motor import HardwareError, Motor
from acts_sim.dynamixel.port import BusPort

MOTOR_FAULTS = ("lose", "find", "overload", "overheat", "block", "release")
"""Faults of one motor: words that are followed by its ID."""

_KNOWN = ", ".join((*(f"{word} ID" for word in MOTOR_FAULTS), "unplug", "plug_in", "state"))


class Mechanics(Protocol):
    """The mechanics that the motors drive.

    Attributes
    ----------
    blocked : set of int
        Indices of blocked joints.
    """

    blocked: set[int]


class Faults:
    """Executes commands on a bus and its joints.

    Parameters
    ----------
    bus : Bus
    joints : Mechanics
    port : BusPort
    """

    def __init__(self, bus: Bus, joints: Mechanics, port: BusPort) -> None:
        self._bus = bus
        self._joints = joints
        self._port = port

    def answer(self, line: str) -> str:
        """Execute a line and return ``ok``, a JSON object for ``state``, or ``error: ...``."""
        word, _, rest = line.partition(" ")
        if word == "state":
            return json.dumps({"connected": self._port.connected, "motors": [state(one) for one in self._bus.motors]})
        try:
            if word == "unplug":
                self._port.unplug()
            elif word == "plug_in":
                self._port.plug_in()
            elif word in MOTOR_FAULTS:
                do_to_motor(self._bus, self._joints, word, rest.strip())
            else:
                return f"error: unknown {word!r}; known are {_KNOWN}"
        except ActsError as error:
            return f"error: {error}"
        return "ok"


def do_to_motor(bus: Bus, joints: Mechanics, word: str, motor_id: str) -> None:
    """Cause one of `MOTOR_FAULTS`.

    Raises
    ------
    SettingsError
        When there is no such motor.
    """
    index = next((k for k, motor in enumerate(bus.motors) if str(motor.motor_id) == motor_id), None)
    if index is None:
        raise SettingsError(f"no motor {motor_id!r}; there are {', '.join(str(one.motor_id) for one in bus.motors)}")
    motor = bus.motors[index]
    if word == "lose":
        bus.lost.add(motor.motor_id)
    elif word == "find":
        bus.lost.discard(motor.motor_id)
    elif word == "overload":
        motor.fail(HardwareError.OVERLOAD)
    elif word == "overheat":
        motor.fail(HardwareError.OVERHEATING)
    elif word == "block":
        joints.blocked.add(index)
    else:
        joints.blocked.discard(index)


def state(motor: Motor) -> dict[str, float]:
    """State of a motor, for JSON."""
    return {
        "id": motor.motor_id,
        "position_rad": motor.shaft.position_rad,
        "velocity_rad_s": motor.shaft.velocity_rad_s,
        "torque_nm": motor.torque_nm,
        "torque_enable": motor["torque_enable"],
        "goal_position": motor["goal_position"],
        "goal_current": motor["goal_current"],
        "operating_mode": motor["operating_mode"],
        "hardware_error_status": motor["hardware_error_status"],
        "bus_watchdog": motor["bus_watchdog"],
    }
