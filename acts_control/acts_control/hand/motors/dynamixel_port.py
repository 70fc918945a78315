# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is said on a bus of Dynamixel motors, one exchange at a time, through the unmodified `dynamixel_sdk`.

What is particular about that library (4.1.0): it waits for answers in a busy loop, unless the port itself waits, and
without end where bytes come without end; it takes what does not fit a register apart without a word; `fastSyncRead`
raises IndexError for an answer that is whole but too short; what the port itself raises (OSError, termios.error) passes
through.
"""

from __future__ import annotations

import os
import select
import termios
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from serial import SerialTimeoutException

from acts_control.hand.description import Joint
from acts_control.hand.motors.bus import HandError, HandLostError
from acts_control.hand.motors.dynamixel_config import DynamixelConfig
from acts_control.hand.motors.dynamixel_table import ALERT, Register
from acts_control.hand.motors.port_claim import PortClaim
from acts_control.hand.motors.port_words import why_not
from acts_core.runtime import errno_of, is_multiplexer, is_stale_link, path_shown

# A read of the port returns after this time, if not before with all that was asked for. Well below answer_timeout_ms.
_READ_TIMEOUT_S = 0.001

# What hears nothing of what is sent for so long is gone. A port without such a limit waits without end: an adapter that
# hangs, or a simulated bus that was stopped, takes no more than some 20 kB.
_WRITE_TIMEOUT_S = 1.0

# Far more than the longest answer, which takes a quarter of it.
_ANSWER_BYTES_MAX = 4096

_TRIES = 3


class DynamixelPort:
    """The port of the motors.

    Every method but `disconnect` and `close` raises `HandLostError` when the port is gone.

    Parameters
    ----------
    config : DynamixelConfig
    """

    def __init__(self, config: DynamixelConfig) -> None:
        self._config = config
        self._claim = PortClaim(config.port)
        self._sdk: Any = None
        self._port: Any = None
        self._packets: Any = None
        self._group: Any = None
        self._chosen: tuple[int, ...] = ()
        # Motors that have left a request without an answer: it may still come.
        self._late: set[int] = set()
        self._may_come_bytes = 0  # as the answer to what was sent last

    # --- the port itself

    def open(self) -> None:
        """Open the port, and keep other programs from it until `close`.

        Raises
        ------
        HandError
            When that cannot be, in words for a person.
        """
        try:
            import dynamixel_sdk
            from dynamixel_sdk import port_handler
        except ImportError as error:
            raise HandError(
                f"dynamixel_sdk cannot be imported ({error}); install it with: pip install dynamixel-sdk"
            ) from error
        config = self._config
        self._late.clear()
        self._sdk = dynamixel_sdk
        if is_stale_link(config.port):
            raise HandError(
                f"port {path_shown(config.port)} is not there: the link is older than that terminal, so its hand is "
                f"gone and another program has the terminal; start the hand again"
            )
        if is_multiplexer(config.port):
            raise HandError(f"{config.port} is no port of a hand: it makes a new terminal each time it is opened")
        self._claim.take()
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
                self._port.ser.write_timeout = _WRITE_TIMEOUT_S
                # Before 4.1, which ROS does not have, it leaves in the port what came too late: each request from then
                # on would get the answer to the one before.
                self._port.clearPort = self._port.ser.reset_input_buffer
                self._port.writePort, self._port.readPort = self._write, self._read
        except (OSError, termios.error) as error:
            self.disconnect()
            raise HandError(why_not(config.port, error)) from error
        if not known:
            self.disconnect()
            raise HandError(f"baud = {config.baud}: the library does not know it; the LEAP hand has 4000000")

    def disconnect(self) -> None:
        """Close the port; other programs do not get it."""
        port, self._port = self._port, None
        # The library fails where it has not come to open it.
        if port is not None and port.ser is not None:
            with suppress(OSError, termios.error):
                port.closePort()

    def close(self) -> None:
        """Close the port, and leave it to others."""
        self.disconnect()
        self._claim.close()

    # --- one motor

    def ping(self, joint: Joint) -> int:
        """The model of a motor; that its hardware has an error is no reason not to be there."""

        def ping() -> tuple[int, int, int]:
            model, result, _ = self._packets.ping(self._port, joint.motor_id)
            return model, result, 0

        return self._ask(joint, ping)

    def reboot(self, joint: Joint) -> None:
        """Start a motor anew; it does not answer meanwhile."""
        self._ask(joint, lambda: (0, *self._packets.reboot(self._port, joint.motor_id)))

    def read(self, joint: Joint, register: Register) -> int:
        """The value of a register, as of a number without a sign."""
        read = getattr(self._packets, f"read{register.size}ByteTxRx")
        return self._ask(joint, lambda: read(self._port, joint.motor_id, register.address))

    def write(self, joint: Joint, register: Register, value: int) -> None:
        """Write a register of a motor.

        Raises
        ------
        HandError
            When the motor does not answer or refuses, or the value does not fit: nothing is sent then.
        """
        bits = 8 * register.size
        if not 0 <= value < 1 << bits:
            raise HandError(
                f"motor {name_of(joint)}: {value} does not fit in register {register.address}, which takes 0 to "
                f"{(1 << bits) - 1}"
            )
        write = getattr(self._packets, f"write{register.size}ByteTxRx")
        self._ask(joint, lambda: (0, *write(self._port, joint.motor_id, register.address, value)))

    def _ask(self, joint: Joint, call: Callable[[], tuple[int, int, int]]) -> int:
        """The value that a motor answers with; it is asked again where no answer comes."""
        self._let_late_answers_come(joint)  # to what it was asked before
        for _ in range(_TRIES):
            with self._using_port():
                try:
                    value, result, error = call()
                except IndexError:  # an error without the data that were asked for
                    value, result, error = 0, self._sdk.COMM_RX_CORRUPT, 0
            if result == self._sdk.COMM_SUCCESS:
                break
            self._late.add(joint.motor_id)
        else:
            raise HandError(f"motor {name_of(joint)} does not answer")
        self._let_late_answers_come(joint)
        if error & ~ALERT:
            raise HandError(f"motor {name_of(joint)} refuses: {self._packets.getRxPacketError(error & ~ALERT)}")
        return value

    def _let_late_answers_come(self, joint: Joint) -> None:
        """Wait for what a motor has not answered in time; the next request drops it.

        Packets have no numbers, so a late answer would be taken for that to the next request: a read would have the
        value of another register, and a refusal would be told of the wrong one.
        """
        if joint.motor_id in self._late:
            self._late.discard(joint.motor_id)
            time.sleep(self._config.lost_answer_s)

    # --- all motors

    def send(self, register: Register, values: Mapping[int, int]) -> None:
        """Write a register of many motors, by their numbers, in one packet that nobody answers.

        Raises
        ------
        HandError
            When it could not be sent.
        """
        with self._using_port():
            group = self._sdk.GroupSyncWrite(self._port, self._packets, *register)
            for motor_id, value in values.items():
                group.addParam(motor_id, value.to_bytes(register.size, "little", signed=True))
            result = group.txPacket()
        if result != self._sdk.COMM_SUCCESS:
            raise HandError(f"nothing could be sent: {self._packets.getTxRxResult(result)}")

    def choose(self, motor_ids: Sequence[int], address: int, size: int) -> None:
        """What `gather` reads from now on."""
        self._chosen = tuple(motor_ids)
        self._group = self._sdk.GroupSyncRead(self._port, self._packets, address, size)
        for motor_id in self._chosen:
            self._group.addParam(motor_id)

    def gather(self) -> list[bytes]:
        """What was chosen, of each motor, by one fast sync read.

        Raises
        ------
        HandError
            When the answer does not come, or is damaged.
        """
        with self._using_port():
            try:
                result = self._group.fastSyncRead()
            except IndexError:
                result = self._sdk.COMM_RX_CORRUPT
        if result != self._sdk.COMM_SUCCESS:
            raise HandError(f"the motors did not answer: {self._packets.getTxRxResult(result)}")
        return [bytes(self._group.data_dict[motor_id]) for motor_id in self._chosen]

    def _write(self, packet: bytes) -> int:
        """Write a packet for the library, which takes one that was not written whole for an exchange that failed."""
        line = self._port.ser
        self._may_come_bytes = _ANSWER_BYTES_MAX
        try:
            return int(line.write(packet))
        except SerialTimeoutException:
            # pyserial goes by the time alone, which also passes while this program stands still within a write.
            if select.select([], [line.fileno()], [], 0)[1]:
                return 0
            raise

    def _read(self, size: int) -> bytes:
        """Read for the library, which looks at the time only where less has come than it waits for.

        Where something sends without end, as what is no hand may do, it would wait without end.
        """
        data = bytes(self._port.ser.read(min(size, self._may_come_bytes)))
        self._may_come_bytes -= len(data)
        if not self._may_come_bytes:
            time.sleep(_READ_TIMEOUT_S)
        return data

    @contextmanager
    def _using_port(self) -> Iterator[None]:
        if self._port is None:
            raise HandLostError(f"{self._config.port}: not connected")
        try:
            yield
        except (OSError, termios.error) as error:
            # The library is left in the middle of an exchange: it would call the port busy from now on.
            self.disconnect()
            raise HandLostError(f"{self._config.port} is gone ({_how(error)}); is the cable plugged in?") from error


def _how(error: Exception) -> str:
    """How a port is gone, in words."""
    if isinstance(error, SerialTimeoutException):
        return f"it has taken nothing for {_WRITE_TIMEOUT_S:g} s"
    number = errno_of(error)
    # pyserial has no number for a port that is ready to be read and has nothing.
    return "it gives nothing more" if number is None else os.strerror(number)


def name_of(joint: Joint) -> str:
    """A motor, for a person."""
    return f"{joint.motor_id} ({joint.name})"
