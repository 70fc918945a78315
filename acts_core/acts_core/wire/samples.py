# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The binary stream of the board: frames to bytes and back. `docs/wire_protocol.md` is its description.

Frames are one of the packets of `acts_core.wire.packets`; the others are in `acts_core.wire.commands` and
`acts_core.wire.board_messages`::

    frame = SampleFrame(...)
    decoder = StreamDecoder()
    decoder.feed(encode_frame(frame))  # [frame]
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import PacketError
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import REPEATING
from acts_core.wire.board_messages import BoardMessage, decode_message
from acts_core.wire.cobs import DELIMITER, encoded_size_max
from acts_core.wire.cobs_kernels import decode_into
from acts_core.wire.commands import UnknownReplyError
from acts_core.wire.delimited import DelimitedDecoder
from acts_core.wire.packets import CRC, VERSION, ChecksumError, PacketType, stuffed, version_mismatch
from acts_core.wire.sample_kernels import COUNT_RANGE, INDEX_RANGE, INDEX_REPEATED, first_fault

# type, version, length, sequence, board_us, duration_us, overruns, scheme, rows, cols, flags, m, reserved
_HEADER = struct.Struct("<BBHIQIIBBBBHH")
_U2 = np.dtype("<u2")
_SAMPLES = int(PacketType.SAMPLES)

PACKET_SIZE_MIN = _HEADER.size + CRC.size
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
    reason = sample_fault(indices, counts, frame.rows * frame.cols, may_repeat=frame.scheme in REPEATING)
    if reason:
        raise PacketError(reason)
    if not 0 <= frame.board_us < 1 << 64:
        raise PacketError(f"board_us = {frame.board_us}: the board's clock has 64 bits and starts at 0")
    packet = _HEADER.pack(
        PacketType.SAMPLES,
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
    return stuffed(packet + indices.astype(_U2).tobytes() + counts.astype(_U2).tobytes())


def sample_fault(indices: NDArray[np.integer], counts: NDArray[np.integer], size: int, *, may_repeat: bool) -> str:
    """What is wrong with the samples of a frame, in words; empty for nothing.

    The reference implementation of `first_fault`.

    Parameters
    ----------
    indices, counts : np.ndarray [shape=(m,), dtype=integer]
        The samples.
    size : int
        Number of taxels of the array.
    may_repeat : bool
        Whether an index may be there several times.
    """
    seen: set[int] = set()
    for position, (index, count) in enumerate(zip(indices.tolist(), counts.tolist(), strict=True)):
        fault = 0
        if not 0 <= index < size:
            fault = INDEX_RANGE
        elif index in seen and not may_repeat:
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

    Parameters
    ----------
    on_message : callable, optional
        Called within `feed` with everything else that the board says: `Reply`, `BoardImage` or `BoardObject`, in the
        order of the stream; and with an `UnknownReply`, which counts as malformed. It must not raise.

    Attributes
    ----------
    messages : int
        Valid packets that are not frames.
    """

    def __init__(self, on_message: Callable[[BoardMessage], None] | None = None) -> None:
        super().__init__(DELIMITER, encoded_size_max(PACKET_SIZE_MAX))
        self.messages = 0
        self._on_message = on_message
        self._seen = np.zeros(MAX_SIDE**2, dtype=np.uint32)
        self._mark = 0
        # Compiles, or loads from the cache, what the first frame would otherwise wait for.
        nothing = np.empty(0, dtype=np.uint8)
        decode_into(b"", nothing)
        first_fault(nothing.view(_U2), nothing.view(_U2), 1, self._seen, self._mark, False)

    def _too_long(self) -> str:
        return (
            f"no zero byte within {self._packet_size_max} bytes, the longest packet there is; a board that prints "
            "lines of text speaks another protocol (docs/own_array.md)"
        )

    def _decode(self, packet: bytes) -> SampleFrame | None:
        buffer = np.empty(len(packet), dtype=np.uint8)
        view = buffer.data
        size = decode_into(packet, buffer)
        if size < 0:
            raise PacketError("byte stuffing is broken")
        if size < PACKET_SIZE_MIN:
            self._take_message(view[:size])
            return None
        body_end = size - CRC.size
        kind, version, length, sequence, board_us, duration_us, overruns, scheme, rows, cols, flags, m, reserved = (
            _HEADER.unpack_from(view)
        )
        if kind != _SAMPLES:
            self._take_message(view[:size])
            return None
        if length != size:
            raise PacketError(f"packet of {size} bytes says it has {length}")
        if zlib.crc32(view[:body_end]) != CRC.unpack_from(view, body_end)[0]:
            raise ChecksumError(f"CRC-32 of a packet of {size} bytes does not match")
        if version != VERSION:
            raise version_mismatch(f"packet type {kind}, version {version}; this release reads version {VERSION}")
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
        fault, position = first_fault(indices, counts, rows * cols, self._seen, self._mark, scheme in REPEATING)
        if fault:
            raise PacketError(
                _FAULTS[fault].format(
                    index=indices[position], count=counts[position], position=position, size=rows * cols
                )
            )
        return SampleFrame(sequence, board_us, duration_us, _SCHEMES[scheme], rows, cols, overruns, indices, counts)

    def _take_message(self, packet: memoryview) -> None:
        try:
            message = decode_message(packet.tobytes())
        except UnknownReplyError as error:
            # Who has asked is to know which version it is that cannot be read.
            if self._on_message is not None:
                self._on_message(error.reply)
            raise
        self.messages += 1
        if self._on_message is not None:
            self._on_message(message)


def _check_size(rows: int, cols: int, m: int) -> None:
    if not (1 <= rows <= MAX_SIDE and 1 <= cols <= MAX_SIDE):
        raise PacketError(f"array of {rows} x {cols} taxels; 1 to {MAX_SIDE} each are allowed")
    if not 1 <= m <= rows * cols:
        raise PacketError(f"{m} samples of an array of {rows} x {cols}; 1 to {rows * cols} are allowed")
