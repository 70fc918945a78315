# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Write bags like rosbag2 where the library rosbags differs: version, type hashes, times, distribution."""

from __future__ import annotations

import os
import re
import zlib
from io import BytesIO
from pathlib import Path
from typing import cast

from rosbags.interfaces import Connection, ConnectionExtRosbag2
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.rosbag2.storage_mcap import Channel, McapWriter, write_channel, write_string, write_uint32

# Readers of rosbag2 accept any version and read the fields they know. Up to 8 the quality of service is a text with
# numbers; 9 has a list with names, on which Humble and Iron fail. 6 to 8 add fields that Humble ignores.
_METADATA_VERSION = 8

# Of the checksum in a chunk's record: after its kind, its length, two times and the size when unpacked [bytes].
_CHECKSUM_OFFSET = 1 + 8 + 8 + 8 + 8

_DISTRIBUTION_LINE = re.compile(r"^( *ros_distro:) rosbags$", re.MULTILINE)


class McapFile(McapWriter):
    """An MCAP file like that of rosbag2's storage plugin."""

    def add_connection(self, connection: Connection, offered_qos_profiles: str) -> None:
        """Add a channel with the hash of its type."""
        metadata = BytesIO()
        for text in ("offered_qos_profiles", offered_qos_profiles, "topic_type_hash", connection.digest):
            write_string(metadata, text)
        extension = cast(ConnectionExtRosbag2, connection.ext)
        channel = Channel(
            connection.id, connection.msgtype, connection.topic, extension.serialization_format, metadata.getvalue()
        )
        self.channels.append(channel)
        self.channel_stats[connection.id] = 0
        write_channel(self.chunk.bio, channel, self.schemas)

    def close_chunk(self) -> None:
        """Close the pending chunk with its checksum; one without messages has the times 0, as MCAP requires."""
        if not self.chunk.msgs:
            self.chunk.message_start_time = 0
        checksum = zlib.crc32(self.chunk.bio.getbuffer())
        begin = self.bio.tell()
        super().close_chunk()
        # rosbags writes 0, which means that there is none.
        end = self.bio.tell()
        self.bio.seek(begin + _CHECKSUM_OFFSET)
        write_uint32(self.bio, checksum)
        self.bio.seek(end)

    def close(self, version: int, metadata: str) -> None:
        """Write the index."""
        if not any(self.channel_stats.values()):
            self.message_start_time = 0
        super().close(version, _with_distribution(metadata))


class Rosbag2Writer(Writer):
    """A folder with an MCAP file and ``metadata.yaml`` that rosbag2 reads from Humble on.

    Parameters
    ----------
    path : Path
        Folder to make when it is opened; it must not exist.
    """

    STORAGE_PLUGINS = {StoragePlugin.MCAP: McapFile}  # noqa: RUF012

    def __init__(self, path: Path) -> None:
        super().__init__(path, version=_METADATA_VERSION, storage_plugin=StoragePlugin.MCAP)

    def close(self) -> None:
        """Write the index and ``metadata.yaml``."""
        if not any(self.counts.values()):
            # Otherwise an empty bag would start in the year 2262.
            self.min_timestamp = self.max_timestamp = 0
        super().close()
        fresh = self.metapath.with_suffix(".yaml.tmp")
        fresh.write_text(_with_distribution(self.metapath.read_text("utf8")), "utf8")
        fresh.replace(self.metapath)


def _with_distribution(metadata: str) -> str:
    """Metadata with the name of the ROS distribution, as rosbag2 writes it."""
    return _DISTRIBUTION_LINE.sub(rf"\1 {os.environ.get('ROS_DISTRO') or 'unknown'}", metadata)
