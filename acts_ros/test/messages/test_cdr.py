# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Headers and contacts as bytes, compared with what rclpy itself makes of them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_values import DOUBLES, NAMES, NUMBERS, SINGLES, STAMPS_NS
from rclpy.serialization import deserialize_message, serialize_message

from acts_core.errors import PacketError
from acts_msgs.msg import Contact, Contacts, TactileSamples
from acts_ros.messages import ContactFields, header_of, read_contact, sequence_of, write_contact


@st.composite
def contacts(draw: st.DrawFn) -> ContactFields:
    return ContactFields(
        stamp_ns=draw(STAMPS_NS),
        frame_id=draw(NAMES),
        sequence=draw(NUMBERS),
        in_contact=draw(st.booleans()),
        x_m=draw(DOUBLES),
        y_m=draw(DOUBLES),
        force_n=draw(SINGLES),
        peak_counts=draw(SINGLES),
        area_m2=draw(SINGLES),
        active_taxels=draw(st.integers(0, 2**16 - 1)),
        spread_m=draw(SINGLES),
        x_sd_m=draw(DOUBLES),
        y_sd_m=draw(DOUBLES),
        force_sd_n=draw(SINGLES),
        area_sd_m2=draw(SINGLES),
        spread_sd_m=draw(SINGLES),
    )


def message_of(contact: ContactFields) -> Contact:
    message = Contact(sequence=contact.sequence, in_contact=contact.in_contact)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(contact.stamp_ns, 10**9)
    message.header.frame_id = contact.frame_id
    message.centre_of_pressure.x, message.centre_of_pressure.y = contact.x_m, contact.y_m
    message.force, message.peak, message.area = contact.force_n, contact.peak_counts, contact.area_m2
    message.active_taxels, message.spread = contact.active_taxels, contact.spread_m
    message.centre_of_pressure_sigma.x, message.centre_of_pressure_sigma.y = contact.x_sd_m, contact.y_sd_m
    message.force_sigma, message.area_sigma = contact.force_sd_n, contact.area_sd_m2
    message.spread_sigma = contact.spread_sd_m
    return message


@given(contacts())
def test_a_contact_is_written_as_rclpy_writes_it(contact: ContactFields) -> None:
    data, message = write_contact(contact), message_of(contact)
    assert len(data) == len(serialize_message(message))
    # As text, in which one NaN is like another. The bytes differ where fields are padded.
    assert repr(deserialize_message(data, Contact)) == repr(message)


@given(contacts())
def test_a_contact_of_rclpy_is_read(contact: ContactFields) -> None:
    assert repr(read_contact(serialize_message(message_of(contact)))) == repr(contact)


@given(st.sampled_from([Contact, TactileSamples]), NUMBERS, NAMES)
def test_the_number_of_a_frame_is_read(kind: type, sequence: int, frame_id: str) -> None:
    message = kind(sequence=sequence)
    message.header.frame_id = frame_id
    data = serialize_message(message)
    assert sequence_of(data) == sequence
    with pytest.raises(PacketError):
        sequence_of(data[:16])


@given(contacts(), st.data())
def test_what_was_cut_off_is_refused(contact: ContactFields, data: st.DataObject) -> None:
    whole = write_contact(contact)
    with pytest.raises(PacketError, match=r"cannot be read|encoded as"):
        read_contact(whole[: data.draw(st.integers(0, len(whole) - 1))])


@given(STAMPS_NS, NAMES, st.sampled_from([Contact, Contacts]))
def test_the_header_of_any_message_is_read(stamp_ns: int, frame_id: str, kind: type) -> None:
    message = kind()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 10**9)
    message.header.frame_id = frame_id
    assert header_of(serialize_message(message)) == (stamp_ns, frame_id)


def test_the_other_order_of_bytes_is_read() -> None:
    head = bytes.fromhex("00000000 00000001 00000002 00000003 6869 00".replace(" ", ""))
    assert header_of(head) == (10**9 + 2, "hi")
    sequence_and_touch = bytes(1) + bytes.fromhex("00000007 01")
    assert read_contact(head + sequence_and_touch + bytes(120)).sequence == 7


@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    for bytes_ in (data, b"\x00\x01\x00\x00" + data):
        for read in (header_of, read_contact):
            try:
                read(bytes_)
            except PacketError as error:
                assert str(error)  # noqa: PT017 - either way is right


def test_another_encoding_is_refused() -> None:
    data = serialize_message(Contact())
    with pytest.raises(PacketError, match="encoded as 0002; only plain CDR"):
        read_contact(b"\x00\x02" + data[2:])


@pytest.mark.parametrize("change", [{"sequence": -1}, {"force_n": 1e39}, {"active_taxels": 70000}])
def test_numbers_beyond_their_field_are_refused(change: dict[str, float]) -> None:
    contact = read_contact(serialize_message(Contact()))
    with pytest.raises(PacketError, match="does not fit the message"):
        write_contact(contact._replace(**change))  # type: ignore[arg-type]


@pytest.mark.parametrize("nanoseconds", [10**9, 2**32 - 1])
def test_a_stamp_of_too_many_nanoseconds_is_refused(nanoseconds: int) -> None:
    message = Contact()
    message.header.stamp.nanosec = nanoseconds
    with pytest.raises(PacketError, match="a second has 1000000000"):
        read_contact(serialize_message(message))
