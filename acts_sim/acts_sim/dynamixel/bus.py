# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The motors on one bus: which of them an instruction addresses, their replies, and the delay of these."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from acts_sim.dynamixel.control_table import EEPROM_END, NO_SECONDARY_ID
from acts_sim.dynamixel.motor import Motor, StatusError
from acts_sim.dynamixel.packets import (
    BROADCAST_ID,
    Instruction,
    Packet,
    encode_fast_status,
    encode_status,
    fast_status_bytes,
)

# Start bit, eight bits, stop bit.
BITS_PER_BYTE = 10

_SYNC_READS = (Instruction.SYNC_READ, Instruction.FAST_SYNC_READ)
_BULK_READS = (Instruction.BULK_READ, Instruction.FAST_BULK_READ)
_FAST_READS = (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ)


class Answer(NamedTuple):
    """Reply of the bus.

    Attributes
    ----------
    data : bytes
        All status packets; may be empty.
    delay_s : float
        Sum of the motors' return delays [s].
    """

    data: bytes = b""
    delay_s: float = 0.0


class Bus:
    """Motors that share a bus.

    Parameters
    ----------
    motors : iterable of Motor
        With different IDs.

    Attributes
    ----------
    lost : set of int
        IDs of disconnected motors, which neither receive nor reply.
    """

    def __init__(self, motors: Iterable[Motor]) -> None:
        self.motors = list(motors)
        self.lost: set[int] = set()

    def find(self, motor_id: int) -> Motor | None:
        """The motor with an ID; None where there is none or it is disconnected."""
        for motor in self.motors:
            if motor.motor_id == motor_id and motor_id not in self.lost:
                return motor
        return None

    def handle(self, packet: Packet) -> Answer:
        """Execute an instruction and return the reply."""
        connected = [motor for motor in self.motors if motor.motor_id not in self.lost]
        for motor in connected:
            motor.heard()
        if packet.instruction in (*_SYNC_READS, *_BULK_READS):
            return self._read_many(packet)
        if packet.instruction == Instruction.SYNC_WRITE:
            self._write_all(_sync_writes(packet.parameters))
            return Answer()
        if packet.instruction == Instruction.BULK_WRITE:
            self._write_all(_bulk_writes(packet.parameters))
            return Answer()
        if packet.motor_id != BROADCAST_ID:
            if packet.instruction == Instruction.WRITE and len(packet.parameters) > 2:
                followers = self._followers().get(packet.motor_id, ())
                _write_to(followers, _word(packet.parameters, 0), packet.parameters[2:])
            called = self.find(packet.motor_id)
            return Answer() if called is None else _answer_of(called, packet)
        # Of all broadcasts only a ping is answered, by one motor after the other.
        answers = [_answer_of(motor, packet) for motor in sorted(connected, key=lambda one: one.motor_id)]
        if packet.instruction != Instruction.PING:
            return Answer()
        return Answer(b"".join(one.data for one in answers), sum(one.delay_s for one in answers))

    def _read_many(self, packet: Packet) -> Answer:
        """Sync and bulk reads: the motors reply in the order of the instruction.

        Each waits for the one before it, so after a motor that does not reply no other does.
        """
        if packet.instruction in _SYNC_READS:
            address, size = _word(packet.parameters, 0), _word(packet.parameters, 2)
            asked = [(motor_id, address, size) for motor_id in packet.parameters[4:]]
        else:
            rows = [packet.parameters[k : k + 5] for k in range(0, len(packet.parameters) - 4, 5)]
            asked = [(row[0], _word(row, 1), _word(row, 3)) for row in rows]
        fast = packet.instruction in _FAST_READS
        replies: list[tuple[int, int, bytes]] = []
        delay_s = 0.0
        for motor_id, address, size in asked:
            motor = self.find(motor_id)
            if motor is None or motor["status_return_level"] == 0:
                break
            error, data = motor.read(address, size)
            if fast and error:
                break  # a part has the requested length, or is missing
            replies.append((motor_id, error | motor.alert, data))
            delay_s += motor.return_delay_s
        if not fast:
            return Answer(b"".join(encode_status(*reply) for reply in replies), delay_s)
        first = self.find(asked[0][0]) if replies else None
        if first is None:
            return Answer()
        # The first motor sends the length of the whole packet, even if later parts never come. Only it has a delay.
        announced = sum(fast_status_bytes(size) for _, _, size in asked)
        return Answer(encode_fast_status(replies, announced), first.return_delay_s)

    def _write_all(self, writes: Iterable[tuple[int, int, bytes]]) -> None:
        """Writes that nobody answers, each of an ID, an address and data."""
        followers = self._followers()
        for motor_id, address, data in writes:
            motor = self.find(motor_id)
            if motor is not None:
                motor.write(address, data)
            _write_to(followers.get(motor_id, ()), address, data)

    def _followers(self) -> dict[int, list[Motor]]:
        """The connected motors that do what another one is told, by the ID of that: their secondary ID."""
        followers: dict[int, list[Motor]] = {}
        for motor in self.motors:
            secondary_id, own_id = motor["secondary_id"], motor.motor_id
            if secondary_id < NO_SECONDARY_ID and secondary_id != own_id and own_id not in self.lost:
                followers.setdefault(secondary_id, []).append(motor)
        return followers


def _sync_writes(parameters: bytes) -> Iterator[tuple[int, int, bytes]]:
    address, size = _word(parameters, 0), _word(parameters, 2)
    for k in range(4, len(parameters) - size, 1 + size):
        yield parameters[k], address, parameters[k + 1 : k + 1 + size]


def _bulk_writes(parameters: bytes) -> Iterator[tuple[int, int, bytes]]:
    k = 0
    while k + 5 <= len(parameters):
        address, size = _word(parameters, k + 1), _word(parameters, k + 3)
        yield parameters[k], address, parameters[k + 5 : k + 5 + size]
        k += 5 + size


def _write_to(followers: Iterable[Motor], address: int, data: bytes) -> None:
    """Write to followers: only the RAM, and without a reply."""
    if address >= EEPROM_END:
        for motor in followers:
            motor.write(address, data)


def _word(data: bytes, at: int) -> int:
    return int.from_bytes(data[at : at + 2], "little")


def _answer_of(motor: Motor, packet: Packet) -> Answer:
    """Reply of one motor to an instruction."""
    level = motor["status_return_level"]
    error, data = _carry_out(motor, packet)
    if packet.instruction == Instruction.PING or level == 2 or (level == 1 and packet.instruction == Instruction.READ):
        return Answer(encode_status(motor.motor_id, error | motor.alert, data), motor.return_delay_s)
    return Answer()


def _carry_out(motor: Motor, packet: Packet) -> tuple[int, bytes]:
    parameters = packet.parameters
    match packet.instruction:
        case Instruction.PING:
            return StatusError.NONE, motor.read(0, 2)[1] + motor.read(6, 1)[1]
        case Instruction.READ:
            if len(parameters) != 4:
                return StatusError.DATA_LENGTH, b""
            return motor.read(_word(parameters, 0), _word(parameters, 2))
        case Instruction.WRITE:
            if len(parameters) < 3:
                return StatusError.DATA_LENGTH, b""
            return motor.write(_word(parameters, 0), parameters[2:]), b""
        case Instruction.REG_WRITE:
            return motor.register_write(parameters), b""
        case Instruction.ACTION:
            return motor.action(), b""
        case Instruction.REBOOT:
            motor.reboot()
            return StatusError.NONE, b""
        case _:
            return StatusError.INSTRUCTION, b""
