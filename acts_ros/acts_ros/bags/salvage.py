# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Read an MCAP file that was cut off or damaged anywhere, up to the last record before that.

An MCAP file is a magic number and then records: one byte of kind, eight of length, the content. Readers look for a
footer at the end, which a killed recorder has not written; it is added in memory. Nothing on the disk is changed.

A file system that lost its power may keep the length of a file and lose what was in it. So records of the right length
are looked into as well.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from rosbags.rosbag2.errors import ReaderError

from acts_core.errors import RecordingError
from acts_ros.bags.storages import check_description, unpacked_chunk

MAGIC = b"\x89MCAP0\r\n"
_HEADER = struct.Struct("<BQ")
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _MESSAGE_INDEX, _DATA_END = 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x0F
# Times of the first and the last message, size when unpacked.
_CHUNK_HEAD = struct.Struct("<QQQ")
# Channel, number, time of recording and of publishing.
_MESSAGE_HEAD = struct.Struct("<HIQQ")
_INDEX_HEAD = struct.Struct("<HI")
# A footer without summary: readers then read all records.
_NO_SUMMARY = _HEADER.pack(_FOOTER, 20) + bytes(20) + MAGIC


def end_of_sound_records(stream: BinaryIO) -> tuple[int, str | None]:
    """Find where the records end that can be read.

    Parameters
    ----------
    stream : BinaryIO
        The file.

    Returns
    -------
    int
        Offset after the last complete record of the data section that is not damaged [bytes].
    str or None
        What is wrong with the next one; None where there is none, or where it is cut off.

    Raises
    ------
    RecordingError
        It is no MCAP file.
    """
    end, channels, before = len(MAGIC), set[int](), 0
    for kind, start, length in _whole_records(stream):
        try:
            if kind == _MESSAGE_INDEX:
                stream.seek(start)
                _check_index(stream.read(_INDEX_HEAD.size), length, before)
            elif kind == _CHUNK:
                stream.seek(start)
                _check_chunk(unpacked_chunk(stream.read(length)), channels)
            else:
                stream.seek(start)
                _check_record(kind, stream.read(_looked_into(kind, length)), length, channels)
        except (RecordingError, ReaderError) as damage:
            return end, str(damage)
        end, before = start + length, kind
    return end, None


def _check_chunk(content: bytes, channels: set[int]) -> None:
    """Refuse a chunk whose unpacked content is not complete records."""
    at = 0
    while at < len(content):
        if at + _HEADER.size > len(content):
            raise RecordingError("a chunk ends inside a record")
        kind, length = _HEADER.unpack_from(content, at)
        at += _HEADER.size
        if at + length > len(content):
            raise RecordingError("a chunk ends inside a record")
        _check_record(kind, content[at : at + _looked_into(kind, length)], length, channels)
        at += length


def _looked_into(kind: int, length: int) -> int:
    """How much of a record is looked into [bytes]: of messages, which are most of the file, the head."""
    return length if kind in (_SCHEMA, _CHANNEL) else min(length, _MESSAGE_HEAD.size)


def _check_record(kind: int, content: bytes, length: int, channels: set[int]) -> None:
    """Refuse a record that makes no sense; note the channels that are announced."""
    if not kind or kind == _CHUNK:
        raise RecordingError(f"a record is of the kind {kind} where none can be")
    if kind == _MESSAGE:
        if length < _MESSAGE_HEAD.size:
            raise RecordingError("a message is too short")
        channel, *_ = _MESSAGE_HEAD.unpack(content)
        if channel not in channels:
            raise RecordingError(f"a message is of the channel {channel}, which is not known")
    elif kind in (_SCHEMA, _CHANNEL):
        try:
            check_description(content, is_channel=kind == _CHANNEL)
        except Exception as error:  # rosbags raises errors of many types on damaged files
            raise RecordingError(f"a topic or its type is described wrongly ({error})") from error
        if kind == _CHANNEL:
            channels.add(int.from_bytes(content[:2], "little"))


def _check_index(head: bytes, length: int, before: int) -> None:
    """Refuse an index of messages that does not follow its chunk: the chunk is another record now."""
    if before not in (_CHUNK, _MESSAGE_INDEX) or len(head) < _INDEX_HEAD.size:
        raise RecordingError("an index of messages does not follow a chunk")
    _, size = _INDEX_HEAD.unpack(head)
    if _INDEX_HEAD.size + size != length:
        raise RecordingError("an index of messages has another length than it says")


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


class SoundRecords:
    """Opens an MCAP file up to the last complete record before any damage, with a footer after it.

    Parameters
    ----------
    path : Path
        The file.

    Attributes
    ----------
    damage : str or None
        For the user: where it is damaged, and how; None before it is opened, and where it is cut off at most.
    """

    def __init__(self, path: Path) -> None:
        self.damage: str | None = None
        self._path = path

    def __str__(self) -> str:
        return str(self._path)

    def open(self, _mode: str = "rb") -> io.BufferedReader:
        """Open it for reading."""
        stream = self._path.open("rb")
        try:
            end, damage = end_of_sound_records(stream)
        except RecordingError:
            stream.close()
            raise
        if damage is not None:
            self.damage = f"{self._path.name} from byte {end} on: {damage}"
        return io.BufferedReader(_Spliced(stream, end, _NO_SUMMARY))


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
