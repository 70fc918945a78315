# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording over real DDS. ROS_DOMAIN_IDs 84 to 87 and 190."""

from __future__ import annotations

import random
import re
import signal
import time
from array import array
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from bag_commands import TIMEOUT_S, acts
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from std_msgs.msg import String

from acts_core.errors import RecordingError
from acts_msgs.msg import Contact, TactileSamples
from acts_ros.bags import qos
from acts_ros.bags import recorder as recorder_module
from acts_ros.bags.message_types import message_class
from acts_ros.bags.reading import open_bag
from acts_ros.bags.recorder import Recorder
from acts_ros.bags.writing import BagWriter
from acts_ros.clocks import boot_time_s
from acts_ros.qos import LATCHED, STREAM
from acts_tools.bags.player import Player
from acts_tools.bags.record import summarise
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

BEYOND_ALL_DOMAINS = 300


def subscribed(probe: Probe, publishers: list[Publisher]) -> None:
    probe.wait_for(
        lambda: all(publisher.get_subscription_count() > 0 for publisher in publishers), TIMEOUT_S, "the recorder"
    )


def contents(path: Path) -> list[tuple[str, bytes]]:
    with open_bag(path) as bag:
        return [(topic, data) for topic, _, data in bag.messages(list(bag.topics()))]


def test_topics_are_recorded_without_loss_and_read_back_by_rosbags(tmp_path: Path) -> None:
    path, count = tmp_path / "touch", 300
    # Reliable: that a busy machine drops a best-effort message would be no fault of the recorder.
    reliable = QoSProfile(depth=count)
    with Probe(84) as probe, acts("record", "-o", str(path), "-a", domain_id=84) as process:
        samples = probe.node.create_publisher(TactileSamples, "/plate/samples", reliable)
        contact = probe.node.create_publisher(Contact, "/plate/contact", reliable)
        stream = probe.node.create_publisher(Contact, "/palm/contact", STREAM)
        hidden = probe.node.create_publisher(String, "/_hidden/topic", reliable)
        subscribed(probe, [samples, contact, stream])
        message = TactileSamples(indices=array("H", [3, 5]), counts=array("H", [30, 50]))
        for number in range(count):
            message.sequence = number
            samples.publish(message)
            contact.publish(Contact(sequence=number))
            hidden.publish(String())
        stream.publish(Contact())
        probe.wait_for(lambda: _on_disk(path, 2 * count), TIMEOUT_S, "the messages on the disk")
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=TIMEOUT_S)
        assert process.returncode == 0, output
    for topic in ("/plate/samples", "/plate/contact"):
        assert re.search(rf"{topic} +{count} messages +0 lost", output), output
    assert "_hidden" not in output
    # As somebody sees it who has only the bag.
    store = get_typestore(Stores.EMPTY)
    numbers: dict[str, list[int]] = {"/plate/samples": [], "/plate/contact": []}
    with Reader(path) as reader:
        offered = {connection.topic: connection.ext.offered_qos_profiles[0] for connection in reader.connections}
        assert offered["/plate/samples"].reliability.name == "RELIABLE"
        assert offered["/palm/contact"].reliability.name == "BEST_EFFORT"
        for connection, _, data in reader.messages():
            if connection.msgtype not in store.fielddefs:
                types = get_types_from_msg(connection.msgdef.data, connection.msgtype)
                store.register({name: value for name, value in types.items() if name not in store.fielddefs})
            if connection.topic in numbers:
                read: Any = store.deserialize_cdr(data, connection.msgtype)
                numbers[connection.topic].append(read.sequence)
                if connection.topic == "/plate/samples":
                    assert list(read.counts) == [30, 50]
    assert numbers == {"/plate/samples": list(range(count)), "/plate/contact": list(range(count))}


def _on_disk(path: Path, count: int) -> bool:
    """Whether so many messages of our own can be read while the recorder goes on."""
    try:
        return sum(1 for topic, _ in contents(path) if topic.startswith("/plate")) >= count
    except RecordingError:
        return False


def test_a_recorder_killed_at_any_moment_leaves_all_but_the_last_second(tmp_path: Path) -> None:
    path = tmp_path / "touch"
    published_s: list[float] = []
    reliable = QoSProfile(depth=1000)
    with Probe(85) as probe, acts("record", "-o", str(path), "plate/contact", domain_id=85) as process:
        publisher = probe.node.create_publisher(Contact, "/plate/contact", reliable)
        subscribed(probe, [publisher])
        end_s = time.monotonic() + random.uniform(1.2, 2.2)  # another moment in every run
        while time.monotonic() < end_s:
            publisher.publish(Contact(sequence=len(published_s)))
            published_s.append(time.monotonic())
            time.sleep(0.002)
        process.kill()
        killed_s = time.monotonic()
        process.wait()
    assert not (path / "metadata.yaml").exists()
    numbers = [deserialize_message(data, Contact).sequence for _, data in contents(path)]
    assert numbers == list(range(len(numbers)))
    assert len(numbers) >= sum(stamp_s < killed_s - 1.0 for stamp_s in published_s) > 0
    with acts("play", str(path), "--delay", "0", "--rate", "100", domain_id=85) as player:
        output, _ = player.communicate(timeout=TIMEOUT_S)
    assert player.returncode == 0
    assert "was never closed" in output
    assert f"{len(numbers)} messages" in output


