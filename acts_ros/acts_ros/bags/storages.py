# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Readers of a bag's files that take what rosbag2 writes and the library rosbags refuses, and unpack within limits."""

from __future__ import annotations

import heapq
import tempfile
from collections.abc import Collection, Generator, Iterable
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader, storage_mcap
from rosbags.rosbag2.errors import ReaderError
from rosbags.rosbag2.reader import DirectoryReader
from rosbags.rosbag2.storage_mcap import McapReader, Schema
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

from acts_ros.bags.sqlite_log import has_log, merged_copy
from acts_ros.bags.unpacking import CHUNK_BYTES_MAX, unpack


def _unpack_chunk(kind: str, data: bytes, size: int) -> bytes:
    """Unpack no more of a chunk than it is said to hold, where rosbags would unpack all there is."""
    return unpack(data, kind, min(size, CHUNK_BYTES_MAX))


storage_mcap.DECOMPRESSORS.update({kind: partial(_unpack_chunk, kind) for kind in ("lz4", "zstd")})


def unpacked_chunk(content: bytes) -> bytes:
    """Unpack the content of a chunk's record and check its sum, if it has one.

    Raises
    ------
    RecordingError, ReaderError
        It is damaged.
    """
    record = BytesIO(content)
    _, _, size, checksum = storage_mcap.deserialize_qqqi(storage_mcap.read_exact(record, 28))
    kind = storage_mcap.read_bytes(record).decode(errors="replace")
    (packed_size,) = storage_mcap.deserialize_uint64(storage_mcap.read_exact(record, 8))
    if record.tell() + packed_size != len(content):
        raise ReaderError("a chunk has another length than it says")
    return storage_mcap.decompress(record.read(), kind, size, checksum)


def check_description(content: bytes, *, is_channel: bool) -> None:
    """Refuse the record of a channel or of a schema that cannot be read.

    Raises
    ------
    Exception
        Of many types, as rosbags raises them.
    """
    record = BytesIO(content)
    storage_mcap.read_exact(record, 4 if is_channel else 2)
    storage_mcap.read_string(record)
    storage_mcap.read_string(record)
    if is_channel:
        storage_mcap.get_qos(storage_mcap.read_bytes(record))
    else:
        storage_mcap.read_string(record)


Message = tuple[Connection, int, bytes]
"""Topic, stamp [ns] and serialised message."""

# Far longer than a recorder's queues, and not too much to be kept in memory.
_DISORDER_NS = 2_000_000_000

SET_BACK_NS = 1_000_000_000
"""A clock by which a topic goes back farther was set back; messages of one topic are recorded in their order."""

# Some stamps tell whether it may have been, without reading all of a large file at each opening: they are no farther
# apart, and each lies less than this behind those before it, as those of several topics do.
_APART_NS = SET_BACK_NS // 2
_BEHIND_NS = SET_BACK_NS // 10

_ENCODINGS = ("ros2msg", "ros2idl", "omgidl", "")


def in_order(messages: Iterable[Message]) -> Generator[Message, None, None]:
    """Messages by their stamps, as far as they are at most `_DISORDER_NS` behind later ones.

    One that is farther behind was recorded after the clock was set back: it comes after all before it.
    """
    waiting: list[tuple[int, int, Connection, bytes]] = []
    newest_ns = 0
    for number, (connection, stamp_ns, data) in enumerate(messages):
        if stamp_ns < newest_ns - _DISORDER_NS:
            while waiting:
                due_ns, _, due, due_data = heapq.heappop(waiting)
                yield due, due_ns, due_data
            newest_ns = stamp_ns
        heapq.heappush(waiting, (stamp_ns, number, connection, data))
        newest_ns = max(newest_ns, stamp_ns)
        while waiting[0][0] < newest_ns - _DISORDER_NS:
            due_ns, _, due, due_data = heapq.heappop(waiting)
            yield due, due_ns, due_data
    while waiting:
        due_ns, _, due, due_data = heapq.heappop(waiting)
        yield due, due_ns, due_data


def _goes_back(parts: Iterable[tuple[int, NDArray[np.float64]]]) -> bool:
    """Whether a stamp lies so far behind one of the same topic before it that the recorder's clock was set back.

    Of one topic, because who makes a bag of other data may write topic after topic.
    """
    newest_ns: dict[int, float] = {}
    for topic, stamps_ns in parts:
        newest_before_ns = np.maximum.accumulate(np.append(newest_ns.get(topic, 0.0), stamps_ns))
        if (stamps_ns < newest_before_ns[:-1] - SET_BACK_NS).any():
            return True
        newest_ns[topic] = newest_before_ns[-1]
    return False


