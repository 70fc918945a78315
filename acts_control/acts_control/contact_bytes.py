"""What the estimator needs of a contact, out of the bytes in which acts_msgs/Contact travels.

A thousand times a second, making the message with all its parts takes several times as long as the estimate itself. The
bytes are CDR (OMG DDS-XTypes 1.3, 7.4.3): four bytes that tell how the rest is encoded, then the fields in their order,
each at a multiple of its own size counted from there.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from acts_control.estimator import ContactMeasurement
from acts_core.errors import PacketError

_NS_PER_S = 1_000_000_000
_HEAD = 4

# Stamp and length of frame_id; sequence and in_contact; centre of pressure and force.
_STAMP = struct.Struct("<iII")
_SEQUENCE = struct.Struct("<I?")
_PLACE = struct.Struct("<dddf")


class ReceivedContact(NamedTuple):
    """A contact as far as it is read.

    Attributes
    ----------
    sequence : int
        Number of the frame.
    frame_id : str
        Frame of the skin.
    measurement : ContactMeasurement
    """

    sequence: int
    frame_id: str
    measurement: ContactMeasurement


def read_contact(data: bytes) -> ReceivedContact:
    """Read a serialised acts_msgs/Contact.

    Raises
    ------
    PacketError
        When the bytes are too few, or encoded otherwise than in little-endian CDR.
    """
    if data[:2] != b"\x00\x01":
        raise PacketError(f"contact encoded as {data[:2].hex()}; only little-endian CDR (0001) is read")
    try:
        sec, nanosec, length = _STAMP.unpack_from(data, _HEAD)
        begin = _HEAD + _STAMP.size
        end = begin + length
        at = _aligned(end, 4)
        sequence, in_contact = _SEQUENCE.unpack_from(data, at)
        x_m, y_m, _, force_n = _PLACE.unpack_from(data, _aligned(at + _SEQUENCE.size, 8))
        # Without the zero at its end.
        frame_id = data[begin : end - 1].decode()
    except (struct.error, UnicodeDecodeError) as error:
        raise PacketError(f"contact of {len(data)} bytes cannot be read: {error}") from error
    measurement = ContactMeasurement(sec * _NS_PER_S + nanosec, in_contact, x_m, y_m, force_n)
    return ReceivedContact(sequence, frame_id, measurement)


def _aligned(offset: int, size: int) -> int:
    return _HEAD + -(-(offset - _HEAD) // size) * size
