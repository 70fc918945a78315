# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading bags, also those whose recorder was killed and those that are damaged."""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from rosbags.interfaces import Connection, ConnectionExtRosbag2, Qos

from acts_core.errors import RecordingError
from acts_core.files import TEXT_BYTES_MAX, is_there, require_regular
from acts_core.words import counted
from acts_ros.bags.message_types import Definitions, message_class
from acts_ros.bags.salvage import largest_chunk
from acts_ros.bags.storages import BagReader
from acts_ros.bags.unfinished import SUFFIXES, UnfinishedBag, storage_files
from acts_ros.bags.unpacking import CHUNK_BYTES_MAX, unpack, unpacked_bytes

# How a message begins that zstd or lz4 has compressed; a serialised one begins with 0.
_PACKED = (b"\x28\xb5\x2f\xfd", b"\x04\x22\x4d\x18")
_NEEDED = "give the folder that `acts record` or `ros2 bag record` made, or its .mcap or .db3 file"

# A second's work, with small messages several.
_SILENT_BYTES_MAX = 100_000_000
_told: set[Path] = set()


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
    _reader: BagReader | UnfinishedBag
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

    def message_class(self, topic: str) -> type:
        """The installed class of a topic's messages.

        Raises
        ------
        RecordingError
            It is not installed, or its definition differs from the recorded one, or the topic has several types.
        """
        # As where two bags were merged; the messages do not tell which of them they are of.
        kinds = {connection.msgtype for connection in self.connections if connection.topic == topic}
        if len(kinds) > 1:
            raise RecordingError(f"it was recorded with several types: {', '.join(sorted(kinds))}")
        found = message_class(*kinds)
        self.check_definition(topic)
        return found

    def recorded_qos(self, topic: str) -> list[Qos]:
        """Quality of service that the publishers of a topic offered."""
        return [
            profile
            for connection in self.connections
            if connection.topic == topic
            for profile in cast(ConnectionExtRosbag2, connection.ext).offered_qos_profiles
        ]

    def message_count(self, topic: str) -> int:
        """Number of messages of a topic."""
        return sum(connection.msgcount for connection in self.connections if connection.topic == topic)

    def span_ns(self, topics: Sequence[str]) -> tuple[int, int]:
        """Earliest and latest stamp [ns]: of the bag where its metadata say it and make sense, else of these topics.

        Raises
        ------
        RecordingError
            The bag is damaged.
        """
        # Of rosbags, the end is a nanosecond after the latest message.
        if isinstance(self._reader, BagReader) and self._reader.start_time < self._reader.end_time:
            return self._reader.start_time, self._reader.end_time - 1
        begin_ns = end_ns = None
        for _, stamp_ns, _ in self.messages(topics):
            begin_ns = stamp_ns if begin_ns is None else min(begin_ns, stamp_ns)
            end_ns = stamp_ns if end_ns is None else max(end_ns, stamp_ns)
        return begin_ns or 0, end_ns or 0

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
        are_packed = isinstance(self._reader, BagReader) and self._reader.packs_messages
        try:
            for connection, stamp_ns, data in self._reader.messages(wanted, start=from_ns):
                message = unpack(data, "zstd") if are_packed else bytes(data)
                if message[:4] in _PACKED:
                    raise RecordingError(
                        f"messages of {connection.topic} are compressed one by one, and nothing here says how; "
                        "`ros2 bag reindex` restores a lost metadata.yaml, `ros2 bag convert` unpacks them"
                    )
                yield connection.topic, stamp_ns, message
                count += 1
        except RecordingError as error:
            raise RecordingError(f"the bag '{self._path}', after {counted(count, 'message')}: {error}") from error
        except Exception as error:  # rosbags raises errors of many types on damaged bags
            raise RecordingError(
                f"the bag '{self._path}' is damaged after {counted(count, 'message')}: {error}"
            ) from error
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
    try:
        _check_files(path)
        reader, note = _open_reader(path)
    except OSError as error:  # as of a disk that was taken out, or a folder that may not be listed
        raise RecordingError(f"the bag '{path}' cannot be read: {error.strerror or error}") from error
    try:
        yield Bag(list(reader.connections), note, reader, path)
    finally:
        reader.close()


