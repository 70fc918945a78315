# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Serialised acts_msgs/Contacts and ContactSeries read and written directly; see `acts_ros.messages.cdr`."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import PacketError
from acts_core.skin import TrackedBlob
from acts_ros.messages.cdr import (
    COUNTS,
    ENCAPSULATION_BYTES,
    LENGTHS,
    ContactFields,
    contact_parts,
    header_bytes,
    header_parts,
    padded,
    write_contact,
)

# Of acts_msgs/TrackedContact, which has the fields of `TrackedBlob`: each field's `struct` format and size [bytes].
_FIELDS = [(kind, struct.calcsize(f"<{kind}")) for kind in "IBfddddddfffHffddddddfff"]
_LAYOUTS_KEPT = 256


class ContactsFields(NamedTuple):
    """acts_msgs/Contacts, in the order of its fields.

    Places, velocities and their deviations have 64 bits in the message, all other numbers with a fraction 32.
    """

    stamp_ns: int
    frame_id: str
    sequence: int
    contacts: Sequence[TrackedBlob]
    dropped: int


class SeriesFields(NamedTuple):
    """acts_msgs/ContactSeries, in the order of its fields.

    Attributes
    ----------
    newest : ContactFields
    age_s, force_n, delay_s : np.ndarray [shape=(n,), dtype=float32]
    missing : np.ndarray [shape=(n,), dtype=uint32]
    """

    newest: ContactFields
    age_s: NDArray[np.float32]
    force_n: NDArray[np.float32]
    delay_s: NDArray[np.float32]
    missing: NDArray[np.uint32]


def write_contacts(contacts: ContactsFields) -> bytes:
    """Serialise the contacts of a frame, as rclpy does it on a little-endian machine.

    Raises
    ------
    PacketError
        When a number is beyond what its field holds.
    """
    stamp_ns, frame_id, sequence, entries, dropped = contacts
    head = header_bytes(stamp_ns, frame_id)
    values: list[float] = []
    for number, merged, age, x, y, vx, vy, *numbers, x_sd, y_sd, vx_sd, vy_sd, force_sd, area_sd, spread_sd in entries:
        values += (number, merged, age, x, y, 0.0, vx, vy, 0.0, *numbers)
        values += (x_sd, y_sd, 0.0, vx_sd, vy_sd, 0.0, force_sd, area_sd, spread_sd)
    try:
        layout = _whole(len(head) - ENCAPSULATION_BYTES, len(entries))
        return head + layout.pack(sequence, len(entries), *values, dropped)
    except (struct.error, OverflowError) as error:
        raise PacketError(f"{contacts} does not fit the message: {error}") from error


def read_contacts(data: bytes) -> ContactsFields:
    """Read a serialised acts_msgs/Contacts.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    stamp_ns, frame_id, order, at = header_parts(data)
    contacts = []
    try:
        at += -at % 4
        sequence, count = COUNTS[order].unpack_from(data, ENCAPSULATION_BYTES + at)
        at += 8
        for _ in range(count):
            layout = _tracked(order, at % 8)
            number, merged, age, x, y, _, vx, vy, _, *numbers = layout.unpack_from(data, ENCAPSULATION_BYTES + at)
            *numbers, x_sd, y_sd, _, vx_sd, vy_sd, _, force_sd, area_sd, spread_sd = numbers
            deviations = x_sd, y_sd, vx_sd, vy_sd, force_sd, area_sd, spread_sd
            contacts.append(TrackedBlob._make((number, merged, age, x, y, vx, vy, *numbers, *deviations)))
            at += layout.size
        (dropped,) = struct.unpack_from(f"{order}H", data, ENCAPSULATION_BYTES + at + -at % 2)
    except struct.error as error:
        raise PacketError(f"contacts of {len(data)} bytes cannot be read: {error}") from error
    return ContactsFields(stamp_ns, frame_id, sequence, contacts, dropped)


def write_series(series: SeriesFields) -> bytes:
    """Serialise the contacts since the message before, as rclpy does it on a little-endian machine.

    Raises
    ------
    PacketError
        When a number is beyond what its field holds.
    """
    newest, *columns = series
    parts = [write_contact(newest)]
    # A contact ends with a number of four bytes, and each column is made of them: nothing is padded.
    for column in columns:
        parts += [LENGTHS["<"].pack(len(column)), column.astype(column.dtype.newbyteorder("<"), copy=False).tobytes()]
    return b"".join(parts)


def read_series(data: bytes) -> SeriesFields:
    """Read a serialised acts_msgs/ContactSeries.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    newest, order, at = contact_parts(data)
    begin = ENCAPSULATION_BYTES + at
    columns = []
    for kind in ("f4", "f4", "f4", "u4"):
        try:
            (count,) = LENGTHS[order].unpack_from(data, begin)
            columns.append(np.frombuffer(data, np.dtype(order + kind), count, begin + 4))
        except (struct.error, ValueError) as error:
            raise PacketError(f"series of {len(data)} bytes cannot be read: {error}") from error
        begin += 4 + 4 * count
    age_s, force_n, delay_s, missing = columns
    return SeriesFields(newest, age_s, force_n, delay_s, missing)


@lru_cache(16)
def _tracked(order: str, at: int) -> struct.Struct:
    """Layout of a contact that begins at offset `at`, modulo 8."""
    return struct.Struct(order + padded(at, _FIELDS)[0])


@lru_cache(_LAYOUTS_KEPT)
def _whole(at: int, count: int) -> struct.Struct:
    """Layout after a header that ends at `at`, of so many contacts."""
    return struct.Struct("<" + padded(at, [("I", 4), ("I", 4), *(_FIELDS * count), ("H", 2)])[0])