class _Schemas(dict[int, Schema]):
    """Schemas by number; one in an encoding that is not known counts as none.

    rosbag2 writes the encoding ``unknown`` where it finds no definition, for instance of the messages of an action.
    """

    def __setitem__(self, number: int, schema: Schema) -> None:
        known = schema if schema.encoding in _ENCODINGS else schema._replace(encoding="", data="")
        super().__setitem__(number, known)


class McapFileReader(McapReader):
    """Reads an MCAP file, whatever the encodings of its definitions and the order of its messages."""

    def __init__(self, path: Any) -> None:
        super().__init__(path)
        self.schemas = _Schemas()
        self._was_set_back: bool | None = None

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[Message, None, None]:
        """Topic, stamp [ns] and serialised message, in the order of the stamps, as far as no clock was set back."""
        if self._was_set_back is None:
            self._was_set_back = bool(self.chunks) and self._goes_back()
        if not self.chunks:
            # As rosbag2's preset `fastwrite` leaves it: messages as they were taken from their queues.
            yield from in_order(self.messages_scan(connections, start, stop))
        elif self._was_set_back:
            # By their stamps, messages of two times would be mixed.
            yield from self.messages_scan(connections, start, stop)
        else:
            yield from super().messages(connections, start, stop)

    def _goes_back(self) -> bool:
        """Look at all messages where chunks last for long, or begin before an earlier one ends."""
        chunks = sorted(self.chunks, key=lambda one: one.chunk_start_offset)
        begin_ns, end_ns = np.array(
            [(one.message_start_time, one.message_end_time) for one in chunks], dtype=np.float64
        ).T
        is_behind = begin_ns[1:] < np.maximum.accumulate(end_ns)[:-1] - _BEHIND_NS
        if not is_behind.any() and (end_ns - begin_ns <= _APART_NS).all():
            return False
        return _goes_back(part for one in chunks for part in self._stamps_ns(one))

    def _stamps_ns(self, chunk: Any) -> Generator[tuple[int, NDArray[np.float64]], None, None]:
        """The channels of a chunk, each with the stamps of its messages in the order in which they were recorded."""
        assert self.bio is not None
        for channel, offset in chunk.message_index_offsets.items():
            self.bio.seek(offset + 11)  # kind and length of the record, channel
            size = int.from_bytes(self.bio.read(4), "little")
            if size > chunk.message_index_length:
                raise ReaderError("an index of messages is longer than those of its chunk together")
            stamps_ns, places = np.frombuffer(self.bio.read(size), dtype="<u8").reshape(-1, 2).T
            yield channel, stamps_ns[np.argsort(places)].astype(np.float64)


