# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading bags, also those whose recorder was killed and those that are damaged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from rosbags.interfaces import Connection, ConnectionExtRosbag2, Qos
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.storage_mcap import McapReader

from acts_core.errors import RecordingError
from acts_core.files import TEXT_BYTES_MAX, is_there, require_regular
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.salvage import WholeRecords, largest_chunk

# Recorders close a chunk after some megabytes. It is unpacked as a whole, so a larger one could fill the memory.
_CHUNK_BYTES_MAX = 1 << 28
_NEEDED = "give the folder that `acts record` or `ros2 bag record` made, or its .mcap file"


@dataclass
class Bag:
    """An open bag.

    Attributes
    ----------
    connections : list of Connection
        Its topics.
    note : str or None
        For the user: what is wrong with the bag; None where it is whole.
    """

    connections: list[Connection]
    note: str | None
    _reader: Reader | McapReader
    _path: Path
    _definitions: Definitions = field(default_factory=Definitions)

    def topics(self) -> dict[str, str]:
        """Message type by topic."""
        return {connection.topic: connection.msgtype for connection in self.connections}

    def check_definition(self, topic: str) -> None:
        """Refuse a topic whose recorded definition differs from the installed one; see `Definitions.check`.

        Raises
        ------
        RecordingError
            The definitions differ, or the recorded one cannot be read.
        """
        for connection in self.connections:
            if connection.topic == topic:
                self._definitions.check(connection)

    def recorded_qos(self, topic: str) -> list[Qos]:
        """Quality of service that the publishers of a topic offered."""
        return [
            profile
            for connection in self.connections
            if connection.topic == topic
            for profile in cast(ConnectionExtRosbag2, connection.ext).offered_qos_profiles
        ]

    def span_ns(self, topic: str) -> tuple[int, int]:
        """Stamps of the first and the last message [ns]: of the bag where its metadata say it, else of the topic.

        Raises
        ------
        RecordingError
            The bag is damaged.
        """
        if isinstance(self._reader, Reader):
            return self._reader.start_time, self._reader.end_time
        begin_ns = end_ns = 0
        for _, stamp_ns, _ in self.messages([topic]):
            begin_ns, end_ns = begin_ns or stamp_ns, stamp_ns
        return begin_ns, end_ns

    def messages(self, topics: Sequence[str], from_ns: int | None = None) -> Iterator[tuple[str, int, bytes]]:
        """Topic, stamp [ns] and serialised message, in the order of their stamps.

        Parameters
        ----------
        topics : sequence of str
        from_ns : int, optional
            Leave out what is earlier [ns].

        Raises
        ------
        RecordingError
            The bag is damaged; everything before the damage has been yielded.
        """
        wanted = [connection for connection in self.connections if connection.topic in topics]
        if not wanted:
            return
        count = 0
        reader = self._reader
        try:
            read = reader.messages_scan if isinstance(reader, McapReader) else reader.messages
            messages = read(wanted, start=from_ns)
            for connection, stamp_ns, data in messages:
                yield connection.topic, stamp_ns, bytes(data)
                count += 1
        except Exception as error:  # rosbags raises errors of many types on damaged bags
            raise RecordingError(f"the bag '{self._path}' is damaged after {count} messages: {error}") from error
        expected = sum(connection.msgcount for connection in wanted)
        if count < expected and from_ns is None:
            raise RecordingError(
                f"the bag '{self._path}' is damaged: {expected - count} of {expected} messages are lost"
            )


@contextmanager
def open_bag(path: Path) -> Iterator[Bag]:
    """Open a bag.

    Parameters
    ----------
    path : Path
        Folder in rosbag2's layout (MCAP or SQLite), or an MCAP file.

    Raises
    ------
    RecordingError
        There is no bag, nothing in it can be read, or it holds more than is allowed.
    """
    if not is_there(path, error=RecordingError):
        raise RecordingError(f"there is no bag '{path}'; {_NEEDED}")
    _check_files(path)
    reader, note = _open_reader(path)
    try:
        yield Bag(list(reader.connections), note, reader, path)
    finally:
        reader.close()


def _check_files(path: Path) -> None:
    """Refuse files that are not regular or too large, and chunks that unpack to more than `_CHUNK_BYTES_MAX`."""
    for file in path.iterdir() if path.is_dir() else [path]:
        size = require_regular(file, error=RecordingError)
        if file.name == "metadata.yaml" and size > TEXT_BYTES_MAX:
            raise RecordingError(f"{file}: {size / 1e6:.1f} MB; allowed are {TEXT_BYTES_MAX / 1e6:.1f} MB")
        if file.suffix == ".mcap":
            try:
                with file.open("rb") as stream:
                    largest = largest_chunk(stream)
            except (OSError, RecordingError) as error:
                raise RecordingError(f"{file}: {error}") from error
            if largest > _CHUNK_BYTES_MAX:
                raise RecordingError(
                    f"{file}: a chunk of {largest / 1e6:.0f} MB unpacked; allowed are {_CHUNK_BYTES_MAX / 1e6:.0f} MB"
                )


def _open_reader(path: Path) -> tuple[Reader | McapReader, str | None]:
    if path.is_dir() and not (path / "metadata.yaml").exists():
        return _salvage(path, "no metadata.yaml"), (
            f"the bag '{path}' was never closed (recorder killed, or disk full); its complete records are read"
        )
    try:
        return _open_complete(path), None
    except RecordingError as error:
        return _salvage(path, str(error)), f"the bag '{path}' is damaged ({error}); its complete records are read"


def _open_complete(path: Path) -> Reader:
    try:
        reader = Reader(path)
        reader.open()
    except Exception as error:
        raise RecordingError(str(error) or type(error).__name__) from error
    return reader


def _salvage(path: Path, reason: str) -> McapReader:
    """Read the complete records of an MCAP file that has no index."""
    files = sorted(path.glob("*.mcap")) if path.is_dir() else [path]
    if not files:
        raise RecordingError(f"'{path}' holds no bag that can be read: {reason}, no MCAP file; {_NEEDED}")
    try:
        # Of a path, rosbags uses only `open`.
        reader = McapReader(cast(Any, WholeRecords(files[0])))
        reader.open()
    except Exception as damage:
        raise RecordingError(f"nothing in the bag '{path}' can be read: {damage}; {_NEEDED}") from damage
    return reader
