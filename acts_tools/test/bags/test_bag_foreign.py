# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags as rosbag2 writes them and ours never are: other storage, compression, definitions, order, and several files."""

from __future__ import annotations

import re
import shutil
import sqlite3
import struct
from collections.abc import Iterable
from contextlib import closing
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from acts_core.errors import RecordingError
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.reading import open_bag
from acts_ros.bags.salvage import _whole_records
from acts_ros.bags.unpacking import unpack, unpacked_bytes, zstd

TYPE = "std_msgs/msg/String"
WORD = b"\0\1\0\0" + bytes(2000)


def read(path: Path) -> tuple[list[tuple[int, bytes]], str | None]:
    """Stamps and messages of the topic /word, and what is told of the bag."""
    with open_bag(path) as bag:
        return [(stamp_ns, data) for _, stamp_ns, data in bag.messages(["/word"])], bag.note


def write(
    path: Path,
    stamps_ns: Iterable[int],
    plugin: StoragePlugin = StoragePlugin.MCAP,
    mode: CompressionMode = CompressionMode.NONE,
    kind: str = TYPE,
) -> Path:
    """A bag of the topic /word by rosbags; the last bytes of each message are its stamp."""
    writer = Writer(path, version=8, storage_plugin=plugin)
    if mode != CompressionMode.NONE:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        definition, type_hash = Definitions().describe(kind)
        topic = writer.add_connection("/word", kind, msgdef=definition, rihs01=type_hash)
        for stamp_ns in stamps_ns:
            writer.write(topic, stamp_ns, message(stamp_ns))
    return path


def message(stamp_ns: int) -> bytes:
    return WORD + stamp_ns.to_bytes(8, "little")


def mcap(messages: Iterable[tuple[int, bytes]], encoding: str, definition: str) -> bytes:
    """An MCAP file without chunks and without a summary, of a topic /word and an empty topic /other."""

    def record(kind: int, content: bytes) -> bytes:
        return struct.pack("<BQ", kind, len(content)) + content

    def text(content: str) -> bytes:
        return struct.pack("<I", len(content)) + content.encode()

    magic = b"\x89MCAP0\r\n"
    parts = [magic, record(0x01, text("ros2") + text("libmcap 1.4.0"))]
    other = "example_interfaces/action/Fibonacci_FeedbackMessage"
    for number, name, topic, kind, words in (
        (1, TYPE, "/word", encoding, definition),
        (2, other, "/other", "unknown", ""),
    ):
        parts.append(record(0x03, struct.pack("<H", number) + text(name) + text(kind) + text(words)))
        parts.append(record(0x04, struct.pack("<HH", number, number) + text(topic) + text("cdr") + text("")))
    parts += [record(0x05, struct.pack("<HIQQ", 1, 0, stamp_ns, stamp_ns) + data) for stamp_ns, data in messages]
    return b"".join([*parts, record(0x0F, bytes(4)), record(0x02, bytes(20)), magic])


def test_messages_that_lie_in_the_file_as_they_came_are_read_by_their_stamps(tmp_path: Path) -> None:
    path = tmp_path / "fastwrite_0.mcap"
    stamps_ns = [3, 1, 2, 10, 5_000_000_000, 4_999_999_999, 5_000_000_001]
    path.write_bytes(mcap(((stamp_ns, message(stamp_ns)) for stamp_ns in stamps_ns), "", ""))
    found, note = read(path)
    assert found == [(stamp_ns, message(stamp_ns)) for stamp_ns in sorted(stamps_ns)]
    assert note is None


def test_what_lies_in_the_file_as_it_came_is_not_kept_until_a_clock_that_was_set_back_has_caught_up(
    tmp_path: Path,
) -> None:
    path = tmp_path / "fastwrite_0.mcap"
    stamps_ns = [*range(0, 30_000_000_000, 100_000_000), *range(20_000_000_000, 40_000_000_000, 100_000_000)]
    path.write_bytes(mcap(((stamp_ns, message(stamp_ns)) for stamp_ns in stamps_ns), "", ""))
    assert [stamp_ns for stamp_ns, _ in read(path)[0]] == stamps_ns


def test_a_topic_whose_definition_the_recorder_did_not_find_does_not_spoil_the_others(tmp_path: Path) -> None:
    path = tmp_path / "bag_0.mcap"
    path.write_bytes(mcap([(1, message(1))], "ros2msg", "string data\n"))
    with open_bag(path) as bag:
        assert set(bag.topics()) == {"/word", "/other"}
        bag.check_definition("/word")
        bag.check_definition("/other")
        assert [data for _, _, data in bag.messages(["/word", "/other"])] == [message(1)]


