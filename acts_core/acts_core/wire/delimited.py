# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames out of a stream of delimited packets: split, reject, count, resynchronise, in bounded memory."""

from __future__ import annotations

from abc import ABC, abstractmethod

from acts_core.errors import PacketError
from acts_core.frames import SampleFrame
from acts_core.wire.packets import ChecksumError


class DelimitedDecoder(ABC):
    """Common part of the decoders; a protocol derives from it and says what one packet means.

    Whatever comes in, decoding goes on after the next delimiter.

    Parameters
    ----------
    delimiter : bytes
        One byte that ends a packet and never occurs inside.
    packet_size_max : int
        Length in bytes of the longest valid packet without its delimiter. No more than this is ever kept.

    Attributes
    ----------
    frames : int
        Frames decoded.
    crc_errors : int
        Packets of the right length with a wrong checksum.
    malformed : int
        Packets rejected for any other reason.
    partial : int
        Packets dropped because the stream was opened in their middle (see `reset`). They are no error.
    bytes_discarded : int
        Bytes of all these rejected packets, delimiters not counted.
    last_error : str
        Why a packet was last rejected, for a person; empty as long as none was.
    """

    has_board_clock = True
    """Whether `SampleFrame.board_us` comes from a clock of the board, so that it can be mapped to the host's."""

    has_checksum = True
    """Whether a packet without its first bytes is recognised by its content; otherwise the first packet is dropped."""

    def __init__(self, delimiter: bytes, packet_size_max: int) -> None:
        self._delimiter = delimiter
        self._packet_size_max = packet_size_max
        self._pending = bytearray()
        self._skipping = False
        self._may_be_cut = False
        self.frames = 0
        self.crc_errors = 0
        self.malformed = 0
        self.partial = 0
        self.bytes_discarded = 0
        self.last_error = ""

    @abstractmethod
    def _decode(self, packet: bytes) -> SampleFrame | None:
        """Decode one packet, given without its delimiter, or raise `PacketError`; None where it is no frame."""

    def reset(self) -> None:
        """Reset for a stream that was (re)opened: pending bytes are dropped, and the first packet may be incomplete.

        Such a cut packet is counted as `partial`. The counters keep their values.
        """
        self.bytes_discarded += len(self._pending)
        self._pending.clear()
        self._skipping = False
        self._may_be_cut = True

    def feed(self, data: bytes) -> list[SampleFrame]:
        """Decode the next bytes of the stream, split anywhere; return the frames that they complete, in order.

        Never raises for what the bytes hold: packets that are not valid are counted and dropped. A bytearray or another
        buffer of bytes will do.
        """
        # Of a bytearray, as `readinto` fills it, the parts would be such, too, and kernels compiled anew for them.
        parts = (data if type(data) is bytes else bytes(memoryview(data))).split(self._delimiter)
        tail = parts.pop()
        frames: list[SampleFrame] = []
        for part in parts:
            if self._pending:
                part = bytes(self._pending) + part
                self._pending.clear()
            frame = self._finish(part)
            if frame is not None:
                frames.append(frame)
        if tail:
            self._keep(tail)
        return frames

    def _finish(self, packet: bytes) -> SampleFrame | None:
        """Handle one whole packet."""
        may_be_cut, self._may_be_cut = self._may_be_cut, False
        if self._skipping:
            # The rest of an endless packet, which was counted when it grew too long.
            self._skipping = False
            self.bytes_discarded += len(packet)
            return None
        if not packet:
            return None
        if may_be_cut and not self.has_checksum:
            self.partial += 1
            self.bytes_discarded += len(packet)
            return None
        try:
            if len(packet) > self._packet_size_max:
                raise PacketError(self._too_long())
            frame = self._decode(packet)
        except PacketError as error:
            self.bytes_discarded += len(packet)
            if may_be_cut:
                self.partial += 1
                return None
            self.last_error = str(error)
            if isinstance(error, ChecksumError):
                self.crc_errors += 1
            else:
                self.malformed += 1
            return None
        if frame is not None:
            self.frames += 1
        return frame

    def _keep(self, tail: bytes) -> None:
        if self._skipping:
            self.bytes_discarded += len(tail)
            return
        self._pending += tail
        if len(self._pending) > self._packet_size_max:
            self.malformed += 1
            self.last_error = self._too_long()
            self.bytes_discarded += len(self._pending)
            self._pending.clear()
            self._skipping = True

    def _too_long(self) -> str:
        """Why a packet is refused that has no end; for a protocol to say in its own words."""
        return f"no delimiter within {self._packet_size_max} bytes, the longest packet there is"
