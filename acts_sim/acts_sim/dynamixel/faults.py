"""What can happen to a bus while it runs, in lines of text."""

from __future__ import annotations

import json

from acts_sim.dynamixel.bus import Bus
from acts_sim.dynamixel.joints import FreeJoints
from acts_sim.dynamixel.motor import HardwareError, Motor
from acts_sim.dynamixel.port import BusPort

_KNOWN = "lose ID, find ID, overload ID, overheat ID, block ID, release ID, unplug, plug_in, state"


class Faults:
    """Carries out commands on a bus and its joints.

    Parameters
    ----------
    bus : Bus
    joints : FreeJoints
    port : BusPort
    """

    def __init__(self, bus: Bus, joints: FreeJoints, port: BusPort) -> None:
        self._bus = bus
        self._joints = joints
        self._port = port

    def answer(self, line: str) -> str:
        """Carry out a line; ``ok``, a JSON object for ``state``, or ``error: ...``."""
        word, _, rest = line.partition(" ")
        if word == "unplug":
            self._port.unplug()
            return "ok"
        if word == "plug_in":
            self._port.plug_in()
            return "ok"
        if word == "state":
            return json.dumps({"connected": self._port.connected, "motors": [_state(one) for one in self._bus.motors]})
        index = next((k for k, motor in enumerate(self._bus.motors) if str(motor.motor_id) == rest.strip()), None)
        if word not in ("lose", "find", "overload", "overheat", "block", "release"):
            return f"error: unknown {word!r}; known are {_KNOWN}"
        if index is None:
            ids = ", ".join(str(motor.motor_id) for motor in self._bus.motors)
            return f"error: no motor {rest.strip()!r}; there are {ids}"
        self._to_motor(word, index)
        return "ok"

    def _to_motor(self, word: str, index: int) -> None:
        motor = self._bus.motors[index]
        if word == "lose":
            self._bus.lost.add(motor.motor_id)
        elif word == "find":
            self._bus.lost.discard(motor.motor_id)
        elif word == "overload":
            motor.fail(HardwareError.OVERLOAD)
        elif word == "overheat":
            motor.fail(HardwareError.OVERHEATING)
        elif word == "block":
            self._joints.blocked.add(index)
        else:
            self._joints.blocked.discard(index)


def _state(motor: Motor) -> dict[str, float]:
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