@pytest.mark.parametrize("name", ["run#1", "run?1", "100%41", "ä b"])
def test_sqlite_files_are_read_whatever_the_name_of_their_folder(tmp_path: Path, name: str) -> None:
    path = write(tmp_path / "bag", [1, 2], StoragePlugin.SQLITE3).rename(tmp_path / name)
    assert read(path / "bag.db3")[0] == read(path)[0] == [(1, message(1)), (2, message(2))]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            "UPDATE message_definitions SET encoding = 'unknown'",
            "a message definition in the encoding 'unknown'; `ros2 bag convert`",
        ),
        ("UPDATE messages SET data = 4000000000", "after 0 messages: a message has the stamp 1 and is of int"),
        ("UPDATE messages SET timestamp = 1.5", "the stamps of its messages are not whole numbers"),
        ("UPDATE messages SET timestamp = 'x'", "its tables hold something else than rosbag2 writes"),
        ("UPDATE topics SET type = x'ff'", "the topic '/word' is not described by text"),
        ("UPDATE topics SET offered_qos_profiles = '- a: 1'", "its tables hold something else than rosbag2 writes"),
        ("DROP TABLE schema; CREATE VIEW schema AS SELECT 4 AS schema_version", "'schema', which is neither a table"),
    ],
)
def test_sqlite_files_that_hold_something_else_are_refused(tmp_path: Path, change: str, said: str) -> None:
    path = write(tmp_path / "bag", [1], StoragePlugin.SQLITE3)
    with sqlite3.connect(path / "bag.db3") as base:
        base.executescript(change)
    base.close()
    with pytest.raises(RecordingError, match=re.escape(said)):
        read(path / "bag.db3")


def killed_sqlite(path: Path, stamps_ns: Iterable[int]) -> Path:
    """A bag of a recorder that was killed: the messages after the first are in the file that SQLite writes to first."""
    file = write(path, [1], StoragePlugin.SQLITE3) / f"{path.name}.db3"
    (path / "metadata.yaml").unlink()
    kept = path.with_name("kept")
    kept.mkdir()
    with closing(sqlite3.connect(file)) as base:
        base.execute("PRAGMA journal_mode=WAL")
        base.executemany(
            "INSERT INTO messages (topic_id, timestamp, data) VALUES (1, ?, ?)",
            [(stamp_ns, message(stamp_ns)) for stamp_ns in stamps_ns],
        )
        base.commit()
        for one in (file, Path(f"{file}-wal")):  # closing it would put them together
            shutil.copyfile(one, kept / one.name)
    assert len(list(kept.iterdir())) == 2
    shutil.rmtree(path)
    return kept.rename(path)


def test_what_sqlite_had_not_put_into_the_file_yet_is_read(tmp_path: Path) -> None:
    path = killed_sqlite(tmp_path / "bag", range(2, 100)).rename(tmp_path / "run#1")
    before = {file.name: file.read_bytes() for file in path.iterdir()}
    found, _ = read(path)
    assert found == [(stamp_ns, message(stamp_ns)) for stamp_ns in range(1, 100)]
    assert read(path / "bag.db3")[0] == found
    assert {file.name: file.read_bytes() for file in path.iterdir()} == before


def test_nothing_is_read_of_a_file_that_cannot_be_put_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = killed_sqlite(tmp_path / "bag", range(2, 100))
    usage = shutil.disk_usage(tmp_path)._replace(free=50_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _folder: usage)
    with pytest.raises(RecordingError, match=r"are still in bag.db3-wal. To read them, both are copied to"):
        read(path)


def idl_of(name: str) -> str:
    """The complete definition in the encoding ros2idl: that of a header, and of the time in it."""
    parts = []
    for one in (name, "builtin_interfaces/msg/Time"):
        package, kind, short = one.split("/")
        content = (Path(get_package_share_directory(package)) / kind / f"{short}.idl").read_text()
        parts.append(f"{'=' * 80}\nIDL: {one}\n{content}")
    return "\n".join(parts)


