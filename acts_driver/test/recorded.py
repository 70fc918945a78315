# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings for tests: bags of samples, and npz files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from acts_core.frames import SampleFrame
from acts_ros.messages import SamplesMessage

DEFINITION = """
std_msgs/Header header
uint32 sequence
uint8 scheme
uint16 rows
uint16 cols
builtin_interfaces/Duration duration
uint16[] indices
uint16[] counts
"""


def write_bag(
    path: Path,
    topics: dict[str, Sequence[tuple[SampleFrame, int]]],
    definition: str = DEFINITION,
    plugin: StoragePlugin = StoragePlugin.MCAP,
) -> Path:
    """A bag in rosbag2's layout; for each topic frames and their stamps [ns]."""
    store = get_typestore(Stores.ROS2_KILTED if hasattr(Stores, "ROS2_KILTED") else Stores.LATEST)
    store.register(get_types_from_msg(definition, "acts_msgs/msg/TactileSamples"))
    message = SamplesMessage("plate")
    with Writer(path, version=9, storage_plugin=plugin) as writer:
        for topic, frames in topics.items():
            connection = writer.add_connection(topic, "acts_msgs/msg/TactileSamples", typestore=store)
            for frame, stamp_ns in frames:
                # The recorder's own stamp is later, and does not count.
                writer.write(connection, stamp_ns + 5_000_000, serialize_message(message.fill(frame, stamp_ns)))
    return path
