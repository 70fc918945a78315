# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Head, checksum and stuffing of all packets between host and board. `docs/wire_protocol.md` is the description.

A packet is little-endian and begins with type, version and its own length; a CRC-32 ends it. It travels stuffed (see
`acts_core.wire.cobs`) and followed by one zero byte.
"""

from __future__ import annotations

import struct
import zlib
from enum import IntEnum

import numpy as np

from acts_core.errors import PacketError
from acts_core.wire.cobs import DELIMITER, encoded_size_max
from acts_core.wire.cobs_kernels import encode_into

VERSION = 1

HEAD = struct.Struct("<BBH")
"""Type, version, length."""

CRC = struct.Struct("<I")


class PacketType(IntEnum):
    """What a packet is. Up to 15 the board speaks, from 16 on the host."""

    SAMPLES = 1
    REPLY = 2
    IMAGE = 3
    OBJECT = 4
    QUERY = 16
    CONFIGURE = 17
    UPLOAD_BEGIN = 18
    UPLOAD_DATA = 19
    UPLOAD_END = 20
    MAP_DATA = 21
    MAP_END = 22


class ChecksumError(PacketError):
    """A packet of the right length whose checksum does not match its content."""


def seal(kind: PacketType, content: bytes) -> bytes:
    """Bytes of one packet for the wire, delimiter included.

    Parameters
    ----------
    kind : PacketType
        Which packet.
    content : bytes
        What stands between the length and the CRC.
    """
    return stuffed(HEAD.pack(kind, VERSION, HEAD.size + len(content) + CRC.size) + content)


def stuffed(packet: bytes) -> bytes:
    """Bytes for the wire of a packet that lacks only its CRC; delimiter included."""
    packet += CRC.pack(zlib.crc32(packet))
    encoded = np.empty(encoded_size_max(len(packet)), dtype=np.uint8)
    return encoded[: encode_into(packet, encoded)].tobytes() + DELIMITER


def unseal(packet: bytes) -> tuple[int, bytes]:
    """Type of a packet, given without stuffing, and what stands between its length and its CRC.

    Raises
    ------
    ChecksumError
        When the packet was damaged on its way.
    PacketError
        When its length or version is not what it must be.
    """
    if len(packet) < HEAD.size + CRC.size:
        raise PacketError(f"packet of {len(packet)} bytes; the shortest has {HEAD.size + CRC.size}")
    kind, version, length = HEAD.unpack_from(packet)
    end = len(packet) - CRC.size
    if length != len(packet):
        raise PacketError(f"packet of {len(packet)} bytes says it has {length}")
    if zlib.crc32(packet[:end]) != CRC.unpack_from(packet, end)[0]:
        raise ChecksumError(f"CRC-32 of a packet of {len(packet)} bytes does not match")
    if version != VERSION:
        raise version_mismatch(f"packet type {kind}, version {version}; this release reads version {VERSION}")
    return kind, packet[HEAD.size : end]


def version_mismatch(what: str) -> PacketError:
    """The error for a whole packet that this release does not know."""
    return PacketError(f"{what}: install firmware and driver of the same release, with the same schemes")