def test_definitions_in_idl_are_compared_like_those_in_msg(tmp_path: Path) -> None:
    path = tmp_path / "bag_0.mcap"
    kind = "std_msgs/msg/Header"
    content = mcap([], "ros2idl", idl_of(kind)).replace(
        b"\x13\0\0\0std_msgs/msg/String", b"\x13\0\0\0std_msgs/msg/Header"
    )
    path.write_bytes(content)
    with open_bag(path) as bag:
        assert bag.topics()["/word"] == kind
        bag.check_definition("/word")
    path.write_bytes(content.replace(b"string frame_id", b"int32  frame_id"))
    with open_bag(path) as bag, pytest.raises(RecordingError, match="another definition of std_msgs/msg/Header"):
        bag.check_definition("/word")


@pytest.mark.parametrize("plugin", StoragePlugin)
def test_all_files_of_a_recorder_that_was_killed_are_read_in_their_order(plugin: StoragePlugin, tmp_path: Path) -> None:
    suffix = "mcap" if plugin is StoragePlugin.MCAP else "db3"
    folder = tmp_path / "killed"
    folder.mkdir()
    for number, stamp_ns in ((9, 1), (10, 2), (11, 3)):
        part = write(tmp_path / f"part_{number}", [stamp_ns], plugin)
        shutil.move(part / f"part_{number}.{suffix}", folder / f"killed_{number}.{suffix}")
    # The next file has been begun, and nothing is in it.
    (folder / f"killed_12.{suffix}").touch()
    found, note = read(folder)
    assert [stamp_ns for stamp_ns, _ in found] == [1, 2, 3]
    assert note is not None
    assert "never closed" in note
    assert f"not read: killed_12.{suffix}" in note


@pytest.mark.parametrize(
    "change",
    [
        ("message_count: 3\n    topic_metadata", "message_count:\n    topic_metadata"),
        ("name: /word", "name: [/word]"),
        (f"type: {TYPE}", "type:"),
    ],
)
def test_a_description_of_a_topic_that_makes_no_sense_is_as_good_as_none(
    tmp_path: Path, change: tuple[str, str]
) -> None:
    path = write(tmp_path / "bag", [1, 2, 3])
    metadata = path / "metadata.yaml"
    assert change[0] in metadata.read_text()
    metadata.write_text(metadata.read_text().replace(*change))
    messages, note = read(path)
    assert [stamp_ns for stamp_ns, _ in messages] == [1, 2, 3]
    assert note is not None
    assert "metadata.yaml describes the topic" in note


def test_a_list_of_files_that_is_none_is_passed_over(tmp_path: Path) -> None:
    path = write(tmp_path / "bag", [1, 2, 3])
    metadata = path / "metadata.yaml"
    changed, count = re.subn(r"  files:\n.*?(?=\n  \w)", "  files: some", metadata.read_text(), flags=re.DOTALL)
    assert count == 1
    metadata.write_text(changed)
    assert len(read(path)[0]) == 3


def test_a_version_that_is_not_known_is_read_like_a_bag_without_metadata(tmp_path: Path) -> None:
    path = write(tmp_path / "bag", [1, 2])
    metadata = path / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace("version: 8", "version: 99"))
    found, note = read(path)
    assert len(found) == 2
    assert note is not None
    assert "of another version" in note


@pytest.mark.parametrize("plugin", StoragePlugin)
def test_a_topic_is_found_whatever_its_file_says_of_the_quality_of_service(
    plugin: StoragePlugin, tmp_path: Path
) -> None:
    path = write(tmp_path / "bag", [1, 2], plugin)
    offered = "[{history: 1, depth: 7, reliability: 1, durability: 2, liveliness: 1, " + "".join(
        f"{name}: {{sec: 0, nsec: 0}}, " for name in ("deadline", "lifespan", "liveliness_lease_duration")
    )
    metadata = path / "metadata.yaml"
    old = "offered_qos_profiles: ''"
    assert old in metadata.read_text()
    fresh = f'offered_qos_profiles: "{offered}avoid_ros_namespace_conventions: false}}]"'
    metadata.write_text(metadata.read_text().replace(old, fresh))
    with open_bag(path) as bag:
        assert [one.depth for one in bag.recorded_qos("/word")] == [7]
    assert len(read(path)[0]) == 2