def test_a_topic_that_never_appears_is_named_once_and_the_exit_code_tells(tmp_path: Path) -> None:
    with acts("record", "-o", str(tmp_path / "bag"), "-d", "0.5", "/never", "never", domain_id=86) as process:
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert output.count("never appeared: /never, no publisher was found") == 1
    assert "nothing was recorded; the bag is empty" in output
    assert contents(tmp_path / "bag") == []


def test_a_topic_of_which_nothing_came_is_named_and_the_exit_code_tells(tmp_path: Path) -> None:
    with Probe(190) as probe:
        silent = probe.node.create_publisher(Contact, "/silent", STREAM)
        with acts("record", "-o", str(tmp_path / "bag"), "/silent", domain_id=190) as process:
            subscribed(probe, [silent])
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert "no message: /silent had a publisher, but nothing came" in output
    assert "nothing was recorded; the bag is empty" in output


def test_a_topic_that_ended_before_the_recording_is_named(tmp_path: Path) -> None:
    path = tmp_path / "touch"
    words = ("record", "-o", str(path), "/plate/contact", "/palm/contact")
    with Probe(84) as probe, acts(*words, domain_id=84) as process:
        ends = probe.node.create_publisher(Contact, "/plate/contact", QoSProfile(depth=100))
        goes_on = probe.node.create_publisher(Contact, "/palm/contact", QoSProfile(depth=100))
        subscribed(probe, [ends, goes_on])
        for _ in range(50):
            ends.publish(Contact())
        silent_from_s = time.monotonic()

        def silent_long_enough() -> bool:
            goes_on.publish(Contact())
            return time.monotonic() > silent_from_s + 2.0

        probe.wait_for(silent_long_enough, TIMEOUT_S, "two seconds to pass")
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 0, output
    assert re.search(r"ended before: /plate/contact came regularly, but not in the last [0-9.]+ s", output), output
    assert "ended before: /palm/contact" not in output


def test_a_topic_that_paused_amid_the_recording_is_named(tmp_path: Path) -> None:
    with Probe(84) as probe, acts("record", "-o", str(tmp_path / "bag"), "/plate/contact", domain_id=84) as process:
        publisher = probe.node.create_publisher(Contact, "/plate/contact", QoSProfile(depth=100))
        subscribed(probe, [publisher])
        empty = bag_size(tmp_path / "bag")
        for _ in range(50):
            publisher.publish(Contact())
        probe.wait_for(lambda: bag_size(tmp_path / "bag") > empty, TIMEOUT_S, "the messages before the pause")
        silent_from_s = time.monotonic()
        probe.wait_for(lambda: time.monotonic() > silent_from_s + 2.0, TIMEOUT_S, "two seconds to pass")
        recorded = bag_size(tmp_path / "bag")
        for _ in range(50):
            publisher.publish(Contact())
        probe.wait_for(lambda: bag_size(tmp_path / "bag") > recorded, TIMEOUT_S, "the messages after the pause")
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 0, output
    assert re.search(r"paused: no message for [0-9.]+ s from /plate/contact, [0-9.]+ s after the start\n", output), (
        output
    )


def bag_size(path: Path) -> int:
    """Bytes that the recorder has written so far."""
    return sum(file.stat().st_size for file in path.iterdir())


def test_a_recording_of_all_topics_without_any_message_is_no_success(tmp_path: Path) -> None:
    with acts("record", "-o", str(tmp_path / "bag"), "-d", "0.5", "-a", domain_id=190) as process:
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert "nothing was recorded; the bag is empty" in output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["record"], "say which topics"),
        (["record", "-a", "/x"], "say which topics"),
        (["record", "-a", "-o", "{here}"], "exists already"),
        (["play", "{here}/no"], "there is no bag"),
    ],
)
def test_wrong_words_are_refused_in_one_line(tmp_path: Path, words: list[str], message: str) -> None:
    with acts(*(word.format(here=tmp_path) for word in words), domain_id=86) as process:
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert output.startswith("error: ")
    assert output.count("\n") == 1
    assert message in output


