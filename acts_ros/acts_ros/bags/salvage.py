# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Read an MCAP file that was cut off anywhere, up to its last complete record.

An MCAP file is a magic number and then records: one byte of kind, eight of length, the content. Readers look for a
footer at the end, which a killed recorder has not written; it is added in memory. Nothing on the disk is changed.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from acts_core.errors import RecordingError

MAGIC = b"\x89MCAP0\r\n"
_HEADER = struct.Struct("<BQ")
_FOOTER, _CHUNK, _DATA_END = 0x02, 0x06, 0x0F
# Times of the first and the last message, size when unpacked.
_CHUNK_HEAD = struct.Struct("<QQQ")
# A footer without summary: readers then read all records.
_NO_SUMMARY = _HEADER.pack(_FOOTER, 20) + bytes(20) + MAGIC


def end_of_whole_records(stream: BinaryIO) -> int:
    """Offset after the last complete record of the data section [bytes].

    Raises
    ------
    RecordingError
        It is no MCAP file.
    """
    end = len(MAGIC)
    for _, start, length in _whole_records(stream):
        end = start + length
    return end


def largest_chunk(stream: BinaryIO) -> int:
    """Size of the largest chunk of the data section when unpacked, as its head says [bytes].

    Raises
    ------
    RecordingError
        It is no MCAP file.
    """
    largest = 0
    for kind, start, length in _whole_records(stream):
        if kind == _CHUNK and length >= _CHUNK_HEAD.size:
            stream.seek(start)
            _, _, unpacked = _CHUNK_HEAD.unpack(stream.read(_CHUNK_HEAD.size))
            largest = max(largest, unpacked)
    return largest


def _whole_records(stream: BinaryIO) -> Iterator[tuple[int, int, int]]:
    """Kind, offset of the content and its length [bytes], of each complete record of the data section."""
    size = stream.seek(0, io.SEEK_END)
    stream.seek(0)
    if stream.read(len(MAGIC)) != MAGIC:
        raise RecordingError("not an MCAP file")
    at = len(MAGIC)
    while True:
        stream.seek(at)
        header = stream.read(_HEADER.size)
        if len(header) < _HEADER.size:
            return
        kind, length = _HEADER.unpack(header)
        at += _HEADER.size
        if kind in (_FOOTER, _DATA_END) or at + length > size:
            return
        yield kind, at, length
        at += length


class WholeRecords:
    """Opens an MCAP file up to its last complete record, with a footer after it.

    Parameters
    ----------
    path : Path
        The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path

    def __str__(self) -> str:
        return str(self._path)

    def open(self, _mode: str = "rb") -> io.BufferedReader:
        """Open it for reading."""
        stream = self._path.open("rb")
        try:
            return io.BufferedReader(_Spliced(stream, end_of_whole_records(stream), _NO_SUMMARY))
        except RecordingError:
            stream.close()
            raise


class _Spliced(io.RawIOBase):
    """The first `end` bytes of a stream, then `tail`."""

    def __init__(self, stream: BinaryIO, end: int, tail: bytes) -> None:
        super().__init__()
        self._stream = stream
        self._end = end
        self._tail = tail
        self._at = 0

    def close(self) -> None:
        self._stream.close()
        super().close()

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def tell(self) -> int:
        return self._at

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        base = {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: self._end + len(self._tail)}[whence]
        if base + offset < 0:
            raise ValueError(f"cannot seek to {base + offset}")
        self._at = base + offset
        return self._at

    def readinto(self, buffer: bytearray | memoryview) -> int:  # type: ignore[override]
        if self._at < self._end:
            self._stream.seek(self._at)
            data = self._stream.read(min(len(buffer), self._end - self._at))
        else:
            start = self._at - self._end
            data = self._tail[start : start + len(buffer)]
        buffer[: len(data)] = data
        self._at += len(data)
        return len(data)
