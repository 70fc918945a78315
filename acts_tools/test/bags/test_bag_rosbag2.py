# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags against what the readers of rosbag2 require, distribution by distribution.

The rules are those of rosbag2's own source: `rosbag2_storage` (``metadata_io.cpp`` of Humble, ``yaml.hpp`` and
``qos.cpp`` since) and `rosbag2_storage_mcap` (``mcap_storage.cpp``). They read every scalar as the type they want, so
that here every scalar is text.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import Reader

from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter

TYPE = "std_msgs/msg/String"
FOREVER = QosTime(9_223_372_036, 854_775_807)

# The version that each writes; a reader knows the fields up to it and looks at none that came later.
READERS = {"humble": 5, "iron": 7, "jazzy": 9, "kilted": 9}


class Topic(NamedTuple):
    """What a reader takes from the metadata about a topic."""

    name: str
    kind: str
    message_count: int
    qos: list[dict[str, Any]]
    type_hash: str


class Metadata(NamedTuple):
    """What a reader takes from the metadata."""

    topics: list[Topic]
    starting_time: int
    duration: int
    message_count: int
    paths: list[str]
    ros_distro: str


def decode(node: Any, reader: int) -> Metadata:
    """Metadata as a reader that knows the fields up to version `reader` sees them; KeyError where it would throw."""
    version = number(node["version"])
    known = min(version, reader)
    assert text(node["storage_identifier"]) == "mcap"
    topics = []
    for entry in sequence(node["topics_with_message_count"]):
        inner = entry["topic_metadata"]
        assert text(inner["serialization_format"]) == "cdr"
        offered = inner["offered_qos_profiles"] if known >= 9 else load(text(inner["offered_qos_profiles"]) or "[]")
        topics.append(
            Topic(
                text(inner["name"]),
                text(inner["type"]),
                number(entry["message_count"]),
                [qos(profile, reader) for profile in sequence(offered)],
                text(inner["type_description_hash"]) if known >= 7 else "",
            )
        )
    text(node["compression_format"])
    text(node["compression_mode"])
    for file in sequence(node["files"]):
        text(file["path"])
        number(file["starting_time"]["nanoseconds_since_epoch"])
        number(file["duration"]["nanoseconds"])
        number(file["message_count"])
    if known >= 6:
        assert all(isinstance(value, str) for pair in node["custom_data"].items() for value in pair)
    return Metadata(
        topics,
        number(node["starting_time"]["nanoseconds_since_epoch"]),
        number(node["duration"]["nanoseconds"]),
        number(node["message_count"]),
        [text(path) for path in sequence(node["relative_file_paths"])],
        text(node["ros_distro"]) if known >= 8 else "",
    )


def qos(node: Any, reader: int) -> dict[str, Any]:
    """A profile of the quality of service; numbers for Humble and Iron, numbers or names later."""
    found: dict[str, Any] = {"depth": number(node["depth"])}
    for name in ("history", "reliability", "durability", "liveliness"):
        value = text(node[name])
        found[name] = value if reader >= 9 and not node["history"].isdigit() else number(value)
    for name in ("deadline", "lifespan", "liveliness_lease_duration"):
        found[name] = (number(node[name]["sec"]), number(node[name]["nsec"]))
    found["conventions"] = {"false": False, "true": True}[node["avoid_ros_namespace_conventions"]]
    return found


def load(content: str) -> Any:
    return yaml.load(content, Loader=yaml.BaseLoader)


def number(node: Any) -> int:
    assert isinstance(node, str)
    value = int(node)
    assert 0 <= value < 2**64
    return value


def text(node: Any) -> str:
    assert isinstance(node, str), f"a reader wants text, there is {node!r}"
    return node


def sequence(node: Any) -> list[Any]:
    assert isinstance(node, list)
    return node