def _check_files(path: Path) -> None:
    """Refuse files that are not regular or too large, and what unpacks to more than is allowed."""
    for file in path.iterdir() if path.is_dir() else [path]:
        # What else lies in the folder is not read, such as the link to nowhere by which an editor locks a file.
        if (file.is_dir() or not file.exists()) and file.suffix not in SUFFIXES:
            continue
        size = require_regular(file, error=RecordingError)
        if file.name == "metadata.yaml" and size > TEXT_BYTES_MAX:
            raise RecordingError(f"{file}: {size / 1e6:.1f} MB; allowed are {TEXT_BYTES_MAX / 1e6:.1f} MB")
        # A recorder that was killed may have begun a further file.
        if file.suffix == ".mcap" and (size or not path.is_dir()):
            _check_chunks(file)
    _check_space(path)


def _check_chunks(file: Path) -> None:
    """Refuse chunks that unpack to more than `CHUNK_BYTES_MAX`."""
    try:
        with file.open("rb") as stream:
            largest = largest_chunk(stream)
    except OSError as error:
        raise RecordingError(f"{file}: {error}") from error
    except RecordingError as error:
        raise RecordingError(f"{file}: {error}; {_NEEDED}") from error
    if largest > CHUNK_BYTES_MAX:
        raise RecordingError(
            f"{file}: a chunk of {largest / 1e6:.0f} MB unpacked; allowed are {CHUNK_BYTES_MAX / 1e6:.0f} MB"
        )


def _check_space(path: Path) -> None:
    """Refuse files that are compressed as a whole, and do not fit unpacked where temporary files are."""
    packed = [file for file in path.iterdir() if file.suffix == ".zstd" and file.is_file()] if path.is_dir() else []
    if not packed or not (path / "metadata.yaml").exists():
        return
    folder = tempfile.gettempdir()
    left = shutil.disk_usage(folder).free
    for file in packed:
        left -= unpacked_bytes(file, left)
        if left < 0:
            raise RecordingError(
                f"{file}: unpacked it is larger than the space in {folder}; unpack the bag where there is more, by "
                "`ros2 bag convert`, or set TMPDIR"
            )


def _open_reader(path: Path) -> tuple[BagReader | UnfinishedBag, str | None]:
    if path.is_dir() and not (path / "metadata.yaml").exists():
        return _open_unfinished(
            path, "it has no metadata.yaml", f"the bag '{path}' was never closed (recorder killed, or disk full)"
        )
    try:
        return _open_complete(path), None
    except RecordingError as error:
        return _open_unfinished(path, str(error), f"the bag '{path}' is damaged or of another version ({error})")


def _open_complete(path: Path) -> BagReader:
    try:
        reader = BagReader(path)
        reader.open()
    except Exception as error:  # rosbags raises errors of many types on damaged bags
        raise RecordingError(str(error) or type(error).__name__) from error
    return reader


def _open_unfinished(path: Path, reason: str, note: str) -> tuple[UnfinishedBag, str]:
    """Read the complete records of files without an index, and say so."""
    files = storage_files(path)
    if not files:
        raise RecordingError(
            f"'{path}' holds no bag that can be read: {reason}, and no file {' or '.join(SUFFIXES)}; {_NEEDED}"
        )
    _tell_if_large(path, files)
    try:
        bag = UnfinishedBag(files)
    except RecordingError as damage:
        raise RecordingError(f"nothing in the bag '{path}' can be read: {damage}; {_NEEDED}") from damage
    unread = f"; not read: {'; '.join(bag.unread)}" if bag.unread else ""
    return bag, f"{note}; its complete records are read{unread}"


def _tell_if_large(path: Path, files: Sequence[Path]) -> None:
    """Print a line before a long silence, in which the files are read from end to end; once for each bag."""
    size = sum(file.stat().st_size for file in files)
    if size > _SILENT_BYTES_MAX and path not in _told:
        _told.add(path)
        print(f"reading all {size / 1e6:.0f} MB of '{path}', which has no index", file=sys.stderr, flush=True)
