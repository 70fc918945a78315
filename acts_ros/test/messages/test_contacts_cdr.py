# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts of a frame and series of contacts as bytes, compared with what rclpy itself makes of them."""

import struct
from array import array
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_values import DOUBLES, NAMES, NUMBERS, SINGLES, STAMPS_NS
from rclpy.serialization import deserialize_message, serialize_message

from acts_core.errors import PacketError
from acts_core.skin import TrackedBlob
from acts_msgs.msg import Contact, Contacts, ContactSeries, TrackedContact
from acts_ros.messages import (
    ContactFields,
    ContactsFields,
    SeriesFields,
    read_contact,
    read_contacts,
    read_series,
    write_contact,
    write_contacts,
    write_series,
)

pytestmark = pytest.mark.slow

TRACKED = st.builds(
    TrackedBlob,
    NUMBERS,
    st.integers(0, 255),
    SINGLES,
    *[DOUBLES] * 4,
    *[SINGLES] * 3,
    st.integers(0, 2**16 - 1),
    *[SINGLES] * 2,
    *[DOUBLES] * 4,
    *[SINGLES] * 3,
)
# Of the middleware's numbers: their `struct` formats.
KINDS = dict(zip(("boolean", "uint8", "uint16", "int32", "uint32", "float", "double"), "?BHiIfd", strict=True))
CONTACTS = st.builds(
    ContactsFields, STAMPS_NS, NAMES, NUMBERS, st.lists(TRACKED, max_size=4), st.integers(0, 2**16 - 1)
)


@st.composite
def series(draw: st.DrawFn) -> SeriesFields:
    newest = ContactFields(draw(STAMPS_NS), draw(NAMES), draw(NUMBERS), True, 0.1, 0.2, *(0.5,) * 3, 7, *(0.25,) * 6)
    columns = draw(st.lists(st.tuples(SINGLES, SINGLES, SINGLES, NUMBERS), max_size=5))
    age_s, force_n, delay_s, missing = zip(*columns, strict=True) if columns else ((), (), (), ())
    ages_s, forces_n, delays_s = (np.array(column, np.float32) for column in (age_s, force_n, delay_s))
    return SeriesFields(newest, ages_s, forces_n, delays_s, np.array(missing, np.uint32))


def contacts_message(contacts: ContactsFields) -> Contacts:
    message = Contacts(sequence=contacts.sequence, dropped=contacts.dropped)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(contacts.stamp_ns, 10**9)
    message.header.frame_id = contacts.frame_id
    message.contacts = [tracked_message(tracked) for tracked in contacts.contacts]
    return message


def tracked_message(tracked: TrackedBlob) -> TrackedContact:
    message = TrackedContact(number=tracked.number, merged=tracked.merged, age=tracked.age_s)
    message.position.x, message.position.y = tracked.x_m, tracked.y_m
    message.velocity.x, message.velocity.y = tracked.vx_m_s, tracked.vy_m_s
    message.force, message.peak, message.area = tracked.force_n, tracked.peak_counts, tracked.area_m2
    message.active_taxels, message.spread, message.orientation = (
        tracked.active_taxels,
        tracked.spread_m,
        tracked.angle_rad,
    )
    message.position_sigma.x, message.position_sigma.y = tracked.x_sd_m, tracked.y_sd_m
    message.velocity_sigma.x, message.velocity_sigma.y = tracked.vx_sd_m_s, tracked.vy_sd_m_s
    message.force_sigma, message.area_sigma = tracked.force_sd_n, tracked.area_sd_m2
    message.spread_sigma = tracked.spread_sd_m
    return message


def series_message(one: SeriesFields) -> ContactSeries:
    message = ContactSeries(newest=deserialize_message(write_contact(one.newest), Contact))
    message.age, message.force = array("f", one.age_s.tobytes()), array("f", one.force_n.tobytes())
    message.delay, message.missing = array("f", one.delay_s.tobytes()), array("I", one.missing.tobytes())
    return message


@given(CONTACTS)
def test_contacts_are_written_as_rclpy_writes_them(contacts: ContactsFields) -> None:
    data, message = write_contacts(contacts), contacts_message(contacts)
    assert len(data) == len(serialize_message(message))
    # As text, in which one NaN is like another. The bytes differ where fields are padded.
    assert repr(deserialize_message(data, Contacts)) == repr(message)