class Cursor:
    """Fields of an MCAP record, one after the other."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.at = 0

    def take(self, length: int) -> bytes:
        self.at += length
        return self.data[self.at - length : self.at]

    def number(self, code: str) -> int:
        return int(struct.unpack(f"<{code}", self.take(struct.calcsize(f"<{code}")))[0])

    def text(self) -> str:
        return self.take(self.number("I")).decode()

    def map(self) -> dict[str, str]:
        end = self.number("I") + self.at
        found = {}
        while self.at < end:
            key = self.text()
            found[key] = self.text()
        return found


def records(data: bytes) -> Iterator[tuple[int, Cursor]]:
    """Kind and content of the records, those within chunks included."""
    cursor = Cursor(data)
    while cursor.at < len(data):
        kind, length = cursor.number("B"), cursor.number("Q")
        content = Cursor(cursor.take(length))
        yield kind, content
        if kind == 0x06:
            start, end, _, _ = (content.number(code) for code in "QQQI")
            assert start <= end, "the times of a chunk"
            assert content.text() == ""
            yield from records(content.take(content.number("Q")))


def offer() -> Qos:
    return Qos(
        QosHistory.UNKNOWN,
        0,
        QosReliability.BEST_EFFORT,
        QosDurability.VOLATILE,
        FOREVER,
        FOREVER,
        QosLiveliness.AUTOMATIC,
        FOREVER,
        False,
    )


@pytest.fixture
def bag(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A bag of two topics, one of them without messages and without a known offer."""
    monkeypatch.setenv("ROS_DISTRO", "humble")
    path = tmp_path / "bag"
    writer = BagWriter(path)
    definition, type_hash = Definitions().describe(TYPE)
    word = writer.add_topic("/word", TYPE, definition, type_hash, [offer(), offer()])
    writer.add_topic("/silent", TYPE, definition, type_hash, [])
    for _ in range(3):
        writer.write(word, b"\0\1\0\0\1\0\0\0\0")
        writer.flush()
    writer.close()
    return path


@pytest.mark.parametrize("distribution", READERS)
def test_every_distribution_reads_the_metadata(bag: Path, distribution: str) -> None:
    node = load((bag / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    found = decode(node, READERS[distribution])
    assert [(topic.name, topic.kind, topic.message_count, len(topic.qos)) for topic in found.topics] == [
        ("/word", TYPE, 3, 2),
        ("/silent", TYPE, 0, 0),
    ]
    assert found.topics[0].qos[0] == {
        "depth": 0,
        "history": 3,
        "reliability": 2,
        "durability": 2,
        "liveliness": 1,
        "deadline": (9_223_372_036, 854_775_807),
        "lifespan": (9_223_372_036, 854_775_807),
        "liveliness_lease_duration": (9_223_372_036, 854_775_807),
        "conventions": False,
    }
    assert found.paths == ["bag.mcap"]
    assert found.message_count == 3
    with Reader(bag) as reader:
        assert (found.starting_time, found.duration + 1) == (reader.start_time, reader.duration)
    if READERS[distribution] >= 7:
        assert found.topics[0].type_hash == Definitions().describe(TYPE)[1]
    if READERS[distribution] >= 8:
        assert found.ros_distro == "humble"


def test_the_mcap_file_says_the_same_for_those_who_have_only_it(bag: Path) -> None:
    data = (bag / "bag.mcap").read_bytes()
    assert data[:8] == data[-8:] == b"\x89MCAP0\r\n"
    channels, metadata = [], []
    for kind, content in records(data[8:-8]):
        if kind == 0x04:
            content.take(4)
            channels.append((content.text(), content.text(), content.map()))
        elif kind == 0x0C:
            assert content.text() == "rosbag2"
            metadata.append(content.map())
    type_hash = Definitions().describe(TYPE)[1]
    # Once among the messages, once in the summary.
    assert sorted(topic for topic, _, _ in channels) == ["/silent", "/silent", "/word", "/word"]
    for topic, encoding, extra in channels:
        assert encoding == "cdr"
        assert extra["topic_type_hash"] == type_hash
        offered = sequence(load(extra["offered_qos_profiles"] or "[]"))
        assert [qos(profile, 5)["reliability"] for profile in offered] == ([2, 2] if topic == "/word" else [])
    (record,) = metadata
    assert decode(load(record["serialized_metadata"]), 9).ros_distro == "humble"


def test_a_bag_without_messages_has_times_that_can_be(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    writer = BagWriter(tmp_path / "bag")
    writer.add_topic("/silent", TYPE, *Definitions().describe(TYPE), [])
    writer.close()
    found = decode(load((tmp_path / "bag/metadata.yaml").read_text())["rosbag2_bagfile_information"], 9)
    assert (found.starting_time, found.duration, found.message_count) == (0, 0, 0)
    assert found.ros_distro == "unknown"
    statistics = [content for kind, content in records((tmp_path / "bag/bag.mcap").read_bytes()[8:-8]) if kind == 0x0B]
    assert [content.number(code) for content in statistics for code in "QHIIIIQQ"] == [0, 1, 1, 0, 1, 1, 0, 0]
