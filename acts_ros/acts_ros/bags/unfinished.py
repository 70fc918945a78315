# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Read the files of a bag whose ``metadata.yaml`` is missing or cannot be used, because its recorder was killed."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

from rosbags.interfaces import Connection

from acts_core.errors import RecordingError
from acts_ros.bags.salvage import SoundRecords
from acts_ros.bags.storages import McapFileReader, SqliteFileReader

SUFFIXES = (".mcap", ".db3")

FileReader = McapFileReader | SqliteFileReader


class UnfinishedBag:
    """The complete records of one or more files, one file after another, of each up to the first that is damaged.

    Parameters
    ----------
    paths : sequence of Path
        Files of one recording in their order.

    Attributes
    ----------
    connections : list of Connection
        Topics, each once.
    unread : list of str
        For the user: files in which nothing can be read, and from where on others are damaged, with the reason.

    Raises
    ------
    RecordingError
        Nothing can be read in any of them.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self.connections: list[Connection] = []
        self.unread: list[str] = []
        self._readers: list[FileReader] = []
        for path in paths:
            self._open(path)
        if not self._readers:
            raise RecordingError("; ".join(self.unread))

    def messages(
        self, connections: Collection[Connection], start: int | None = None
    ) -> Iterator[tuple[Connection, int, bytes]]:
        """Topic, stamp [ns] and serialised message, one file after another."""
        wanted = {(connection.topic, connection.msgtype) for connection in connections}
        for reader in self._readers:
            own = [connection for connection in reader.connections if (connection.topic, connection.msgtype) in wanted]
            if own:
                yield from reader.messages(own, start)

    def close(self) -> None:
        """Close the files."""
        for reader in self._readers:
            with suppress(OSError):
                reader.close()

    def _open(self, path: Path) -> None:
        # Of a path, rosbags uses only `open`.
        records = SoundRecords(path)
        reader = SqliteFileReader(path) if path.suffix == ".db3" else McapFileReader(cast(Any, records))
        try:
            reader.open()
        except Exception as damage:  # noqa: BLE001  rosbags raises errors of many types on damaged files
            self.unread.append(records.damage or f"{path.name}: {damage}")
            return
        if records.damage is not None:
            self.unread.append(records.damage)
            if not reader.connections:
                reader.close()
                return
        self._readers.append(reader)
        for connection in reader.connections:
            self._add(connection)

    def _add(self, connection: Connection) -> None:
        for place, known in enumerate(self.connections):
            if (known.topic, known.msgtype) == (connection.topic, connection.msgtype):
                self.connections[place] = known._replace(msgcount=known.msgcount + connection.msgcount)
                return
        self.connections.append(connection)


def storage_files(path: Path) -> list[Path]:
    """Files of a recording: those in a folder, ``bag_10`` after ``bag_9``, or the file itself."""
    if not path.is_dir():
        return [path]
    for suffix in SUFFIXES:
        files = [file for file in path.iterdir() if file.suffix == suffix]
        if files:
            return sorted(files, key=_with_numbers)
    return []


def _with_numbers(path: Path) -> list[tuple[str, int]]:
    """A key by which numbers in names are sorted as numbers."""
    return [(word, int(number or 0)) for word, number in re.findall(r"(\D*)(\d*)", path.name)]
