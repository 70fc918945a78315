# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simple decoder of the binary stream: struct, bytes, zlib, and COBS in pure Python.

`acts bench decode` compares `acts_core.wire.StreamDecoder` with it. It returns the same frames for any bytes, but
drops damaged packets without a reason.
"""

from __future__ import annotations

import struct
import zlib

import numpy as np

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.frames import SampleFrame, Scheme

_HEADER = struct.Struct("<BBHIQIIBBBBHH")
_SCHEMES = {int(scheme) for scheme in Scheme}


class NaiveDecoder:
    """Decodes frames from the board's bytes."""

    def __init__(self) -> None:
        self._buffer = b""

    def reset(self) -> None:
        """Reset for a stream that was opened: pending bytes are dropped."""
        self._buffer = b""

    def feed(self, data: bytes) -> list[SampleFrame]:
        """Decode the next bytes of the stream; return the frames that they complete, in order."""
        *packets, self._buffer = (self._buffer + data).split(b"\0")
        frames = []
        for packet in packets:
            frame = _parse(_unstuff(packet))
            if frame is not None:
                frames.append(frame)
        return frames


def _unstuff(packet: bytes) -> bytes:
    """Decode COBS; empty where the packet is damaged."""
    decoded = bytearray()
    position = 0
    while position < len(packet):
        code = packet[position]
        end = position + code
        if end > len(packet):
            return b""
        decoded += packet[position + 1 : end]
        position = end
        if code < 255 and position < len(packet):
            decoded.append(0)
    return bytes(decoded)


def _parse(packet: bytes) -> SampleFrame | None:
    """The frame in a packet; None where it is not a valid one."""
    if len(packet) < _HEADER.size + 4 or struct.unpack("<I", packet[-4:])[0] != zlib.crc32(packet[:-4]):
        return None
    kind, version, length, sequence, board_us, duration_us, overruns, scheme, rows, cols, flags, m, reserved = (
        _HEADER.unpack(packet[: _HEADER.size])
    )
    if (kind, version, length, flags, reserved) != (1, 1, len(packet), 0, 0) or scheme not in _SCHEMES:
        return None
    if not (0 < rows <= MAX_SIDE and 0 < cols <= MAX_SIDE) or len(packet) != _HEADER.size + 4 * m + 4:
        return None
    samples = struct.unpack(f"<{2 * m}H", packet[_HEADER.size : -4])
    indices, counts = samples[:m], samples[m:]
    if m and (max(indices) >= rows * cols or len(set(indices)) != m or max(counts) > COUNT_MAX):
        return None
    return SampleFrame(
        sequence,
        board_us,
        duration_us,
        Scheme(scheme),
        rows,
        cols,
        overruns,
        np.array(indices, dtype=np.uint16),
        np.array(counts, dtype=np.uint16),
    )
