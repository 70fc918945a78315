# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Serialised acts_msgs/RegionContacts read and written directly; see `acts_ros.messages.cdr`."""

from __future__ import annotations

import struct
from functools import lru_cache
from typing import NamedTuple

from acts_core.errors import PacketError
from acts_core.skin import RegionContact
from acts_ros.messages.cdr import COUNTS, ENCAPSULATION_BYTES, LENGTHS, header_bytes, header_parts, padded

# Of acts_msgs/RegionContact, after its two names: each field's `struct` format and size [bytes].
_FIELDS = [(kind, struct.calcsize(f"<{kind}")) for kind in "Hfddddddfffffdddf?"]
# Cached layouts: one for each skin whose regions are written.
_SKINS_KEPT = 64


class RegionsFields(NamedTuple):
    """acts_msgs/RegionContacts, in the order and the units of its fields.

    Centres, normals and motion have 64 bits in the message, all other numbers 32.
    """

    stamp_ns: int
    frame_id: str
    sequence: int
    regions: list[RegionContact]


def write_regions(fields: RegionsFields) -> bytes:
    """Serialise the contacts on the patches of a skin, as rclpy does it on a little-endian machine.

    Raises
    ------
    PacketError
        When a number is beyond what its field holds.
    """
    stamp_ns, frame_id, sequence, regions = fields
    head = header_bytes(stamp_ns, frame_id)
    values: list[bytes | float] = []
    lengths = []
    for name, link, active, force, centre, normal, area, peak, spread, share, sharp, motion, slip, slipping in regions:
        name_bytes, link_bytes = name.encode(), link.encode()
        lengths.append((len(name_bytes) + 1, len(link_bytes) + 1))
        values += (len(name_bytes) + 1, name_bytes, len(link_bytes) + 1, link_bytes, active, force)
        values += (*centre, *normal, area, peak, spread, share, sharp, *motion, slip, slipping)
    try:
        return head + _whole(len(head) - ENCAPSULATION_BYTES, tuple(lengths)).pack(sequence, len(regions), *values)
    except (struct.error, OverflowError) as error:
        raise PacketError(f"sequence {sequence}, regions {list(regions)} do not fit the message: {error}") from error


def read_regions(data: bytes) -> RegionsFields:
    """Read a serialised acts_msgs/RegionContacts.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    stamp_ns, frame_id, order, at = header_parts(data)
    regions = []
    try:
        at += -at % 4
        sequence, count = COUNTS[order].unpack_from(data, ENCAPSULATION_BYTES + at)
        at += 8
        for _ in range(count):
            name, at = _string(data, at, order)
            link, at = _string(data, at, order)
            numbers = _numbers(order, at % 8)
            active, force, x, y, z, nx, ny, nz, area, peak, spread, share, sharp, vx, vy, vz, slip, slipping = (
                numbers.unpack_from(data, ENCAPSULATION_BYTES + at)
            )
            at += numbers.size
            centre, normal, motion = (x, y, z), (nx, ny, nz), (vx, vy, vz)
            regions.append(
                RegionContact(
                    name, link, active, force, centre, normal, area, peak, spread, share, sharp, motion, slip, slipping
                )
            )
    except (struct.error, UnicodeDecodeError) as error:
        raise PacketError(f"regions of {len(data)} bytes cannot be read: {error}") from error
    return RegionsFields(stamp_ns, frame_id, sequence, regions)


def _string(data: bytes, at: int, order: str) -> tuple[str, int]:
    """The string at an offset, and the offset of its end."""
    at += -at % 4
    (length,) = LENGTHS[order].unpack_from(data, ENCAPSULATION_BYTES + at)
    begin = ENCAPSULATION_BYTES + at + 4
    if not 1 <= length <= len(data) - begin:
        raise PacketError(f"regions of {len(data)} bytes cannot be read: a name has {length}")
    return data[begin : begin + length - 1].decode(), at + 4 + length


@lru_cache(16)
def _numbers(order: str, at: int) -> struct.Struct:
    """Layout of the numbers of a region that begin at offset `at`, modulo 8."""
    return struct.Struct(order + padded(at, _FIELDS)[0])


@lru_cache(_SKINS_KEPT)
def _whole(at: int, lengths: tuple[tuple[int, int], ...]) -> struct.Struct:
    """Layout after a header that ends at `at`; `lengths` of name and link of each region include the final zero."""
    layout, at = padded(at, [("I", 4), ("I", 4)])
    for both in lengths:
        for length in both:
            piece, at = padded(at, [("I", 4)])
            layout += f"{piece}{length}s"
            at += length
        piece, at = padded(at, _FIELDS)
        layout += piece
    return struct.Struct(f"<{layout}")
