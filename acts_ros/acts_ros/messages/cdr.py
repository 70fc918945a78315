# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Serialised messages read and written directly: the header of any message, and all of acts_msgs/Contact.

Beside this are the other messages that come often: `contacts_cdr`, `image_cdr` and `regions_cdr`.

At 1 kHz, building and reading message objects costs several times as much as the work on their numbers; rclpy also
sends and receives bytes. These are CDR (OMG DDS-XTypes 1.3, 7.4.3): four bytes of encapsulation, of which the second
gives the byte order, then the fields in order. Each is aligned to a multiple of its size, counted from the fifth byte.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from acts_core.errors import PacketError
from acts_core.runtime import NS_PER_S

_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}
_LITTLE_ENDIAN = b"\x00\x01\x00\x00"
ENCAPSULATION_BYTES = 4
"""Length of the encapsulation [bytes]; offsets are counted from its end."""
_STAMP = "iII"
"""Seconds, nanoseconds, and the length of frame_id with its terminating zero."""
_STAMP_BYTES = struct.calcsize(f"<{_STAMP}")
_STAMPS = {order: struct.Struct(order + _STAMP) for order in _ORDERS.values()}
LENGTHS = {order: struct.Struct(f"{order}I") for order in _ORDERS.values()}
"""By byte order: the length that a string or a sequence begins with."""
COUNTS = {order: struct.Struct(f"{order}II") for order in _ORDERS.values()}
"""By byte order: the number of a frame, and how many entries of it follow."""
# Of acts_msgs/Contact, after frame_id: each field's `struct` format and size [bytes].
_CONTACT_FIELDS = [(kind, struct.calcsize(f"<{kind}")) for kind in "I?dddfffHfdddfff"]
# Cached layouts: one for each frame_id, or length of it.
_LAYOUTS_KEPT = 64


class ContactFields(NamedTuple):
    """acts_msgs/Contact, in the order and the units of its fields. Forces and areas have 32 bits, as in the message."""

    stamp_ns: int
    frame_id: str
    sequence: int
    in_contact: bool
    x_m: float
    y_m: float
    force_n: float
    peak_counts: float
    area_m2: float
    active_taxels: int
    spread_m: float
    x_sd_m: float
    y_sd_m: float
    force_sd_n: float
    area_sd_m2: float
    spread_sd_m: float


def header_of(data: bytes) -> tuple[int, str]:
    """Stamp [ns] and frame_id of a serialised message that begins with a header.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    stamp_ns, frame_id, _, _ = header_parts(data)
    return stamp_ns, frame_id


def sequence_of(data: bytes) -> int:
    """Number of the frame of a serialised message that has it after its header, as samples and contact.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    _, _, order, at = header_parts(data)
    try:
        (sequence,) = LENGTHS[order].unpack_from(data, ENCAPSULATION_BYTES + at + -at % LENGTHS[order].size)
    except struct.error as error:
        raise PacketError(f"message of {len(data)} bytes cannot be read: {error}") from error
    return int(sequence)


def write_contact(contact: ContactFields) -> bytes:
    """Serialise a contact, as rclpy does it on a little-endian machine.

    Raises
    ------
    PacketError
        When a number is beyond what its field holds.
    """
    stamp_ns, frame_id, sequence, in_contact, x_m, y_m, *numbers, x_sd_m, y_sd_m, force_sd, area_sd, spread_sd = contact
    layout, name = _whole_contact(frame_id)
    sec, nanosec = divmod(stamp_ns, NS_PER_S)
    stamp = _LITTLE_ENDIAN, sec, nanosec, len(name), name
    try:
        return layout.pack(
            *stamp, sequence, in_contact, x_m, y_m, 0.0, *numbers, x_sd_m, y_sd_m, 0.0, force_sd, area_sd, spread_sd
        )
    except (struct.error, OverflowError) as error:
        raise PacketError(f"{contact} does not fit the message: {error}") from error


