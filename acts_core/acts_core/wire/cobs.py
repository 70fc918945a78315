# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Consistent Overhead Byte Stuffing: packets free of zero bytes, so that a zero can delimit them.

Every run of up to 254 bytes without a zero is preceded by a code, its length plus one; a code below 255 also stands for
the zero that ended the run (Cheshire and Baker, IEEE/ACM Transactions on Networking 7(2), 1999,
doi:10.1109/90.769765). Here it is in plain Python, one packet at a time; `acts_core.wire.cobs_kernels` is the same for
the stream. The tests compare that and the firmware with this.
"""

from __future__ import annotations

from acts_core.errors import PacketError

DELIMITER = b"\x00"

_FULL_RUN = 254


def encoded_size_max(size: int) -> int:
    """Largest length of the encoding of `size` bytes, without the delimiter."""
    return size + size // _FULL_RUN + 1


def encode(data: bytes) -> bytes:
    """Stuff one packet; the result holds no zero byte and no delimiter.

    Examples
    --------
    >>> encode(bytes([1, 0, 2]))
    b'\\x02\\x01\\x02\\x02'
    """
    encoded = bytearray()
    runs = data.split(DELIMITER)
    for number, run in enumerate(runs):
        is_last = number == len(runs) - 1
        while len(run) >= _FULL_RUN and not (is_last and len(run) == _FULL_RUN):
            encoded.append(_FULL_RUN + 1)
            encoded += run[:_FULL_RUN]
            run = run[_FULL_RUN:]
        encoded.append(len(run) + 1)
        encoded += run
    return bytes(encoded)


def decode(encoded: bytes) -> bytes:
    """Undo the stuffing of one packet, given without its delimiter.

    Raises
    ------
    PacketError
        When `encoded` holds a zero, or a code that points past the end.
    """
    if DELIMITER in encoded:
        raise PacketError(f"zero at byte {encoded.index(DELIMITER)} of a stuffed packet; split at zeros first")
    decoded = bytearray()
    position = 0
    while position < len(encoded):
        code = encoded[position]
        if position + code > len(encoded):
            raise PacketError(
                f"code {code} at byte {position} of a stuffed packet of {len(encoded)} bytes points past its end"
            )
        decoded += encoded[position + 1 : position + code]
        position += code
        if code <= _FULL_RUN and position < len(encoded):
            decoded.append(0)
    return bytes(decoded)
