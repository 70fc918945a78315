# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images as bytes, compared with what rclpy itself makes of them."""

import struct
from array import array

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_values import NAMES, NUMBERS, STAMPS_NS
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import Image

from acts_core.errors import PacketError
from acts_ros.messages import ImageFields, read_image, write_image

IMAGES = st.builds(
    ImageFields,
    stamp_ns=STAMPS_NS,
    frame_id=NAMES,
    height=NUMBERS,
    width=NUMBERS,
    encoding=st.sampled_from(["mono8", "mono16", "rgb8", "32FC1"]) | NAMES,
    is_bigendian=st.booleans(),
    step=NUMBERS,
    data=st.binary(max_size=40),
)


def message_of(image: ImageFields) -> Image:
    message = Image(height=image.height, width=image.width, encoding=image.encoding, step=image.step)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(image.stamp_ns, 10**9)
    message.header.frame_id = image.frame_id
    message.is_bigendian = int(image.is_bigendian)
    message.data = array("B", image.data)
    return message


@given(IMAGES)
def test_an_image_is_written_as_rclpy_writes_it(image: ImageFields) -> None:
    data, message = write_image(image), message_of(image)
    assert len(data) == len(serialize_message(message))
    # The bytes differ where fields are padded.
    assert deserialize_message(data, Image) == message


@given(IMAGES)
def test_an_image_of_rclpy_is_read(image: ImageFields) -> None:
    assert read_image(serialize_message(message_of(image))) == image


@given(IMAGES, st.data())
def test_what_was_cut_off_is_refused(image: ImageFields, data: st.DataObject) -> None:
    whole = write_image(image)
    with pytest.raises(PacketError, match=r"cannot be read|encoded as"):
        read_image(whole[: data.draw(st.integers(0, len(whole) - 1))])


@given(st.binary(max_size=100))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    for bytes_ in (data, b"\x00\x01\x00\x00" + data, b"\x00\x00\x00\x00" + data):
        try:
            read_image(bytes_)
        except PacketError as error:
            assert str(error)  # noqa: PT017 - either way is right


def test_the_other_order_of_bytes_is_read() -> None:
    head = bytes.fromhex("00000000 00000001 00000002 00000003 6869 00 00")
    data = head + struct.pack(">III6sBxIIB", 3, 4, 6, b"mono8\0", 1, 4, 1, 7)
    assert read_image(data) == ImageFields(10**9 + 2, "hi", 3, 4, "mono8", True, 4, b"\x07")


def test_an_encoding_without_its_final_zero_is_refused() -> None:
    head = bytes.fromhex("00000000 00000001 00000002 00000003 6869 00 00")
    with pytest.raises(PacketError, match="its encoding has 0"):
        read_image(head + struct.pack(">IIIBxxxIIB", 3, 4, 0, 1, 4, 1, 7))


@pytest.mark.parametrize("change", [{"height": -1}, {"width": 2**32}, {"step": 2**32}])
def test_numbers_beyond_their_field_are_refused(change: dict[str, int]) -> None:
    image = ImageFields(0, "", 1, 1, "mono8", False, 1, b"\x00")
    with pytest.raises(PacketError, match="does not fit the message"):
        write_image(image._replace(**change))  # type: ignore[arg-type]