def test_a_recording_that_cannot_begin_leaves_nothing_behind(tmp_path: Path) -> None:
    with acts("record", "-o", str(tmp_path / "bag"), "-a", domain_id=BEYOND_ALL_DOMAINS) as process:
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert "ROS_DOMAIN_ID" in output
    assert not (tmp_path / "bag").exists()


@pytest.fixture
def probe() -> Iterator[Probe]:
    with Probe(87) as made:
        yield made


def record_here(probe: Probe, path: Path, topics: list[str] | None, until: Callable[[Recorder], bool]) -> list[str]:
    """Record in this process until a condition holds; what the recorder said."""
    said: list[str] = []
    bag = BagWriter(path)
    recorder = Recorder(probe.node, bag, topics, said.append)

    def holds() -> bool:
        recorder.discover()
        return until(recorder)

    probe.wait_for(holds, TIMEOUT_S, "the recording")
    recorder.close()
    bag.close()
    return said


def test_an_unknown_type_is_named_and_the_other_topics_are_recorded(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forgetful(name: str) -> type:
        if name == "acts_msgs/msg/Contact":
            raise RecordingError(f"unknown message type '{name}'")
        return message_class(name)

    monkeypatch.setattr(recorder_module, "message_class", forgetful)
    probe.node.create_publisher(Contact, "/strange", STREAM)
    words = probe.node.create_publisher(String, "/word", STREAM)

    def until(recorder: Recorder) -> bool:
        words.publish(String(data="x"))
        return "/word" in recorder.records and recorder.records["/word"].received > 3 and bool(recorder.refused())

    said = record_here(probe, tmp_path / "bag", ["/strange", "/word"], until)
    assert said.count("not recorded: /strange: unknown message type 'acts_msgs/msg/Contact'") == 1
    assert {topic for topic, _ in contents(tmp_path / "bag")} == {"/word"}


def test_kept_messages_are_recorded_and_kept_when_played(probe: Probe, tmp_path: Path) -> None:
    publisher = probe.node.create_publisher(String, "/settings", LATCHED)
    publisher.publish(String(data="kept"))
    record_here(
        probe,
        tmp_path / "bag",
        ["/settings"],
        lambda recorder: bool(recorder.records) and recorder.records["/settings"].received == 1,
    )
    probe.node.destroy_publisher(publisher)
    probe.wait_for(lambda: probe.node.count_publishers("/settings") == 0, TIMEOUT_S, "the publisher's end")
    with open_bag(tmp_path / "bag") as bag:
        Player(probe.node, bag, None, print).play(1.0, lambda _deadline_s: True)
        # Subscribed to only after it was played.
        assert probe.wait_for_message("/settings", String).data == "kept"


def test_a_weaker_publisher_that_comes_later_is_recorded_too(probe: Probe, tmp_path: Path) -> None:
    reliable = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.VOLATILE)
    publishers = [probe.node.create_publisher(String, "/word", reliable)]
    heard: list[int] = []

    def until(recorder: Recorder) -> bool:
        publishers[-1].publish(String(data=str(len(publishers))))
        if "/word" not in recorder.records:
            return False
        if len(publishers) == 1 and recorder.records["/word"].received > 3:
            publishers.append(probe.node.create_publisher(String, "/word", STREAM))
            heard.append(recorder.records["/word"].received)
        # What the first one sent may still arrive; this is more than that.
        return bool(heard) and recorder.records["/word"].received > heard[0] + 20

    record_here(probe, tmp_path / "bag", None, until)
    assert any(b"2\0" in data for topic, data in contents(tmp_path / "bag") if topic == "/word")


def test_messages_that_were_not_taken_in_time_are_missing_by_their_numbers(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As while a slow disk holds up the recorder: the middleware reports nothing of what falls out of its queue."""
    monkeypatch.setattr(qos, "_SUBSCRIPTION_DEPTH", 16)
    publisher = probe.node.create_publisher(Contact, "/plate/contact", QoSProfile(depth=200))
    with closing(BagWriter(tmp_path / "bag")) as bag:
        recorder = Recorder(probe.node, bag, ["/plate/contact"], print)

        def is_matched() -> bool:
            recorder.discover()
            return publisher.get_subscription_count() > 0

        probe.wait_for(is_matched, TIMEOUT_S, "the recorder")
        record = recorder.records["/plate/contact"]
        publisher.publish(Contact(sequence=0))
        probe.wait_for(lambda: record.received == 1, TIMEOUT_S, "the first message")
        for number in range(1, 101):
            publisher.publish(Contact(sequence=number))
        probe.wait_for(lambda: record.received + (record.missing or 0) == 101, TIMEOUT_S, "the last message")
        assert record.received < 101
        summarise(recorder, bag, {}, boot_time_s(), boot_time_s())
    words = rf"/plate/contact +{record.received} messages .*, {101 - record.received} frames missing by their numbers"
    assert re.search(words, capsys.readouterr().out)
