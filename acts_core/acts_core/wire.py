"""The binary stream of the board: frames to bytes and back. `docs/wire_protocol.md` is its description.

A packet is little-endian, ends with a CRC-32, is stuffed (see `acts_core.cobs`) and followed by one zero byte::

    frame = SampleFrame(...)
    decoder = StreamDecoder()
    decoder.feed(encode_frame(frame))  # [frame]
"""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from acts_core import cobs
from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.cobs_kernels import decode_into, encode_into
from acts_core.delimited import ChecksumError, DelimitedDecoder
from acts_core.errors import PacketError
from acts_core.frames import SampleFrame, Scheme
from acts_core.wire_kernels import COUNT_RANGE, INDEX_RANGE, INDEX_REPEATED, first_fault

PACKET_TYPE_SAMPLES = 1
VERSION = 1

# type, version, length, sequence, board_us, duration_us, overruns, scheme, rows, cols, flags, m, reserved
_HEADER = struct.Struct("<BBHIQIIBBBBHH")
_CRC = struct.Struct("<I")
_U2 = np.dtype("<u2")

PACKET_SIZE_MIN = _HEADER.size + _CRC.size
PACKET_SIZE_MAX = PACKET_SIZE_MIN + 2 * 2 * MAX_SIDE**2
"""Bytes of the largest packet before stuffing: every taxel of a 64 x 64 array."""

_SCHEMES = {int(scheme): scheme for scheme in Scheme}
_FAULTS = {
    INDEX_RANGE: "index {index} of sample {position} is outside of the array of {size} taxels",
    INDEX_REPEATED: "index {index} of sample {position} occurred before in this frame",
    COUNT_RANGE: f"count {{count}} of sample {{position}} is above {COUNT_MAX}",
}


def encode_frame(frame: SampleFrame) -> bytes:
    """Encode one frame as the board does, delimiter included.

    Parameters
    ----------
    frame : SampleFrame
        Counters are taken modulo their width.

    Raises
    ------
    PacketError
        When the frame is not one a decoder would accept.
    """
    indices, counts = (np.asarray(values) for values in (frame.indices, frame.counts))
    if indices.ndim != 1 or indices.shape != counts.shape:
        raise PacketError(f"indices {indices.shape} and counts {counts.shape}: both are (m,)")
    _check_size(frame.rows, frame.cols, len(indices))
    reason = sample_fault(indices, counts, frame.rows * frame.cols)
    if reason:
        raise PacketError(reason)
    if not 0 <= frame.board_us < 1 << 64:
        raise PacketError(f"board_us = {frame.board_us}: the board's clock has 64 bits and starts at 0")
    packet = _HEADER.pack(
        PACKET_TYPE_SAMPLES,
        VERSION,
        PACKET_SIZE_MIN + 4 * len(indices),
        frame.sequence & 0xFFFFFFFF,
        frame.board_us,
        frame.duration_us & 0xFFFFFFFF,
        frame.overruns & 0xFFFFFFFF,
        int(frame.scheme),
        frame.rows,
        frame.cols,
        0,
        len(indices),
        0,
    )
    packet += indices.astype(_U2).tobytes() + counts.astype(_U2).tobytes()
    packet += _CRC.pack(zlib.crc32(packet))
    encoded = np.empty(cobs.encoded_size_max(len(packet)), dtype=np.uint8)
    return encoded[: encode_into(packet, encoded)].tobytes() + cobs.DELIMITER


def sample_fault(indices: NDArray[np.integer], counts: NDArray[np.integer], size: int) -> str:
    """What is wrong with the samples of a frame, in words; empty for nothing. The plain twin of `first_fault`.

    Parameters
    ----------
    indices, counts : np.ndarray [shape=(m,), dtype=integer]
        The samples.
    size : int
        Number of taxels of the array.
    """
    seen: set[int] = set()
    for position, (index, count) in enumerate(zip(indices.tolist(), counts.tolist(), strict=True)):
        fault = 0
        if not 0 <= index < size:
            fault = INDEX_RANGE
        elif index in seen:
            fault = INDEX_REPEATED
        elif not 0 <= count <= COUNT_MAX:
            fault = COUNT_RANGE
        if fault:
            return _FAULTS[fault].format(index=index, count=count, position=position, size=size)
        seen.add(index)
    return ""


class StreamDecoder(DelimitedDecoder):
    """Frames out of the board's bytes; counters and resynchronisation as in `DelimitedDecoder`.

    A frame is yielded only when its length, CRC-32, version and every field and sample are valid.
    """

    def __init__(self) -> None:
        super().__init__(cobs.DELIMITER, cobs.encoded_size_max(PACKET_SIZE_MAX))
        self._seen = np.zeros(MAX_SIDE**2, dtype=np.uint32)
        self._mark = 0

    def _decode(self, packet: bytes) -> SampleFrame:
        buffer = np.empty(len(packet), dtype=np.uint8)
        view = buffer.data
        size = decode_into(packet, buffer)
        if size < 0:
            raise PacketError("byte stuffing is broken")
        if size < PACKET_SIZE_MIN:
            raise PacketError(f"packet of {size} bytes; the shortest has {PACKET_SIZE_MIN}")
        body_end = size - _CRC.size
        kind, version, length, sequence, board_us, duration_us, overruns, scheme, rows, cols, flags, m, reserved = (
            _HEADER.unpack_from(view)
        )
        if length != size:
            raise PacketError(f"packet of {size} bytes says it has {length}")
        if zlib.crc32(view[:body_end]) != _CRC.unpack_from(view, body_end)[0]:
            raise ChecksumError(f"CRC-32 of a packet of {size} bytes does not match")
        if kind != PACKET_TYPE_SAMPLES or version != VERSION:
            raise PacketError(
                f"packet type {kind}, version {version}; this decoder reads type {PACKET_TYPE_SAMPLES}, "
                f"version {VERSION}: install firmware and driver of the same release"
            )
        if scheme not in _SCHEMES or flags != 0 or reserved != 0:
            raise PacketError(
                f"scheme {scheme}, flags {flags}, reserved {reserved}; version {VERSION} has schemes 0 to "
                f"{max(_SCHEMES)}, the others are 0"
            )
        _check_size(rows, cols, m)
        if size != PACKET_SIZE_MIN + 4 * m:
            raise PacketError(f"packet of {size} bytes with {m} samples; it must have {PACKET_SIZE_MIN + 4 * m}")
        samples = buffer[_HEADER.size : body_end].view(_U2)
        indices, counts = samples[:m], samples[m:]
        self._mark = self._mark % 0xFFFFFFFF + 1
        fault, position = first_fault(indices, counts, rows * cols, self._seen, self._mark)
        if fault:
            raise PacketError(
                _FAULTS[fault].format(
                    index=indices[position], count=counts[position], position=position, size=rows * cols
                )
            )
        return SampleFrame(sequence, board_us, duration_us, _SCHEMES[scheme], rows, cols, overruns, indices, counts)


def _check_size(rows: int, cols: int, m: int) -> None:
    if not (1 <= rows <= MAX_SIDE and 1 <= cols <= MAX_SIDE):
        raise PacketError(f"array of {rows} x {cols} taxels; 1 to {MAX_SIDE} each are allowed")
    if m > rows * cols:
        raise PacketError(f"{m} samples of an array of {rows} x {cols} = {rows * cols} taxels")
