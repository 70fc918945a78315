"""Contacts out of their bytes, compared with what rclpy itself makes of them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from acts_control.contact_bytes import read_contact
from acts_control.names import to_ns
from acts_core.errors import PacketError
from acts_msgs.msg import Contact

FLOATS = st.floats(width=32)


@st.composite
def contacts(draw: st.DrawFn) -> Contact:
    message = Contact(sequence=draw(st.integers(0, 2**32 - 1)), in_contact=draw(st.booleans()))
    message.header.frame_id = draw(
        st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=9)
    )
    message.header.stamp.sec = draw(st.integers(-(2**31), 2**31 - 1))
    message.header.stamp.nanosec = draw(st.integers(0, 2**32 - 1))
    message.centre_of_pressure.x, message.centre_of_pressure.y = draw(FLOATS), draw(FLOATS)
    message.force, message.area = draw(FLOATS), draw(FLOATS)
    return message


@given(contacts())
def test_everything_is_read_as_rclpy_reads_it(sent: Contact) -> None:
    data = serialize_message(sent)
    message = deserialize_message(data, Contact)
    sequence, frame_id, measurement = read_contact(data)
    assert (sequence, frame_id) == (message.sequence, message.header.frame_id)
    assert (measurement.stamp_ns, measurement.in_contact) == (to_ns(message.header.stamp), message.in_contact)
    numbers = (measurement.x_m, measurement.y_m, measurement.force_n)
    place = message.centre_of_pressure
    assert numbers == pytest.approx((place.x, place.y, message.force), rel=0, abs=0, nan_ok=True)


@given(st.integers(0, 75))
def test_what_was_cut_off_is_refused(length: int) -> None:
    data = serialize_message(Contact())
    with pytest.raises(PacketError, match=r"cannot be read|encoded as"):
        read_contact(data[: min(length, 44)])


@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    for bytes_ in (data, b"\x00\x01\x00\x00" + data):
        try:
            read_contact(bytes_)
        except PacketError as error:
            assert str(error)  # noqa: PT017 - either way is right


def test_another_encoding_is_refused() -> None:
    data = serialize_message(Contact())
    with pytest.raises(PacketError, match="encoded as 0000; only little-endian"):
        read_contact(b"\x00\x00" + data[2:])
