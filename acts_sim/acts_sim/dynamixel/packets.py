# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Packets of the Dynamixel Protocol 2.0 (https://emanual.robotis.com/docs/en/dxl/protocol2/).

A packet is ``FF FF FD 00``, the ID, the length of the rest as two bytes, an instruction, its parameters, and a CRC of
all before it. Wherever ``FF FF FD`` occurs from the instruction on, another ``FD`` is stuffed in behind it.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

HEADER = b"\xff\xff\xfd\x00"

BROADCAST_ID = 0xFE

MAX_LENGTH = 1024
"""Largest valid value of a length field; a larger one is treated as noise."""

_MARK = b"\xff\xff\xfd"
# Header, ID and length are not included in the length.
_PREFIX_BYTES = 7
_CRC_BYTES = 2
_CRC_POLYNOMIAL = 0x8005


class Instruction(IntEnum):
    """Instructions of packets."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    REBOOT = 0x08
    CLEAR = 0x10
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93
    FAST_BULK_READ = 0x9A


class Packet(NamedTuple):
    """A received packet.

    Attributes
    ----------
    motor_id : int
        ID of the addressee.
    instruction : int
        A number of `Instruction`, or an unknown one.
    parameters : bytes
        Without stuffing.
    """

    motor_id: int
    instruction: int
    parameters: bytes


def _crc_entry(byte: int) -> int:
    crc = byte << 8
    for _ in range(8):
        crc = (crc << 1) ^ (_CRC_POLYNOMIAL if crc & 0x8000 else 0)
    return crc & 0xFFFF


_CRC_TABLE = [_crc_entry(byte) for byte in range(256)]


def crc16(data: bytes) -> int:
    """CRC-16 with polynomial 0x8005, highest bit first, starting at 0."""
    crc = 0
    for byte in data:
        crc = (crc << 8 & 0xFFFF) ^ _CRC_TABLE[crc >> 8 ^ byte]
    return crc


def stuff(body: bytes) -> bytes:
    """Stuff instruction and parameters for the wire."""
    return body.replace(_MARK, _MARK + b"\xfd")


def unstuff(body: bytes) -> bytes:
    """The inverse of `stuff`."""
    return body.replace(_MARK + b"\xfd", _MARK)


def encode(motor_id: int, instruction: int, parameters: bytes = b"") -> bytes:
    """A whole packet."""
    body = stuff(bytes([instruction]) + parameters)
    packet = HEADER + bytes([motor_id]) + (len(body) + _CRC_BYTES).to_bytes(2, "little") + body
    return packet + crc16(packet).to_bytes(2, "little")


def encode_status(motor_id: int, error: int, parameters: bytes = b"") -> bytes:
    """Status packet: the reply of one motor."""
    return encode(motor_id, Instruction.STATUS, bytes([error]) + parameters)


def fast_status_bytes(size: int) -> int:
    """Length of a motor's part of the reply to a fast read of `size` bytes: error, ID, data, CRC."""
    return 2 + size + _CRC_BYTES


def encode_fast_status(replies: list[tuple[int, int, bytes]], announced_bytes: int) -> bytes:
    """The one reply to a fast read, to which each motor adds its part.

    Parameters
    ----------
    replies : list of (ID, error, data)
        In the order of the request.
    announced_bytes : int
        Length of all parts, including missing ones.

    Returns
    -------
    bytes
        Each part ends with the CRC of the whole packet up to there. Nothing is stuffed.
    """
    length = (1 + announced_bytes) & 0xFFFF
    packet = HEADER + bytes([BROADCAST_ID]) + length.to_bytes(2, "little") + bytes([Instruction.STATUS])
    for motor_id, error, data in replies:
        packet += bytes([error, motor_id]) + data
        packet += crc16(packet).to_bytes(2, "little")
    return packet


class PacketReader:
    """Finds packets in a stream of bytes.

    Attributes
    ----------
    damaged : int
        Packets whose CRC was wrong.
    """

    def __init__(self) -> None:
        self.damaged = 0
        self._buffer = b""

    def feed(self, data: bytes) -> list[Packet]:
        """Packets that the new bytes complete, except status packets."""
        self._buffer += data
        packets: list[Packet] = []
        while True:
            start = self._buffer.find(HEADER)
            # Keep what may be the start of a header.
            self._buffer = self._buffer[start:] if start >= 0 else self._buffer[-len(HEADER) + 1 :]
            if start < 0 or len(self._buffer) < _PREFIX_BYTES:
                return packets
            length = int.from_bytes(self._buffer[5:_PREFIX_BYTES], "little")
            end = _PREFIX_BYTES + length
            crc = self._buffer[end - _CRC_BYTES : end]
            if not _CRC_BYTES < length <= MAX_LENGTH:
                self._buffer = self._buffer[1:]
            elif len(self._buffer) < end:
                return packets
            elif crc16(self._buffer[: end - _CRC_BYTES]) != int.from_bytes(crc, "little"):
                # A packet that was cut off may contain the start of the next one: search it for a header.
                self.damaged += 1
                self._buffer = self._buffer[1:]
            else:
                body = unstuff(self._buffer[_PREFIX_BYTES : end - _CRC_BYTES])
                if body[0] != Instruction.STATUS:
                    packets.append(Packet(self._buffer[4], body[0], body[1:]))
                self._buffer = self._buffer[end:]

    def forget(self) -> None:
        """Drop an incomplete packet after a timeout."""
        self._buffer = b""
