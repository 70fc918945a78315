# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Write a bag such that a crash loses only what came since the last `flush`."""

from __future__ import annotations

import errno
import os
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from rosbags.interfaces import Qos
from rosbags.rosbag2.errors import WriterError

from acts_core.errors import RecordingError
from acts_ros.bags.rosbag2_format import McapFile, Rosbag2Writer

# A clock that is further behind was set back; one that is less is adjusted [ns].
_SET_BACK_NS = 100_000_000


def require_new(path: Path) -> None:
    """Refuse a path at which there is something already.

    Raises
    ------
    RecordingError
        There is.
    OSError
        It cannot be looked at, as where its name is too long.
    """
    if path.exists():
        raise RecordingError(f"'{path}' exists already and is not overwritten: choose another folder")


class BagWriter:
    """An MCAP bag in rosbag2's layout. After a failed write, `write` and `flush` raise the error again.

    Parameters
    ----------
    path : Path
        Folder to make; it must not exist.
    recorder : str
        Who has recorded it, as the bag says.

    Raises
    ------
    RecordingError
        The folder exists, or cannot be made.
    """

    def __init__(self, path: Path, recorder: str = "ACTS") -> None:
        require_new(path)
        self.path = path
        self._last_stamp_ns = self._ahead_ns = 0
        self._failure: RecordingError | None = None
        try:
            self._writer = Rosbag2Writer(path)
            # Without custom data rosbags writes null, where rosbag2 expects a map.
            self._writer.set_custom_data("recorder", recorder)
            self._writer.open()
            # Not every file system counts the names of its files.
            self._counts_names = self._names() > 0
        except (OSError, WriterError) as error:
            reason = error.strerror if isinstance(error, OSError) else error
            raise RecordingError(
                f"cannot make the bag '{path}' ({reason}); needed is a new name in a folder that can be written"
            ) from error

    def add_topic(self, topic: str, message_type: str, definition: str, type_hash: str, offered: list[Qos]) -> Any:
        """Add a topic and return its handle for `write`."""
        return self._writer.add_connection(
            topic, message_type, msgdef=definition, rihs01=type_hash, offered_qos_profiles=offered
        )

    def write(self, topic: Any, data: bytes) -> None:
        """Write one serialised message with the present time.

        Stamps never decrease. After the clock was set back they go on from the last one, as far apart as before, until
        the clock has caught up.
        """
        if self._failure is not None:
            raise self._failure
        try:
            self._writer.write(topic, self._stamp_ns(), data)
        except OSError as error:
            raise self._give_up(error) from error

    def flush(self) -> None:
        """Pass all data to the operating system, so that they survive the end of this process."""
        if self._failure is not None:
            raise self._failure
        storage = self._storage
        try:
            # An incomplete chunk would be lost; one without messages would have no valid times.
            if storage.chunk.msgs:
                storage.close_chunk()
            storage.bio.flush()
            # The system would go on to take what nobody can read any more.
            if self._counts_names and not self._names():
                raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
        except OSError as error:
            raise self._give_up(error) from error

    def close(self) -> None:
        """Finish the bag with its index and ``metadata.yaml``, unless a write has failed."""
        if self._failure is not None:
            return
        try:
            self._writer.close()
        except OSError as error:
            raise self._give_up(error) from error

    def size_bytes(self) -> int:
        """Size of its files [bytes]."""
        return sum(path.stat().st_size for path in self.path.iterdir())

    @property
    def _storage(self) -> McapFile:
        storage = self._writer.storage
        assert isinstance(storage, McapFile)
        return storage

    def _names(self) -> int:
        """How many names the file has that is written; of one that was deleted 0."""
        return os.fstat(self._storage.bio.fileno()).st_nlink

    def _stamp_ns(self) -> int:
        """The present time for a message."""
        now_ns, last_ns = time.time_ns(), self._last_stamp_ns
        if now_ns >= last_ns:
            self._ahead_ns = 0
        elif now_ns + self._ahead_ns < last_ns - _SET_BACK_NS:
            self._ahead_ns = last_ns - now_ns
        self._last_stamp_ns = max(now_ns + self._ahead_ns, last_ns)
        return self._last_stamp_ns

    def _give_up(self, error: OSError) -> RecordingError:
        """Keep the file as it is: writing the rest would fail again, at the latest when Python ends."""
        with suppress(OSError):
            self._writer.abort()
        is_there = any(self.path.glob("*.mcap"))
        left = "The messages in it can be played." if is_there else "It is not there any more: deleted, or moved."
        self._failure = RecordingError(f"cannot write to the bag '{self.path}': {error.strerror}. {left}")
        return self._failure
