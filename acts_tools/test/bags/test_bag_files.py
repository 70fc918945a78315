# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags as files: definitions, writing, reading, and what is left of one that was cut off or damaged anywhere."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import Reader, StoragePlugin, Writer

from acts_core.errors import RecordingError
from acts_ros.bags import qos
from acts_ros.bags.message_types import Definitions, message_class
from acts_ros.bags.reading import open_bag
from acts_ros.bags.rosbag2_format import McapFile
from acts_ros.bags.writing import BagWriter

pytestmark = pytest.mark.slow

PER_CHUNK = 5


def offer(
    reliability: QosReliability = QosReliability.RELIABLE,
    durability: QosDurability = QosDurability.VOLATILE,
    depth: int = 0,
) -> Qos:
    forever = QosTime(*divmod(Duration(nanoseconds=2**63 - 1).nanoseconds, 10**9))
    return Qos(
        QosHistory.UNKNOWN, depth, reliability, durability, forever, forever, QosLiveliness.AUTOMATIC, forever, False
    )


def write_bag(path: Path, count: int, close: bool = True, sizes: list[int] | None = None) -> list[bytes]:
    """A bag of one topic, in chunks of `PER_CHUNK` messages; `sizes` gets the file's size after each."""
    bag = BagWriter(path)
    definition, type_hash = Definitions().describe("std_msgs/msg/String")
    topic = bag.add_topic("/word", "std_msgs/msg/String", definition, type_hash, [offer()])
    messages = [bytes([index]) * 40 for index in range(count)]
    for index, message in enumerate(messages):
        bag.write(topic, message)
        if (index + 1) % PER_CHUNK == 0:
            bag.flush()
            if sizes is not None:
                sizes.append(bag.size_bytes())
    bag.flush()
    if close:
        bag.close()
    return messages


def read(path: Path, topics: Sequence[str] = ("/word",)) -> list[bytes]:
    with open_bag(path) as bag:
        return [data for _, _, data in bag.messages(topics)]


@pytest.mark.parametrize(
    "name",
    [
        *(f"acts_msgs/msg/{path.stem}" for path in Path(get_package_share_directory("acts_msgs"), "msg").glob("*.msg")),
        "sensor_msgs/msg/Image",
        "diagnostic_msgs/msg/DiagnosticArray",
        "std_msgs/msg/Char",
    ],
)
def test_definitions_are_complete_and_hashes_are_those_of_the_built_package(name: str) -> None:
    definition, type_hash = Definitions().describe(name)
    package, kind, short = name.split("/")
    described = json.loads((Path(get_package_share_directory(package)) / kind / f"{short}.json").read_text())
    assert {"type_name": name, "hash_string": type_hash} in described["type_hashes"]
    for entry in described["type_hashes"][1:]:
        package, _, short = entry["type_name"].split("/")
        assert f"MSG: {package}/{short}" in definition or f"MSG: {entry['type_name']}" in definition


@pytest.mark.parametrize("name", ["no_such_package/msg/Thing", "std_msgs/msg/Thing", "std_msgs"])
def test_unknown_types_are_named(name: str) -> None:
    with pytest.raises(RecordingError, match=f"'{name}'"):
        message_class(name)
    with pytest.raises(RecordingError, match=f"'{name}'"):
        Definitions().describe(name)


