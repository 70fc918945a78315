# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Serialised sensor_msgs/Image read and written directly; see `acts_ros.messages.cdr`."""

from __future__ import annotations

import struct
from functools import lru_cache
from typing import NamedTuple

from acts_core.errors import PacketError
from acts_ros.messages.cdr import ENCAPSULATION_BYTES, header_bytes, header_parts, padded

_SIZES = {order: struct.Struct(f"{order}III") for order in "<>"}
_ROWS = {order: struct.Struct(f"{order}II") for order in "<>"}
_LAYOUTS_KEPT = 64


class ImageFields(NamedTuple):
    """sensor_msgs/Image, in the order of its fields; `step` is the length of a row [bytes]."""

    stamp_ns: int
    frame_id: str
    height: int
    width: int
    encoding: str
    is_bigendian: bool
    step: int
    data: bytes


def write_image(image: ImageFields) -> bytes:
    """Serialise an image, as rclpy does it on a little-endian machine.

    Raises
    ------
    PacketError
        When a number is beyond what its field holds.
    """
    stamp_ns, frame_id, height, width, encoding, is_bigendian, step, data = image
    head = header_bytes(stamp_ns, frame_id)
    layout, name = _layout(len(head) - ENCAPSULATION_BYTES, encoding)
    try:
        sizes = layout.pack(height, width, len(name), name, is_bigendian, step, len(data))
    except struct.error as error:
        raise PacketError(f"image of {height} x {width}, step {step}, does not fit the message: {error}") from error
    return b"".join((head, sizes, data))


def read_image(data: bytes) -> ImageFields:
    """Read a serialised sensor_msgs/Image.

    Raises
    ------
    PacketError
        When the bytes are no such message.
    """
    stamp_ns, frame_id, order, at = header_parts(data)
    begin = ENCAPSULATION_BYTES + at + -at % 4
    try:
        height, width, length = _SIZES[order].unpack_from(data, begin)
        begin += _SIZES[order].size
        encoding = data[begin : begin + length - 1].decode()
        begin += length
        is_bigendian = data[begin] != 0
        # The next field begins at a multiple of four, counted from the end of the encapsulation.
        begin += 1 + -(begin + 1 - ENCAPSULATION_BYTES) % 4
        step, size = _ROWS[order].unpack_from(data, begin)
    except (struct.error, UnicodeDecodeError, IndexError) as error:
        raise PacketError(f"image of {len(data)} bytes cannot be read: {error}") from error
    begin += _ROWS[order].size
    if length < 1 or size > len(data) - begin:
        raise PacketError(f"image of {len(data)} bytes cannot be read: its encoding has {length}, its pixels {size}")
    return ImageFields(stamp_ns, frame_id, height, width, encoding, is_bigendian, step, data[begin : begin + size])


@lru_cache(_LAYOUTS_KEPT)
def _layout(at: int, encoding: str) -> tuple[struct.Struct, bytes]:
    """Layout from a header that ends at `at` to the pixels, and the bytes of the encoding with their final zero."""
    name = encoding.encode() + b"\x00"
    sizes, at = padded(at, [("I", 4)] * 3)
    others, _ = padded(at + len(name), [("?", 1), ("I", 4), ("I", 4)])
    return struct.Struct(f"<{sizes}{len(name)}s{others}"), name
