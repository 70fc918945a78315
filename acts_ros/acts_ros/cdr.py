"""Messages as the bytes in which they travel: the header of any, and all of acts_msgs/Contact.

A thousand times a second, making a message with all its parts and taking it apart again costs several times as much as
what is done with its numbers; rclpy sends and receives bytes as well. They are CDR (OMG DDS-XTypes 1.3, 7.4.3): four
bytes of which the second tells the order of bytes, then the fields in their order, each at a multiple of its own size
counted from there.
"""

from __future__ import annotations

import struct
from functools import lru_cache
from typing import NamedTuple

from acts_core.errors import PacketError

_NS_PER_S = 1_000_000_000
_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}
_ENCAPSULATION_BYTES = 4
_STAMP = "iII"
"""Seconds, nanoseconds, and the length of frame_id with its closing zero."""
_STAMP_BYTES = struct.calcsize(f"<{_STAMP}")
_STAMPS = {order: struct.Struct(order + _STAMP) for order in _ORDERS.values()}
# Of acts_msgs/Contact, after frame_id: each field as struct calls it, and its size.
_CONTACT_FIELDS = [(kind, struct.calcsize(f"<{kind}")) for kind in "I?dddfffHfdddfff"]
# One for every length of a frame_id that occurs.
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
    stamp_ns, frame_id, _, _ = _header(data)
    return stamp_ns, frame_id


def write_contact(contact: ContactFields) -> bytes:
    """Serialise a contact, as rclpy does it on a little-endian machine.

    Raises
    ------
    PacketError
        When a number is beyond what its field holds.
    """
    stamp_ns, frame_id, sequence, in_contact, x_m, y_m, *numbers, x_sd_m, y_sd_m, force_sd, area_sd, spread_sd = contact
    name = frame_id.encode()
    sec, nanosec = divmod(stamp_ns, _NS_PER_S)
    length = len(name) + 1
    try:
        head = _STAMPS["<"].pack(sec, nanosec, length)
        tail = _contact("<", length).pack(
            sequence, in_contact, x_m, y_m, 0.0, *numbers, x_sd_m, y_sd_m, 0.0, force_sd, area_sd, spread_sd
        )
    except (struct.error, OverflowError) as error:
        raise PacketError(f"{contact} does not fit the message: {error}") from error
    return b"\x00\x01\x00\x00" + head + name + b"\x00" + tail


def read_contact(data: bytes) -> ContactFields:
    """Read a serialised acts_msgs/Contact.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    stamp_ns, frame_id, order, length = _header(data)
    try:
        sequence, in_contact, x_m, y_m, _, *numbers, x_sd_m, y_sd_m, _, force_sd, area_sd, spread_sd = _contact(
            order, length
        ).unpack_from(data, _ENCAPSULATION_BYTES + _STAMP_BYTES + length)
    except struct.error as error:
        raise PacketError(f"contact of {len(data)} bytes cannot be read: {error}") from error
    return ContactFields._make(
        (stamp_ns, frame_id, sequence, in_contact, x_m, y_m, *numbers, x_sd_m, y_sd_m, force_sd, area_sd, spread_sd)
    )


def _header(data: bytes) -> tuple[int, str, str, int]:
    """Stamp, frame_id, order of bytes, and the length of frame_id with its closing zero."""
    order = _ORDERS.get(data[:2])
    if order is None:
        raise PacketError(f"message encoded as {data[:2].hex()}; only plain CDR (0000, 0001) is read")
    begin = _ENCAPSULATION_BYTES + _STAMP_BYTES
    try:
        sec, nanosec, length = _STAMPS[order].unpack_from(data, _ENCAPSULATION_BYTES)
        frame_id = data[begin : begin + length - 1].decode()
    except (struct.error, UnicodeDecodeError) as error:
        raise PacketError(f"message of {len(data)} bytes cannot be read: {error}") from error
    if not 1 <= length <= len(data) - begin:
        raise PacketError(f"message of {len(data)} bytes cannot be read: its frame_id has {length}")
    if nanosec >= _NS_PER_S:
        raise PacketError(f"stamp of {nanosec} nanoseconds: a second has {_NS_PER_S}")
    return sec * _NS_PER_S + nanosec, frame_id, order, length


@lru_cache(_LAYOUTS_KEPT)
def _contact(order: str, length: int) -> struct.Struct:
    """Layout of what follows a frame_id of so many bytes."""
    layout = order
    at = _STAMP_BYTES + length
    for kind, size in _CONTACT_FIELDS:
        padding = -at % size
        layout += f"{padding}x{kind}"
        at += padding + size
    return struct.Struct(layout)
