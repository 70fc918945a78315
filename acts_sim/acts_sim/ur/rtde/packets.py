# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Packets of the Real-Time Data Exchange (RTDE), version 2: big-endian, a 3-byte header before each payload.

Header: uint16 size of the whole packet, uint8 type. See the RTDE guide of Universal Robots.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from acts_core.errors import PacketError

HEADER = struct.Struct(">HB")

MAX_PACKET_BYTES = 0xFFFF

PROTOCOL_VERSION = 2


class PacketType(IntEnum):
    """The type byte of a packet."""

    REQUEST_PROTOCOL_VERSION = ord("V")
    GET_URCONTROL_VERSION = ord("v")
    TEXT_MESSAGE = ord("M")
    DATA_PACKAGE = ord("U")
    SETUP_OUTPUTS = ord("O")
    SETUP_INPUTS = ord("I")
    START = ord("S")
    PAUSE = ord("P")


_KNOWN_TYPES = frozenset(int(kind) for kind in PacketType)

TYPE_FORMATS = {
    "BOOL": "?",
    "UINT8": "B",
    "UINT32": "I",
    "UINT64": "Q",
    "INT32": "i",
    "DOUBLE": "d",
    "VECTOR3D": "3d",
    "VECTOR6D": "6d",
    "VECTOR6INT32": "6i",
}
"""`struct` format of each RTDE type."""

Number = int | float
Value = Number | tuple[Number, ...]


def encode(kind: PacketType, payload: bytes = b"") -> bytes:
    """A packet with its header.

    Raises
    ------
    PacketError
        When the payload does not fit a packet (65532 bytes).
    """
    size = HEADER.size + len(payload)
    if size > MAX_PACKET_BYTES:
        raise PacketError(f"a payload of {len(payload)} bytes does not fit an RTDE packet of at most 65535")
    return HEADER.pack(size, kind) + payload


class PacketReader:
    """Splits a byte stream, which arrives in pieces of any size, into packets."""

    def __init__(self) -> None:
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[tuple[PacketType, bytes]]:
        """The packets that `data` completes, as (type, payload), oldest first.

        Raises
        ------
        PacketError
            When a header is invalid. The stream has no mark to resynchronise on, so the connection must be closed.
        """
        self._buffer += data
        packets = []
        start = 0
        while len(self._buffer) - start >= HEADER.size:
            size, kind = HEADER.unpack_from(self._buffer, start)
            if size < HEADER.size or kind not in _KNOWN_TYPES:
                self._buffer.clear()
                raise PacketError(f"not an RTDE packet: size {size}, type {kind}")
            if len(self._buffer) - start < size:
                break
            packets.append((PacketType(kind), bytes(self._buffer[start + HEADER.size : start + size])))
            start += size
        del self._buffer[:start]
        return packets


def split_names(payload: bytes) -> list[str]:
    """Names of variables separated by commas; there may be one after the last."""
    return [name for name in payload.decode("ascii", errors="replace").split(",") if name]


@dataclass(frozen=True)
class DecodedInputs:
    """Content of an input data package.

    Attributes
    ----------
    values : dict
        Values of the complete fields, by name.
    whole : bool
        False when the payload was shorter than its recipe.
    """

    values: dict[str, Value]
    whole: bool


class InputRecipe:
    """An agreed list of input variables.

    Parameters
    ----------
    names, types : sequence of str
        Names of the variables and their RTDE types, in order.
    """

    def __init__(self, names: Sequence[str], types: Sequence[str]) -> None:
        self.names = tuple(names)
        self.types = tuple(types)
        self._formats = [TYPE_FORMATS[kind] for kind in types]
        self._struct = struct.Struct(">" + "".join(self._formats))
        self._scalars = all(len(text) == 1 for text in self._formats)

    @property
    def size(self) -> int:
        """Length of a whole payload [bytes], without the byte of the recipe's number."""
        return self._struct.size

    def decode(self, payload: bytes) -> DecodedInputs:
        """Decode a payload. If it is too short, decode the complete fields; ignore bytes in excess."""
        if self._scalars and len(payload) >= self._struct.size:
            return DecodedInputs(dict(zip(self.names, self._struct.unpack_from(payload), strict=True)), True)
        values: dict[str, Value] = {}
        offset = 0
        for name, text in zip(self.names, self._formats, strict=True):
            size = struct.calcsize(">" + text)
            if offset + size > len(payload):
                return DecodedInputs(values, False)
            fields = struct.unpack_from(">" + text, payload, offset)
            values[name] = fields[0] if len(fields) == 1 else fields
            offset += size
        return DecodedInputs(values, True)
