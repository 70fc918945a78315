# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The text stream of the published raster sketch: every taxel of one scan in a line.

A line holds rows*cols counts, row-major in image coordinates, each followed by a comma, then the duration of the scan
in microseconds and CRLF. There is no checksum, no sequence number and no clock: a byte that is altered into another
digit cannot be told, and frames are dated by their arrival.
"""

from __future__ import annotations

import numpy as np

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.errors import PacketError
from acts_core.frames import SampleFrame, Scheme
from acts_core.wire.delimited import DelimitedDecoder
from acts_core.words import counted

_NUMBER_CHARACTERS = b"0123456789,"
_DURATION_DIGITS = 10
_COUNT_DIGITS = 4
_DURATION_MAX_US = 0xFFFFFFFF
_SHOWN_BYTES = 40


class RasterDecoder(DelimitedDecoder):
    """Frames out of the lines of the published raster sketch; counters as in `DelimitedDecoder`.

    The first line after construction or `reset` is dropped and counted as `partial`: were it cut within a number,
    nothing would tell. Empty lines are passed over. Every other line, also a refused one, takes a sequence number, so
    that a refused line shows as a gap. `board_us` is the sum of the scan times, which leaves out the time the board
    spends printing: it is no clock (`has_board_clock` is False).

    Parameters
    ----------
    rows, cols : int
        Size of the array; the lines do not tell it.
    """

    has_board_clock = False
    has_checksum = False

    def __init__(self, rows: int = 32, cols: int = 32) -> None:
        size = ArrayGeometry(rows, cols).size
        super().__init__(b"\n", size * (_COUNT_DIGITS + 1) + _DURATION_DIGITS + 1)
        self._rows = rows
        self._cols = cols
        self._size = size
        self._indices = np.arange(size, dtype=np.uint16)
        self._board_us = 0
        self._may_be_cut = True

    def _decode(self, packet: bytes) -> SampleFrame | None:
        line = packet.removesuffix(b"\r")
        if not line:
            return None  # an empty line, as one that ends in \n alone
        strange = line.translate(None, _NUMBER_CHARACTERS)
        if strange:
            place = line.index(strange[:1])
            raise PacketError(
                f"line with something else than numbers and commas, {_shown(strange[:1])} as character {place + 1}: "
                f"{_shown(line, place)}"
            )
        words = line.split(b",")
        if not words[-1] and len(words) > 1:
            raise PacketError(
                f"line of {counted(len(words) - 1, 'number')} that ends with a comma; after the "
                f"{counted(self._size, 'count')} of an array of {self._rows} x {self._cols} and the comma after each "
                "there is the duration, without one"
            )
        if len(words) != self._size + 1:
            raise PacketError(
                f"line of {counted(len(words), 'number')}; an array of {self._rows} x {self._cols} has "
                f"{counted(self._size, 'count')} and a duration"
            )
        if b"" in words:
            raise PacketError(f"line with an empty value, number {words.index(b'') + 1} of {len(words)}")
        longest = max(words, key=len)
        if len(longest) > _DURATION_DIGITS:
            # Also: int() refuses thousands of digits with an error of its own.
            raise PacketError(f"number {_shown(longest)} of {len(longest)} digits")
        *counts, duration_us = map(int, words)
        if max(counts) > COUNT_MAX:
            raise PacketError(f"count {max(counts)} of taxel {counts.index(max(counts))} is above {COUNT_MAX}")
        if duration_us > _DURATION_MAX_US:
            raise PacketError(f"scan of {duration_us} us")
        self._board_us += duration_us
        return SampleFrame(
            sequence=(self.frames + self.malformed) & 0xFFFFFFFF,
            board_us=self._board_us,
            duration_us=duration_us,
            scheme=Scheme.RASTER,
            rows=self._rows,
            cols=self._cols,
            overruns=0,
            indices=self._indices,
            counts=np.array(counts, dtype=np.uint16),
        )

    def _too_long(self) -> str:
        return (
            f"line longer than {self._packet_size_max} bytes, the most that an array of {self._rows} x {self._cols} "
            "takes; is that its size, and does each frame end with \\n?"
        )


def _shown(line: bytes, place: int = 0) -> str:
    """A piece of a line around a place in it, for a person."""
    begin = max(0, min(place - _SHOWN_BYTES // 2, len(line) - _SHOWN_BYTES))
    end = begin + _SHOWN_BYTES
    return ("..." if begin else "") + repr(line[begin:end])[1:] + ("..." if len(line) > end else "")