@given(CONTACTS)
def test_contacts_of_rclpy_are_read(contacts: ContactsFields) -> None:
    assert repr(read_contacts(serialize_message(contacts_message(contacts)))) == repr(contacts)


@given(series())
def test_a_series_is_written_as_rclpy_writes_it(one: SeriesFields) -> None:
    data, message = write_series(one), series_message(one)
    assert len(data) == len(serialize_message(message))
    assert repr(deserialize_message(data, ContactSeries)) == repr(message)


@given(series())
def test_a_series_of_rclpy_is_read(one: SeriesFields) -> None:
    read = read_series(serialize_message(series_message(one)))
    assert repr(read.newest) == repr(one.newest)
    for got, given_ in zip(read[1:], one[1:], strict=True):
        np.testing.assert_array_equal(got, given_)


class BigEndian:
    """Writes a message as a machine of the other byte order does: each field at a multiple of its own size."""

    def __init__(self, message: Any) -> None:
        self._body = b""
        self._fields(message)
        self.data = b"\x00\x00\x00\x00" + self._body

    def _fields(self, message: Any) -> None:
        for name, kind in message.get_fields_and_field_types().items():
            self._value(kind, getattr(message, name))

    def _value(self, kind: str, value: Any) -> None:
        if kind.startswith("sequence<"):
            self._value("uint32", len(value))
            for one in value:
                self._value(kind[9:-1], one)
        elif kind == "string":
            text = value.encode() + b"\0"
            self._value("uint32", len(text))
            self._body += text
        elif kind in KINDS:
            data = struct.pack(f">{KINDS[kind]}", value)
            self._body += bytes(-len(self._body) % len(data)) + data
        else:
            self._fields(value)


@given(CONTACTS)
def test_contacts_of_a_machine_of_the_other_byte_order_are_read(contacts: ContactsFields) -> None:
    assert repr(read_contacts(BigEndian(contacts_message(contacts)).data)) == repr(contacts)


@given(series())
def test_a_series_of_a_machine_of_the_other_byte_order_is_read(one: SeriesFields) -> None:
    read = read_series(BigEndian(series_message(one)).data)
    assert write_series(read) == write_series(one)
    assert repr(read.newest) == repr(one.newest)
    for got, given_ in zip(read[1:], one[1:], strict=True):
        np.testing.assert_array_equal(got, given_)


@given(CONTACTS, st.data())
def test_contacts_that_were_cut_off_are_refused(contacts: ContactsFields, data: st.DataObject) -> None:
    whole = write_contacts(contacts)
    with pytest.raises(PacketError, match=r"cannot be read|encoded as"):
        read_contacts(whole[: data.draw(st.integers(0, len(whole) - 1))])


@given(series(), st.data())
def test_a_series_that_was_cut_off_is_refused(one: SeriesFields, data: st.DataObject) -> None:
    whole = write_series(one)
    with pytest.raises(PacketError, match=r"cannot be read|encoded as"):
        read_series(whole[: data.draw(st.integers(0, len(whole) - 1))])


@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    for bytes_ in (data, b"\x00\x01\x00\x00" + data, b"\x00\x00\x00\x00" + data):
        for read in (read_contacts, read_series):
            try:
                read(bytes_)
            except PacketError as error:
                assert str(error)  # noqa: PT017 - either way is right


@pytest.mark.parametrize("change", [{"number": -1}, {"force_n": 1e39}, {"active_taxels": 70000}, {"merged": 256}])
def test_numbers_beyond_their_field_are_refused(change: dict[str, Any]) -> None:
    tracked = TrackedBlob(1, 0, *(0.0,) * 8, 3, *(0.0,) * 9)._replace(**change)
    with pytest.raises(PacketError, match="does not fit the message"):
        write_contacts(ContactsFields(0, "", 0, [tracked], 0))


def test_the_newest_of_a_series_is_read_like_a_contact() -> None:
    newest = ContactFields(5, "plate", 9, False, *(0.0,) * 5, 0, *(0.0,) * 6)
    nothing = np.empty(0, np.float32)
    data = write_series(SeriesFields(newest, nothing, nothing, nothing, np.empty(0, np.uint32)))
    assert read_contact(data) == read_series(data).newest == newest
