# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand of Dynamixel motors (XC330, XL330), such as the LEAP hand, through the unmodified `dynamixel_sdk`.

What is particular about that library (4.1.0): it waits for answers in a busy loop, unless the port itself waits; a
group read drops the motors' error bytes, so the hardware error is read as a register, and all that is read each cycle
is gathered by indirect addresses; `fastSyncRead` raises IndexError for an answer that is whole but too short; what the
port itself raises (OSError, termios.error) passes through.
"""

from __future__ import annotations

import math
import termios
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from acts_control.claims import Claim, ClaimedError
from acts_control.hand.description import HandDescription, Joint
from acts_control.hand.motors.bus import BusConfig, HandError, HandLostError, HandReading
from acts_control.hand.motors.port_words import held, usb_latency, why_not
from acts_core.runtime import is_multiplexer, is_stale_link
from acts_core.settings import setting

# The control table, see the e-manual of the XC330-M288.
_RETURN_DELAY, _MODE, _TORQUE, _HARDWARE_ERROR = 9, 11, 64, 70
_D_GAIN, _I_GAIN, _P_GAIN, _WATCHDOG, _GOAL_CURRENT, _GOAL_POSITION = 80, 82, 84, 98, 102, 116
_CURRENT, _POSITION, _TEMPERATURE, _INDIRECT_ADDRESS, _INDIRECT_DATA = 126, 132, 146, 168, 208

_MODELS = {1240: "XC330-M288", 1200: "XL330-M288"}
_CURRENT_BASED_POSITION = 5
_WATCHDOG_UNIT_S = 0.02
_WATCHDOG_EXPIRED = 255
_LONGEST_WATCHDOG = 127

_TICKS_PER_RAD = 4096 / (2.0 * math.pi)
_RAD_S_PER_UNIT = 0.229 * 2.0 * math.pi / 60.0

# Current (2), speed (4) and position (4) follow one another in the control table.
_GATHERED = (*range(_CURRENT, _CURRENT + 10), _HARDWARE_ERROR, _TEMPERATURE, _WATCHDOG, _TORQUE)

# In a status packet's error number: look at the hardware error.
_ALERT = 0x80

_FAULTS = {0: "input voltage", 2: "overheating", 3: "encoder", 4: "electrical shock", 5: "overload"}

# A read of the port returns after this time, if not before with all that was asked for. Well below answer_timeout_ms.
_READ_TIMEOUT_S = 0.001

# A motor that has been told to start anew does not answer meanwhile.
_REBOOT_TIMEOUT_S = 2.0
_TRIES = 3


@dataclass(frozen=True)
class DynamixelConfig(BusConfig):
    """How the motors are reached, and how strong they are."""

    baud: int = setting(4_000_000, "bits a second on the bus", minimum=9600, maximum=4_000_000)
    answer_timeout_ms: float = setting(
        16.0,
        "half of the time to wait for a reply, in addition to the time of its bytes [ms]",
        minimum=1.0,
        maximum=500.0,
    )
    position_p_gain: int = setting(600, "P gain of position control", minimum=0, maximum=16383)
    position_i_gain: int = setting(0, "I gain of position control", minimum=0, maximum=16383)
    position_d_gain: int = setting(200, "D gain of position control", minimum=0, maximum=16383)
    max_current_ma: int = setting(350, "largest current of each motor [mA]", minimum=1, maximum=1750)
    motor_watchdog_s: float = setting(
        0.2, "a motor that hears nothing for longer stops [s]; 0: never", minimum=0.0, maximum=2.54
    )
    set_return_delay: bool = setting(
        False, "whether to set the return delay in the EEPROM of the motors to 0 where it is not"
    )


class DynamixelHand:
    """A hand of Dynamixel motors.

    Parameters
    ----------
    hand : HandDescription
    config : DynamixelConfig
    """

    def __init__(self, hand: HandDescription, config: DynamixelConfig) -> None:
        self._hand = hand
        self._config = config
        self._sdk: Any = None
        self._port: Any = None
        self._packets: Any = None
        self._state: Any = None
        self._claim: Claim | None = None
        self._is_on = False  # whether the torque of all motors was switched on

    def connect(self) -> list[str]:
        """Open the port, find all motors, set them up with the torque off.

        Returns
        -------
        list of str
            What a person should know of, in sentences.

        Raises
        ------
        HandError
            When the port cannot be opened, or a motor is missing (all of them are named), of another kind, or refuses.
            Where some are missing the torque of the others is off.
        """
        self._is_on = False
        self._open()
        try:
            self._find_all()
            # Left on by a program that has crashed, it would lock the operating mode.
            self._each(_TORQUE, 1, 0)
            # Where it has stopped a motor, that would refuse the goal current.
            self._each(_WATCHDOG, 1, 0)
            told = [*self._check_return_delay(), *usb_latency(Path(self._config.port))]
            for index, joint in enumerate(self._hand.joints):
                if self._read_register(joint, _HARDWARE_ERROR, 1):
                    told.append(f"motor {_name(joint)} had switched itself off; it has been started anew")
                    self.recover(index)
                else:
                    self._set_up(joint)
        except HandError:
            self.disconnect()
            raise
        self._state = self._sdk.GroupSyncRead(self._port, self._packets, _INDIRECT_DATA, len(_GATHERED))
        for joint in self._hand.joints:
            self._state.addParam(joint.motor_id)
        return told

    def enable(self) -> None:
        """Switch the torque on; every joint holds where it is. Where that fails half-way, it is switched off again."""
        watchdog = math.ceil(self._config.motor_watchdog_s / _WATCHDOG_UNIT_S)
        try:
            for joint in self._hand.joints:
                self._write_register(joint, _WATCHDOG, 1, 0)
                position = self._read_register(joint, _POSITION, 4)
                self._write_register(joint, _GOAL_POSITION, 4, position)
                self._write_register(joint, _TORQUE, 1, 1)
                # What comes in between, such as a cable torn off, leaves no motor on without a watchdog.
                self._write_register(joint, _WATCHDOG, 1, _LONGEST_WATCHDOG if watchdog else 0)
            self._each(_WATCHDOG, 1, watchdog)
        except HandError:
            with suppress(HandError):
                self.release()
            raise
        self._is_on = True

    def release(self) -> None:
        """Switch the torque off, also where some motors do not answer.

        Raises
        ------
        HandError
            Naming the motors that did not say that they have done so.
        """
        self._is_on = False
        silent = []
        for joint in self._hand.joints:
            try:
                self._write_register(joint, _TORQUE, 1, 0)
            except HandLostError:
                raise
            except HandError:
                silent.append(_name(joint))
        if silent:
            raise HandError(f"motors {', '.join(silent)} did not answer when they were switched off")

    def read(self) -> HandReading:
        """The newest state of all motors, by one fast sync read.

        Raises
        ------
        HandError
            When the answer does not come, or is damaged.
        HandLostError
            When the port is gone.
        """
        with self._using_port():
            try:
                result = self._state.fastSyncRead()
            except IndexError:
                result = self._sdk.COMM_RX_CORRUPT
        if result != self._sdk.COMM_SUCCESS:
            raise HandError(f"the motors did not answer: {self._packets.getTxRxResult(result)}")
        rows = [(joint, bytes(self._state.data_dict[joint.motor_id])) for joint in self._hand.joints]
        ticks = [int.from_bytes(row[6:10], "little", signed=True) for _, row in rows]
        speeds = [int.from_bytes(row[2:6], "little", signed=True) for _, row in rows]
        currents = [int.from_bytes(row[0:2], "little", signed=True) for _, row in rows]
        joints = self._hand.joints
        return HandReading(
            tuple(one.from_motor_rad(k / _TICKS_PER_RAD) for one, k in zip(joints, ticks, strict=True)),
            tuple(one.direction * k * _RAD_S_PER_UNIT for one, k in zip(joints, speeds, strict=True)),
            tuple(float(one.direction * k) for one, k in zip(joints, currents, strict=True)),
            tuple(row[11] for _, row in rows),
            tuple(_fault(row[10]) or self._reset(row[13]) for _, row in rows),
            any(row[12] == _WATCHDOG_EXPIRED for _, row in rows),
        )

    def _reset(self, torque: int) -> str:
        """What is told of a motor without torque that should have it: one whose power was gone for a moment."""
        return "torque is off, as after a loss of power" if self._is_on and not torque else ""

    def command(self, q_rad: Sequence[float]) -> None:
        """Send every joint to an angle, by one sync write that nobody answers.

        Raises
        ------
        HandError
            When an angle is not finite, or their number is wrong: nothing is sent then.
        """
        joints = self._hand.joints
        q = [float(angle) for angle in q_rad]
        if len(q) != len(joints) or not all(map(math.isfinite, q)):
            raise HandError(f"joint angles {q} cannot be sent: {len(joints)} finite numbers are needed")
        group = self._sdk.GroupSyncWrite(self._port, self._packets, _GOAL_POSITION, 4)
        for joint, angle in zip(joints, q, strict=True):
            ticks = round(joint.to_motor_rad(joint.clipped(angle)) * _TICKS_PER_RAD)
            group.addParam(joint.motor_id, ticks.to_bytes(4, "little", signed=True))
        with self._using_port():
            result = group.txPacket()
        if result != self._sdk.COMM_SUCCESS:
            raise HandError(f"goals could not be sent: {self._packets.getTxRxResult(result)}")

    def recover(self, joint: int) -> None:
        """Start a motor anew that has switched itself off, and set it up; its torque stays off.

        Raises
        ------
        HandError
            When it does not come back within two seconds.
        """
        self._is_on = False
        motor = self._hand.joints[joint]
        self._ask(motor, lambda: (0, *self._packets.reboot(self._port, motor.motor_id)))
        deadline_s = time.monotonic() + _REBOOT_TIMEOUT_S
        while True:
            try:
                self._ping(motor)
                break
            except HandLostError:
                raise
            except HandError:
                if time.monotonic() > deadline_s:
                    raise
        self._set_up(motor)

    def close(self) -> None:
        """Give port and hand back; the torque stays as it is."""
        self.disconnect()
        if self._claim is not None:
            self._claim.close()
            self._claim = None

    def disconnect(self) -> None:
        """Give the port back, until the next `connect`; a program that waits for the hand does not get it meanwhile."""
        port, self._port = self._port, None
        # The library fails where it has not come to open it.
        if port is not None and port.ser is not None:
            with suppress(OSError, termios.error):
                port.closePort()

    # --- one after the other

    def _open(self) -> None:
        try:
            import dynamixel_sdk
            from dynamixel_sdk import port_handler
        except ImportError as error:
            raise HandError(
                f"dynamixel_sdk cannot be imported ({error}); install it with: pip install dynamixel-sdk"
            ) from error
        config = self._config
        self._sdk = dynamixel_sdk
        if is_multiplexer(config.port) or is_stale_link(config.port):
            raise HandError(f"{config.port} is no port of a hand: behind it is a terminal that belongs to nobody yet")
        self._take()
        # The library's only setting for how long it waits; its own 16 ms is that of a USB adapter as it comes.
        port_handler.LATENCY_TIMER = config.answer_timeout_ms
        self._packets = dynamixel_sdk.PacketHandler(2.0)
        self._port = dynamixel_sdk.PortHandler(config.port)
        try:
            known = self._port.openPort() and self._port.setBaudRate(config.baud)
            if known:
                # The library has no such option: two programs would take each other's answers and move one hand.
                self._port.ser.exclusive = True
                # The library reads in a loop without a pause until an answer is complete: that would fill a core.
                self._port.ser.timeout = _READ_TIMEOUT_S
        except (OSError, termios.error) as error:
            self.disconnect()
            raise HandError(why_not(config.port, error)) from error
        if not known:
            self.disconnect()
            raise HandError(f"baud = {config.baud}: the library does not know it; the LEAP hand has 4000000")

    def _take(self) -> None:
        """Keep other programs from the hand, also while it is not connected."""
        if self._claim is None:
            try:
                self._claim = Claim("hand", str(Path(self._config.port).absolute()))
            except ClaimedError as error:
                raise HandError(held(self._config.port, str(error))) from error
            except OSError as error:
                raise HandError(f"{self._config.port} cannot be claimed ({error.strerror})") from error

    def _find_all(self) -> None:
        missing, found = [], []
        for joint in self._hand.joints:
            try:
                model = self._ping(joint)
            except HandLostError:
                raise
            except HandError:
                missing.append(_name(joint))
                continue
            if model not in _MODELS:
                kinds = " and ".join(f"{number} ({name})" for number, name in _MODELS.items())
                raise HandError(f"motor {_name(joint)} is of model {model}; known are {kinds}")
            found.append(joint)
        if missing:
            for joint in found:
                # Their torque may be on, with nobody who commands them.
                with suppress(HandError):
                    self._write_register(joint, _TORQUE, 1, 0)
            raise HandError(
                f"motors {', '.join(missing)} do not answer at {self._config.port} with {self._config.baud} baud; "
                f"check the power, the cables in front of the first of them, and their IDs"
            )

    def _check_return_delay(self) -> list[str]:
        slow = [joint for joint in self._hand.joints if self._read_register(joint, _RETURN_DELAY, 1)]
        if not slow:
            return []
        if self._config.set_return_delay:
            for joint in slow:
                self._write_register(joint, _RETURN_DELAY, 1, 0)
            return [f"the return delay of {len(slow)} motors has been set to 0 in their EEPROM"]
        return [
            f"{len(slow)} motors wait before they answer (return delay, register 9, up to 0.5 ms each): "
            f"start once with set_return_delay true, which sets it to 0"
        ]

    def _set_up(self, joint: Joint) -> None:
        config = self._config
        # Another mode brings the gains and the current back to its own: they come after it. An EEPROM wears out by
        # being written.
        if self._read_register(joint, _MODE, 1) != _CURRENT_BASED_POSITION:
            self._write_register(joint, _MODE, 1, _CURRENT_BASED_POSITION)
        self._write_register(joint, _P_GAIN, 2, round(config.position_p_gain * joint.gain_scale))
        self._write_register(joint, _I_GAIN, 2, config.position_i_gain)
        self._write_register(joint, _D_GAIN, 2, round(config.position_d_gain * joint.gain_scale))
        self._write_register(joint, _GOAL_CURRENT, 2, config.max_current_ma)
        for k, address in enumerate(_GATHERED):
            self._write_register(joint, _INDIRECT_ADDRESS + 2 * k, 2, address)

    # --- single registers

    def _each(self, address: int, size: int, value: int) -> None:
        for joint in self._hand.joints:
            self._write_register(joint, address, size, value)

    def _ping(self, joint: Joint) -> int:
        """The model of a motor; that its hardware has an error is no reason not to be there."""

        def ping() -> tuple[int, int, int]:
            model, result, _ = self._packets.ping(self._port, joint.motor_id)
            return model, result, 0

        return self._ask(joint, ping)

    def _read_register(self, joint: Joint, address: int, size: int) -> int:
        read = getattr(self._packets, f"read{size}ByteTxRx")
        return self._ask(joint, lambda: read(self._port, joint.motor_id, address))

    def _write_register(self, joint: Joint, address: int, size: int, value: int) -> None:
        write = getattr(self._packets, f"write{size}ByteTxRx")
        self._ask(joint, lambda: (0, *write(self._port, joint.motor_id, address, value & (1 << 8 * size) - 1)))

    def _ask(self, joint: Joint, call: Callable[[], tuple[int, int, int]]) -> int:
        """The value that a motor answers with; it is asked again where no answer comes."""
        for _ in range(_TRIES):
            with self._using_port():
                try:
                    value, result, error = call()
                except IndexError:  # an error without the data that were asked for
                    value, result, error = 0, self._sdk.COMM_RX_CORRUPT, 0
            if result == self._sdk.COMM_SUCCESS:
                break
        else:
            raise HandError(f"motor {_name(joint)} does not answer")
        if error & ~_ALERT:
            raise HandError(f"motor {_name(joint)} refuses: {self._packets.getRxPacketError(error & ~_ALERT)}")
        return value

    @contextmanager
    def _using_port(self) -> Iterator[None]:
        if self._port is None:
            raise HandLostError(f"{self._config.port}: not connected")
        try:
            yield
        except (OSError, termios.error) as error:
            # The library is left in the middle of an exchange: it would call the port busy from now on.
            self.disconnect()
            raise HandLostError(f"{self._config.port} is gone ({error}); is the cable plugged in?") from error


def _name(joint: Joint) -> str:
    return f"{joint.motor_id} ({joint.name})"


def _fault(bits: int) -> str:
    return ", ".join(words for bit, words in _FAULTS.items() if bits >> bit & 1)
