# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags of rosbag2 that were recorded while the clock was set back: by their stamps, two times would be mixed."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from acts_ros.bags.message_types import Definitions
from acts_ros.bags.reading import open_bag
from acts_ros.bags.storages import McapFileReader, SqliteFileReader

TYPE = "std_msgs/msg/String"
T0_NS = 1_700_000_000_000_000_000
S = 1_000_000_000


def write(path: Path, plugin: StoragePlugin, messages: Iterable[tuple[str, int]]) -> Path:
    """A bag of messages in this order, each with its topic and stamp; the last bytes of each are the stamp."""
    definition, type_hash = Definitions().describe(TYPE)
    topics: dict[str, object] = {}
    with Writer(path, version=8, storage_plugin=plugin) as writer:
        for name, stamp_ns in messages:
            if name not in topics:
                topics[name] = writer.add_connection(name, TYPE, msgdef=definition, rihs01=type_hash)
            # Large, so that there are many chunks.
            writer.write(topics[name], stamp_ns, bytes(20_000) + stamp_ns.to_bytes(8, "little"))
    return path


def read(path: Path, topics: list[str], from_ns: int | None = None) -> list[tuple[str, int]]:
    with open_bag(path) as bag:
        found = list(bag.messages(topics, from_ns))
        assert bag.note is None
    assert all(int.from_bytes(data[-8:], "little") == stamp_ns for _, stamp_ns, data in found)
    return [(topic, stamp_ns) for topic, stamp_ns, _ in found]


@pytest.mark.parametrize("plugin", StoragePlugin)
@pytest.mark.parametrize("before_s", [22, 120])
def test_what_was_recorded_after_the_clock_was_set_back_comes_after_what_was_before(
    before_s: int, plugin: StoragePlugin, tmp_path: Path
) -> None:
    first = range(T0_NS, T0_NS + before_s * S, S // 5)
    then = range(T0_NS + 20 * S, T0_NS + 140 * S, S // 5)
    recorded = [(name, stamp_ns) for stamp_ns in (*first, *then) for name in ("/a", "/b")]
    bag = write(tmp_path / "bag", plugin, recorded)
    assert read(bag, ["/a", "/b"]) == recorded
    assert read(bag, ["/b"]) == [message for message in recorded if message[0] == "/b"]
    later_ns = T0_NS + 21 * S
    assert read(bag, ["/a", "/b"], later_ns) == [message for message in recorded if message[1] >= later_ns]


@pytest.mark.parametrize("plugin", StoragePlugin)
def test_topics_that_were_written_one_after_another_are_read_by_their_stamps(
    plugin: StoragePlugin, tmp_path: Path
) -> None:
    written = [(name, T0_NS + number * S) for name in ("/a", "/b") for number in range(100)]
    found = read(write(tmp_path / "bag", plugin, written), ["/a", "/b"])
    assert [stamp_ns for _, stamp_ns in found] == sorted(stamp_ns for _, stamp_ns in written)


@pytest.mark.parametrize("plugin", StoragePlugin)
def test_a_bag_whose_clock_was_not_set_is_not_read_twice(
    plugin: StoragePlugin, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> bool:
        raise AssertionError("each message was looked at")

    monkeypatch.setattr(McapFileReader, "_stamps_ns", fail)
    monkeypatch.setattr(SqliteFileReader, "_goes_back", fail)
    recorded = [(name, T0_NS + number * S // 100) for number in range(1000) for name in ("/a", "/b")]
    assert read(write(tmp_path / "bag", plugin, recorded), ["/a", "/b"]) == recorded