class SqliteFileReader(Sqlite3Reader):
    """Reads a ``.db3`` file, whatever its path; refuses what rosbag2 does not write into one.

    A column of SQLite takes values of any type, and rosbags would pass them on; a view may compute for ever.
    """

    def __init__(self, path: Any) -> None:
        super().__init__(_for_uri(path))
        self._original = Path(path)
        self._was_set_back: bool | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def open(self) -> None:
        """Open it; where its recorder was killed, a copy with all that it had written.

        Raises
        ------
        RecordingError, ReaderError
            It cannot be read.
        """
        if not has_log(self._original):
            super().open()
            return
        self._folder = tempfile.TemporaryDirectory(prefix="acts_bag_")
        try:
            self.path = _for_uri(merged_copy(self._original, Path(self._folder.name)))
            super().open()
        except BaseException:
            self._folder.cleanup()
            raise

    def close(self) -> None:
        """Close it."""
        super().close()
        if self._folder is not None:
            self._folder.cleanup()

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[Message, None, None]:
        """Topic, stamp [ns] and serialised message, in the order of the stamps, as far as no clock was set back."""
        if self._was_set_back is None:
            self._was_set_back = self._may_go_back() and self._goes_back()
        read = self._as_recorded if self._was_set_back else super().messages
        for connection, stamp_ns, data in read(connections, start, stop):
            if type(stamp_ns) is not int or type(data) is not bytes:
                raise ReaderError(f"a message has the stamp {stamp_ns!r:.40} and is of {type(data).__name__}")
            yield connection, stamp_ns, data

    def _open(self) -> None:
        others = self._select("SELECT name FROM sqlite_master WHERE type NOT IN ('table', 'index')")
        if others:
            raise ReaderError(f"it holds {others[0]!r:.40}, which is neither a table nor an index")
        if self._select("SELECT name FROM sqlite_master WHERE name = 'message_definitions'"):
            unread = self._select(
                "SELECT encoding FROM message_definitions "
                "WHERE encoding NOT IN ('ros2msg', 'ros2idl') AND topic_type IN (SELECT type FROM topics)"
            )
            if unread:
                raise ReaderError(
                    f"it has a message definition in the encoding {unread[0]!r:.40}; `ros2 bag convert` to MCAP makes "
                    "it readable"
                )
        try:
            super()._open()
        except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
            raise ReaderError(f"its tables hold something else than rosbag2 writes ({error})") from error
        for one in self.connections:
            if not all(isinstance(text, str) for text in (one.topic, one.msgtype, one.msgdef.data, one.digest)):
                raise ReaderError(f"the topic {one.topic!r:.40} is not described by text")
        if type(self.metadata.start_time) is not int or type(self.metadata.end_time) is not int:
            raise ReaderError("the stamps of its messages are not whole numbers")

    def _may_go_back(self) -> bool:
        """Whether one of some stamps lies behind one before it."""
        assert self.dbconn is not None
        ((first, last),) = self.dbconn.execute("SELECT min(id), max(id) FROM messages").fetchall()
        if type(first) is not int or type(last) is not int:
            return False
        looks = (self.metadata.end_time - self.metadata.start_time) // _APART_NS + 2
        newest_ns = 0
        for number in range(first, last + 1, max((last - first) // looks, 1)):
            (stamp_ns,) = self.dbconn.execute(
                "SELECT timestamp FROM messages WHERE id >= ? ORDER BY id LIMIT 1", (number,)
            ).fetchone()
            if type(stamp_ns) is not int or stamp_ns < newest_ns - _BEHIND_NS:
                return True
            newest_ns = max(newest_ns, stamp_ns)
        return False

    def _goes_back(self) -> bool:
        """As of MCAP; one message after another, since there may be millions."""
        assert self.dbconn is not None
        newest_ns: dict[int, int] = {}
        for topic, stamp_ns in self.dbconn.execute("SELECT topic_id, timestamp FROM messages ORDER BY id"):
            if type(stamp_ns) is not int:
                continue  # told when it is read
            if stamp_ns < newest_ns.get(topic, 0) - SET_BACK_NS:
                return True
            newest_ns[topic] = max(newest_ns.get(topic, 0), stamp_ns)
        return False

    def _as_recorded(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[Message, None, None]:
        """As `messages`, in the order in which they were recorded."""
        assert self.dbconn is not None
        own = {one.id: one for one in connections}
        begin, end = 0 if start is None else start, 2**63 - 1 if stop is None else stop
        query = "SELECT topic_id, timestamp, data FROM messages WHERE timestamp >= ? AND timestamp < ? ORDER BY id"
        for topic_id, stamp_ns, data in self.dbconn.execute(query, (begin, end)):
            if topic_id in own:
                yield own[topic_id], stamp_ns, data

    def _select(self, query: str) -> list[Any]:
        assert self.dbconn is not None
        return [value for (value,) in self.dbconn.execute(query)]


def _for_uri(path: Path) -> Path:
    """A path of which rosbags can make an URI, in which some characters mean something else."""
    return Path(str(path).replace("%", "%25").replace("?", "%3f").replace("#", "%23"))


class FolderReader(DirectoryReader):
    """Reads a folder with ``metadata.yaml``."""

    STORAGE_PLUGINS = {"mcap": McapFileReader, "sqlite3": SqliteFileReader}  # noqa: RUF012

    def __init__(self, path: Any) -> None:
        super().__init__(path)
        self.packs_messages = False
        """Whether each message is compressed by zstd, and given as it is."""

    def open(self) -> None:
        """Open all files.

        Raises
        ------
        ReaderError
            ``metadata.yaml`` holds something else than rosbag2 writes, which rosbags would pass on.
        """
        super().open()
        # Nobody reads it, but it is cleared at the end.
        self.files: list[Any] = []
        for one in self.connections:
            if not (isinstance(one.topic, str) and isinstance(one.msgtype, str) and type(one.msgcount) is int):
                self.close()
                raise ReaderError(f"metadata.yaml describes the topic {one.topic!r:.40} wrongly")
        self.packs_messages = self.metadata.compression_mode == "message"

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[Message, None, None]:
        """Messages of all files, one file after another.

        rosbags would leave out topics whose quality of service a file says otherwise than ``metadata.yaml``, and unpack
        messages without a limit.
        """
        wanted = {(connection.topic, connection.msgtype): connection for connection in connections}
        for storage in self.storages:
            own = {
                one.id: wanted[one.topic, one.msgtype]
                for one in storage.connections
                if (one.topic, one.msgtype) in wanted
            }
            if own:
                chosen = [one for one in storage.connections if one.id in own]
                for connection, stamp_ns, data in storage.messages(chosen, start, stop):
                    yield own[connection.id], stamp_ns, data


class BagReader(Reader):
    """Reads a folder with ``metadata.yaml``, or one file."""

    STORAGE_PLUGINS = {"dir": FolderReader, ".mcap": McapFileReader, ".db3": SqliteFileReader}  # noqa: RUF012

    @property
    def packs_messages(self) -> bool:
        """Whether each message is compressed by zstd, and given as it is."""
        return isinstance(self.storage, FolderReader) and self.storage.packs_messages