def test_a_type_without_a_definition_is_refused_however_often_it_is_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As for each of its topics: a package may have its types in IDL only."""
    index = tmp_path / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "fake_msgs").touch()
    types = tmp_path / "share/fake_msgs/msg"
    types.mkdir(parents=True)
    (types / "Outer.msg").write_text("Inner inner\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(tmp_path), os.environ["AMENT_PREFIX_PATH"]]))
    definitions = Definitions()
    for name in ("fake_msgs/msg/Outer", "fake_msgs/msg/Inner"):
        for _ in range(2):
            with pytest.raises(RecordingError, match="no definition of message type 'fake_msgs/msg/Inner'"):
                definitions.describe(name)
    (types / "Inner.msg").write_text("int32 number\n")
    assert "MSG: fake_msgs/Inner" in definitions.describe("fake_msgs/msg/Outer")[0]


def test_a_library_of_another_version_is_refused_with_the_one_that_is_needed(tmp_path: Path) -> None:
    (tmp_path / "rosbags").mkdir()
    (tmp_path / "rosbags/__init__.py").touch()
    (tmp_path / "rosbags/interfaces.py").touch()
    done = subprocess.run(
        [sys.executable, "-c", "from acts_ros.bags import require_rosbags; require_rosbags()"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), os.environ["PYTHONPATH"]])},
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    told = done.stderr.splitlines()[-1]
    assert told.startswith("acts_core.errors.RecordingError: the Python package rosbags is of another version, or not ")
    assert told.endswith(". Install it with: pip install rosbags==0.11.9")


def test_a_bag_is_read_back_by_us_and_by_rosbags(tmp_path: Path) -> None:
    messages = write_bag(tmp_path / "bag", 12)
    assert read(tmp_path / "bag") == messages
    assert read(tmp_path / "bag/bag.mcap") == messages
    with Reader(tmp_path / "bag") as reader:
        assert [bytes(data) for _, _, data in reader.messages()] == messages
        assert reader.connections[0].ext.offered_qos_profiles == [offer()]
    with open_bag(tmp_path / "bag") as bag:
        assert bag.note is None
        assert bag.topics() == {"/word": "std_msgs/msg/String"}


def test_a_bag_without_messages_is_a_bag(tmp_path: Path) -> None:
    BagWriter(tmp_path / "bag").close()
    assert read(tmp_path / "bag") == []
    assert "nanoseconds_since_epoch: 0" in (tmp_path / "bag/metadata.yaml").read_text()


def test_an_existing_folder_is_not_touched(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    with pytest.raises(RecordingError, match="exists already"):
        BagWriter(tmp_path / "bag")
    assert not list((tmp_path / "bag").iterdir())


def test_a_folder_that_cannot_be_made_is_told_in_words(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(
        RecordingError, match=r"cannot make the bag '.*/file/bag' \(Not a directory\); needed is a new name"
    ):
        BagWriter(tmp_path / "file" / "bag")


def test_stamps_do_not_go_back_with_the_clock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([1_000, 3_000, 2_000, 4_000])
    monkeypatch.setattr(time, "time_ns", lambda: next(clock))
    write_bag(tmp_path / "bag", 4)
    with open_bag(tmp_path / "bag") as bag:
        assert [stamp for _, stamp, _ in bag.messages(["/word"])] == [1_000, 3_000, 3_000, 4_000]


def test_stamps_go_on_after_the_clock_was_set_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Set back by an hour at 3602 s, adjusted by 1 ms, set back again, and right again.
    clock_ms = [3_600_000, 3_602_000, 2_000, 2_500, 2_499, 3_500, 1_000, 1_250, 3_700_000, 3_700_500]
    clock = iter(now_ms * 10**6 for now_ms in clock_ms)
    monkeypatch.setattr(time, "time_ns", lambda: next(clock))
    write_bag(tmp_path / "bag", len(clock_ms))
    with open_bag(tmp_path / "bag") as bag:
        stamps_ms = [stamp // 10**6 for _, stamp, _ in bag.messages(["/word"])]
    expected = [3_600_000, 3_602_000, 3_602_000, 3_602_500, 3_602_500, 3_603_500, 3_603_500, 3_603_750]
    assert stamps_ms == [*expected, 3_700_000, 3_700_500]


def test_a_disk_that_is_full_is_reported_once_and_nothing_more_is_tried(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    definition, type_hash = Definitions().describe("std_msgs/msg/String")
    topic = bag.add_topic("/word", "std_msgs/msg/String", definition, type_hash, [])
    storage = bag._writer.storage
    assert isinstance(storage, McapFile)
    bag.write(topic, b"1234")
    bag.flush()
    kept = (tmp_path / "bag/bag.mcap").read_bytes()
    full = os.open("/dev/full", os.O_WRONLY)
    os.dup2(full, storage.bio.fileno())
    os.close(full)
    bag.write(topic, b"5678")
    with pytest.raises(RecordingError, match=r"cannot write to the bag .*: No space left on device") as first:
        bag.flush()
    # A message that comes on the way out.
    with pytest.raises(RecordingError) as second:
        bag.write(topic, b"9")
    assert second.value is first.value
    bag.close()
    # Otherwise Python writes the rest of it at its own end, and tells on standard error that it could not.
    assert storage.bio.closed
    assert (tmp_path / "bag/bag.mcap").read_bytes() == kept
    assert read(tmp_path / "bag") == [b"1234"]


def test_what_was_flushed_is_read_from_a_bag_that_was_never_closed(tmp_path: Path) -> None:
    messages = write_bag(tmp_path / "bag", 12, close=False)
    assert not (tmp_path / "bag/metadata.yaml").exists()
    with open_bag(tmp_path / "bag") as bag:
        assert bag.note is not None
        assert "never closed" in bag.note
    assert read(tmp_path / "bag") == messages


def test_before_a_large_bag_that_was_never_closed_is_read_it_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_bag(tmp_path / "closed", 12)
    write_bag(tmp_path / "small", 12, close=False)
    write_bag(tmp_path / "large", 12, close=False)
    read(tmp_path / "small")
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("acts_ros.bags.reading._SILENT_BYTES_MAX", 1000)
    for path in ("closed", "large", "large"):
        assert len(read(tmp_path / path)) == 12
    assert capsys.readouterr().err == f"reading all 0 MB of '{tmp_path}/large', which has no index\n"


@settings(deadline=None)
@given(share=st.floats(0.0, 1.0))
def test_a_bag_cut_off_anywhere_gives_its_whole_chunks_or_a_clear_error(share: float) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag/bag.mcap"
        sizes: list[int] = []
        messages = write_bag(path.parent, 20, sizes=sizes)
        cut = int(share * path.stat().st_size)
        with path.open("r+b") as file:
            file.truncate(cut)
        whole_chunks = sum(size <= cut for size in sizes)
        try:
            got = read(path.parent)
        except RecordingError:
            assert whole_chunks == 0
        else:
            assert got == messages[: len(got)]
            assert len(got) in (whole_chunks * PER_CHUNK, (whole_chunks + 1) * PER_CHUNK)


@settings(deadline=None)
@given(zeros=st.integers(1, 1500) | st.integers(1500, 2600))
def test_a_bag_whose_end_the_disk_has_lost_gives_its_whole_chunks_or_a_clear_error(zeros: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag/bag.mcap"
        sizes: list[int] = []
        messages = write_bag(path.parent, 20, close=False, sizes=sizes)
        data = bytearray(path.read_bytes())
        kept = max(0, len(data) - zeros)
        data[kept:] = bytes(len(data) - kept)
        path.write_bytes(data)
        whole_chunks = sum(size <= kept for size in sizes)
        try:
            with open_bag(path.parent) as bag:
                got = [message for _, _, message in bag.messages(["/word"])]
                assert bag.note is not None
                # The last bytes of an index, which is not needed, may be zeros anyway.
                assert len(got) == 20 or re.search(r"not read: bag.mcap from byte \d+ on: ", bag.note)
        except RecordingError:
            assert whole_chunks == 0
        else:
            assert got == messages[: len(got)]
            assert len(got) in (whole_chunks * PER_CHUNK, (whole_chunks + 1) * PER_CHUNK)


def test_what_comes_before_damage_is_read_before_the_error(tmp_path: Path) -> None:
    messages = write_bag(tmp_path / "bag", 20)
    path = tmp_path / "bag/bag.mcap"
    data = bytearray(path.read_bytes())
    start = data.index(messages[12]) - 31
    data[start : start + 9] = b"\x05" + (2**40).to_bytes(8, "little")  # a message record of a terabyte
    path.write_bytes(data)
    got = []
    with open_bag(tmp_path / "bag") as bag, pytest.raises(RecordingError, match="damaged"):  # noqa: PT012
        for _, _, message in bag.messages(["/word"]):
            got.append(message)
    assert got[:10] == messages[:10]


@settings(deadline=None)
@given(share=st.floats(0.0, 1.0, exclude_max=True), bit=st.integers(0, 7), close=st.booleans())
def test_a_bit_that_is_wrong_in_a_chunk_is_no_message(share: float, bit: int, close: bool) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bag/bag.mcap"
        messages = write_bag(path.parent, 20, close=close)
        data = bytearray(path.read_bytes())
        begin, end = data.index(messages[10]) - 31, data.index(messages[14]) + len(messages[14])
        data[begin + int(share * (end - begin))] ^= 1 << bit
        path.write_bytes(data)
        got: list[bytes] = []
        said = None
        try:
            with open_bag(path.parent) as bag:
                said = bag.note
                got.extend(data for _, _, data in bag.messages(["/word"]))
        except RecordingError as error:
            said = str(error)
        assert said is not None
        assert re.search(f"{path.parent}.*Chunk checksum mismatch", said)
        assert got == messages[:10]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("missing", None, "there is no bag"),
        ("text.mcap", b"no bag at all", "not an MCAP file"),
        ("empty.mcap", b"", "not an MCAP file"),
    ],
)
def test_what_is_no_bag_is_refused(tmp_path: Path, name: str, content: bytes | None, message: str) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(RecordingError, match=f"{message}.*; give the folder that `acts record`"):
        read(tmp_path / name)


def test_files_without_an_end_or_a_beginning_are_refused(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", 5)
    os.mkfifo(tmp_path / "pipe.mcap")
    with pytest.raises(RecordingError, match=r"pipe.mcap: not a regular file"):
        read(tmp_path / "pipe.mcap")
    (tmp_path / "bag/metadata.yaml").unlink()
    (tmp_path / "bag/metadata.yaml").symlink_to("/dev/zero")
    with pytest.raises(RecordingError, match=r"metadata.yaml: not a regular file"):
        read(tmp_path / "bag")
    (tmp_path / "bag/metadata.yaml").unlink()
    (tmp_path / "bag/metadata.yaml").write_bytes(b" " * 2_000_000)
    with pytest.raises(RecordingError, match=r"metadata.yaml: 2.0 MB; allowed are 1.0 MB"):
        read(tmp_path / "bag")


def test_what_else_lies_in_the_folder_of_a_bag_is_passed_over(tmp_path: Path) -> None:
    messages = write_bag(tmp_path / "bag", 5)
    for name in ("table", "packed.zstd"):
        (tmp_path / "bag" / name).mkdir()
    (tmp_path / "bag/.#metadata.yaml").symlink_to("somebody@somewhere.1234:5678")
    assert read(tmp_path / "bag") == messages
    (tmp_path / "bag/more.mcap").mkdir()
    with pytest.raises(RecordingError, match=r"more.mcap: not a regular file"):
        read(tmp_path / "bag")


def test_a_chunk_that_unpacks_to_gigabytes_is_refused(tmp_path: Path) -> None:
    with Writer(tmp_path / "bomb", version=8, storage_plugin=StoragePlugin.MCAP) as writer:
        topic = writer.add_connection("/word", "std_msgs/msg/String", msgdef="string data", rihs01="RIHS01_0")
        writer.write(topic, 0, b"1234")
    path = tmp_path / "bomb/bomb.mcap"
    data = bytearray(path.read_bytes())
    at = 8 + 9 + int.from_bytes(data[9:17], "little")  # after the header comes the chunk: kind, length, two times
    assert data[at] == 0x06
    data[at + 25 : at + 33] = (10**10).to_bytes(8, "little")
    path.write_bytes(data)
    with pytest.raises(RecordingError, match="a chunk of 10000 MB unpacked; allowed are 268 MB"):
        read(tmp_path / "bomb")


def test_a_folder_without_a_bag_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="holds no bag that can be read"):
        read(tmp_path)


def test_topics_are_published_as_they_were_offered() -> None:
    stream = qos.for_publisher([offer(QosReliability.BEST_EFFORT)])
    assert (stream.reliability, stream.durability) == (ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)
    assert stream.depth == 256
    latched = qos.for_publisher([offer(durability=QosDurability.TRANSIENT_LOCAL)])
    assert (latched.reliability, latched.durability) == (ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)
    assert latched.depth == 1
    assert qos.for_publisher([offer(depth=1000)]).depth == 1000
    assert qos.for_publisher([]).reliability == ReliabilityPolicy.RELIABLE