@pytest.mark.parametrize(
    ("plugin", "mode"),
    [
        (StoragePlugin.MCAP, CompressionMode.STORAGE),
        (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
        (StoragePlugin.SQLITE3, CompressionMode.FILE),
    ],
)
def test_what_is_compressed_is_unpacked(plugin: StoragePlugin, mode: CompressionMode, tmp_path: Path) -> None:
    path = write(tmp_path / "bag", range(1, 40), plugin, mode)
    assert sum(file.stat().st_size for file in path.iterdir()) < 40 * len(WORD)
    found, note = read(path)
    assert found == [(stamp_ns, message(stamp_ns)) for stamp_ns in range(1, 40)]
    assert note is None


@pytest.mark.parametrize("mode", [CompressionMode.NONE, CompressionMode.STORAGE])
def test_what_comes_before_a_damaged_chunk_is_read_of_a_recorder_that_was_killed(
    mode: CompressionMode, tmp_path: Path
) -> None:
    path = write(tmp_path / "bag", range(1, 1500), mode=mode)
    (path / "metadata.yaml").unlink()
    file = path / "bag.mcap"
    with file.open("rb") as stream:
        chunks = [(start, length) for kind, start, length in _whole_records(stream) if kind == 0x06]
    assert len(chunks) == 3
    data = bytearray(file.read_bytes())
    start, length = chunks[1]
    data[start + length // 2 : start + length] = bytes(length - length // 2)
    file.write_bytes(data)
    found, note = read(path)
    assert 100 < len(found) < 1000
    assert [stamp_ns for stamp_ns, _ in found] == list(range(1, len(found) + 1))
    assert note is not None
    assert "not read: bag.mcap from byte " in note


def test_records_that_are_zeros_end_a_file_without_chunks(tmp_path: Path) -> None:
    file = tmp_path / "fastwrite_0.mcap"
    content = mcap([(1, message(1)), (2, message(2))], "", "")
    end = content.index(message(2)) - 31
    file.write_bytes(content[:end] + bytes(5000))
    found, note = read(file)
    assert found == [(1, message(1))]
    assert note is not None
    assert f"not read: fastwrite_0.mcap from byte {end} on: " in note


def test_messages_that_are_compressed_and_do_not_say_so_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "bag", [1], StoragePlugin.SQLITE3, CompressionMode.MESSAGE)
    (path / "metadata.yaml").unlink()
    with pytest.raises(RecordingError, match=r"/word are compressed one by one.*`ros2 bag reindex`"):
        read(path)


def test_a_chunk_that_holds_more_than_it_says_is_not_unpacked(tmp_path: Path) -> None:
    path = write(tmp_path / "bag", range(1, 40), mode=CompressionMode.STORAGE)
    file = path / "bag.mcap"
    data = file.read_bytes()
    size = (40 * len(WORD)).to_bytes(8, "little")
    at = 8 + 9 + int.from_bytes(data[9:17], "little")  # after the header comes the chunk: kind, length, two times
    assert data[at] == 0x06
    true = data[at + 25 : at + 33]
    assert true != size
    # In the chunk and in its index.
    file.write_bytes(data.replace(true, (1000).to_bytes(8, "little")))
    with pytest.raises(RecordingError, match="unpack to more than the 1000 bytes that are due"):
        read(path)


def test_files_that_do_not_fit_unpacked_on_the_disk_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "bag", range(1, 40), StoragePlugin.SQLITE3, CompressionMode.FILE)
    usage = shutil.disk_usage(tmp_path)._replace(free=50_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _folder: usage)
    with pytest.raises(RecordingError, match=r"bag.db3.zstd: unpacked it is larger than the space in"):
        read(path)


@pytest.mark.parametrize("kind", ["lz4", "zstd"])
def test_unpacking_has_a_limit_and_names_damage(kind: str) -> None:
    import lz4.frame

    pack = lz4.frame.compress if kind == "lz4" else zstd.compress
    content = bytes(100_000)
    packed = pack(content)
    assert unpack(packed, kind, len(content)) == content
    assert unpack(packed + packed, kind) == content + content
    assert unpack(b"", kind) == b""
    for limit in (0, 10, len(content) - 1):
        with pytest.raises(RecordingError, match=f"more than the {limit} bytes"):
            unpack(packed, kind, limit)
    with pytest.raises(RecordingError, match="end too early"):
        unpack(packed[:-5], kind)
    with pytest.raises(RecordingError, match="are damaged"):
        unpack(b"no such data at all", kind)


def test_the_size_of_a_file_is_counted_no_further_than_asked(tmp_path: Path) -> None:
    path = tmp_path / "zeros.zstd"
    path.write_bytes(zstd.compress(bytes(3_000_000)))
    assert unpacked_bytes(path, 5_000_000) == 3_000_000
    assert 1_000_000 < unpacked_bytes(path, 1_000_000) < 3_000_000
    path.write_bytes(path.read_bytes()[:-3])
    with pytest.raises(RecordingError, match="compressed data are damaged"):
        unpacked_bytes(path, 5_000_000)