def read_contact(data: bytes) -> ContactFields:
    """Read a serialised acts_msgs/Contact.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    return contact_parts(data)[0]


def contact_parts(data: bytes) -> tuple[ContactFields, str, int]:
    """The contact that a serialised message begins with, byte order as a `struct` format, and offset of its end.

    Raises
    ------
    PacketError
        When the bytes are no message that begins with a contact.
    """
    stamp_ns, frame_id, order, at = header_parts(data)
    layout = _contact(order, at)
    try:
        sequence, in_contact, x_m, y_m, _, *numbers, x_sd_m, y_sd_m, _, force_sd, area_sd, spread_sd = (
            layout.unpack_from(data, ENCAPSULATION_BYTES + at)
        )
    except struct.error as error:
        raise PacketError(f"contact of {len(data)} bytes cannot be read: {error}") from error
    contact = ContactFields._make(
        (stamp_ns, frame_id, sequence, in_contact, x_m, y_m, *numbers, x_sd_m, y_sd_m, force_sd, area_sd, spread_sd)
    )
    return contact, order, at + layout.size


def header_bytes(stamp_ns: int, frame_id: str) -> bytes:
    """Encapsulation and header of a message, little-endian.

    Raises
    ------
    PacketError
        When the stamp is beyond what its field holds.
    """
    name = frame_id.encode()
    sec, nanosec = divmod(stamp_ns, NS_PER_S)
    try:
        return _LITTLE_ENDIAN + _STAMPS["<"].pack(sec, nanosec, len(name) + 1) + name + b"\x00"
    except struct.error as error:
        raise PacketError(f"stamp of {stamp_ns} ns does not fit the message: {error}") from error


def header_parts(data: bytes) -> tuple[int, str, str, int]:
    """Stamp [ns], frame_id, byte order as a `struct` format, and the offset of the header's end.

    Raises
    ------
    PacketError
        When the bytes are no message that begins with a header.
    """
    order = _ORDERS.get(data[:2])
    if order is None:
        raise PacketError(f"message encoded as {data[:2].hex()}; only plain CDR (0000, 0001) is read")
    begin = ENCAPSULATION_BYTES + _STAMP_BYTES
    try:
        sec, nanosec, length = _STAMPS[order].unpack_from(data, ENCAPSULATION_BYTES)
        frame_id = data[begin : begin + length - 1].decode()
    except (struct.error, UnicodeDecodeError) as error:
        raise PacketError(f"message of {len(data)} bytes cannot be read: {error}") from error
    if not 1 <= length <= len(data) - begin:
        raise PacketError(f"message of {len(data)} bytes cannot be read: its frame_id has {length}")
    if nanosec >= NS_PER_S:
        raise PacketError(f"stamp of {nanosec} nanoseconds: a second has {NS_PER_S}")
    return sec * NS_PER_S + nanosec, frame_id, order, _STAMP_BYTES + length


def padded(at: int, fields: Sequence[tuple[str, int]]) -> tuple[str, int]:
    """Lay out numbers in CDR: each at a multiple of its own size.

    Parameters
    ----------
    at : int
        Offset of the first [bytes].
    fields : sequence of (str, int)
        `struct` format and size [bytes] of each.

    Returns
    -------
    str
        `struct` format of all, without the byte order.
    int
        Offset of their end [bytes].
    """
    layout = ""
    for kind, size in fields:
        padding = -at % size
        layout += f"{padding}x{kind}"
        at += padding + size
    return layout, at


@lru_cache(_LAYOUTS_KEPT)
def _contact(order: str, at: int) -> struct.Struct:
    """Layout of the fields after a header that ends at offset `at`."""
    return struct.Struct(order + padded(at, _CONTACT_FIELDS)[0])


@lru_cache(_LAYOUTS_KEPT)
def _whole_contact(frame_id: str) -> tuple[struct.Struct, bytes]:
    """Layout of a whole message, little-endian, and the bytes of its frame_id with their terminating zero."""
    name = frame_id.encode() + b"\x00"
    fields, _ = padded(_STAMP_BYTES + len(name), _CONTACT_FIELDS)
    return struct.Struct(f"<{ENCAPSULATION_BYTES}s{_STAMP}{len(name)}s{fields}"), name
