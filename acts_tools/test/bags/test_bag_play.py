# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Playing over real DDS. ROS_DOMAIN_IDs 88 and 194."""

from __future__ import annotations

import re
import signal
from collections.abc import Iterator
from contextlib import closing
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest
from bag_commands import TIMEOUT_S, acts
from bag_of_strings import make_bag
from rclpy.duration import Duration
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin, Writer
from std_msgs.msg import Int32, String

from acts_core.errors import RecordingError
from acts_ros.bags import qos
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.reading import open_bag
from acts_ros.bags.writing import BagWriter
from acts_ros.qos import LATCHED
from acts_tools.bags.player import Player
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow


@pytest.fixture
def probe() -> Iterator[Probe]:
    with Probe(194) as made:
        yield made


def noted(deadlines: list[float], deadline_s: float) -> bool:
    deadlines.append(deadline_s)
    return True


def test_messages_are_played_at_their_times_by_absolute_deadlines(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_bag(tmp_path / "bag", {"/a": "std_msgs/msg/String"}, [1000, 1010, 1200, 1201], monkeypatch)
    deadlines: list[float] = []
    with open_bag(tmp_path / "bag") as bag:
        player = Player(probe.node, bag, ["/a"], print)

        def sleep_until(deadline_s: float) -> bool:
            deadlines.append(deadline_s)
            return len(deadlines) < 8

        assert player.play(2.0, sleep_until)
        assert [round((deadline - deadlines[0]) * 1e3, 3) for deadline in deadlines] == [0.0, 5.0, 100.0, 100.5]
        assert player.report.published == 4
        assert not player.play(2.0, sleep_until)  # told to stop before the last one
        assert player.report.published == 7


def test_a_topic_that_is_named_twice_has_one_publisher(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_bag(tmp_path / "bag", {"/twice": "std_msgs/msg/String"}, [1000], monkeypatch)
    with open_bag(tmp_path / "bag") as bag:
        Player(probe.node, bag, ["/twice", "/twice"], print)
    assert [publisher.topic for publisher in probe.node.publishers].count("/twice") == 1


def test_a_pause_is_told(probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # As of a robot whose clock began in 1970, and was set while it recorded.
    make_bag(tmp_path / "bag", {"/a": "std_msgs/msg/String"}, [1000, 6000, 1_600_000_000_000], monkeypatch)
    told: list[str] = []
    with open_bag(tmp_path / "bag") as bag:
        assert Player(probe.node, bag, ["/a"], told.append).play(1.0, lambda deadline_s: True)
    (words,) = told
    assert re.match(r"paused: the next message is due in 1\d{9} s, 1599999999 s after the first; ", words)


def test_what_follows_a_clock_that_was_set_back_is_played_at_its_pace(probe: Probe, tmp_path: Path) -> None:
    definition, type_hash = Definitions().describe("std_msgs/msg/String")
    with Writer(tmp_path / "bag", version=8, storage_plugin=StoragePlugin.MCAP) as writer:
        topic = writer.add_connection("/a", "std_msgs/msg/String", msgdef=definition, rihs01=type_hash)
        for time_ms in (100_000, 100_500, 40_000, 40_300):
            writer.write(topic, time_ms * 1_000_000, serialize_message(String(data="a")))
    deadlines: list[float] = []
    with open_bag(tmp_path / "bag") as bag:
        assert Player(probe.node, bag, ["/a"], print).play(1.0, partial(noted, deadlines))
    assert [round(deadline - deadlines[0], 3) for deadline in deadlines] == [0.0, 0.5, 0.5, 0.8]


def test_subscribers_that_hang_do_not_hold_up_the_end_topic_by_topic(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s = 100.0

    class Unheard:
        """A publisher whose subscriber hangs."""

        def wait_for_all_acked(self, timeout: Duration) -> bool:
            nonlocal now_s
            now_s += timeout.nanoseconds * 1e-9
            return False

    topics = {f"/topic_{number}": "std_msgs/msg/String" for number in range(20)}
    make_bag(tmp_path / "bag", topics, [1000 + number for number in range(20)], monkeypatch)
    with open_bag(tmp_path / "bag") as bag:
        player = Player(probe.node, bag, None, print)
        monkeypatch.setattr(player, "_publishers", dict.fromkeys(topics, Unheard()))
        monkeypatch.setattr("acts_tools.bags.player.time", SimpleNamespace(monotonic=lambda: now_s))
        player.finish()
    assert now_s - 100.0 == pytest.approx(1.0)


def test_a_topic_of_several_types_is_named_and_the_others_are_played(probe: Probe, tmp_path: Path) -> None:
    """As in a bag that two were merged into."""
    data = serialize_message(String(data="a text that is longer than any number"))
    with closing(BagWriter(tmp_path / "bag")) as bag:
        for topic, kind in (("/b", "std_msgs/msg/String"), ("/a", "std_msgs/msg/String"), ("/a", "std_msgs/msg/Int32")):
            handle = bag.add_topic(topic, kind, *Definitions().describe(kind), [])
            bag.write(handle, data if kind == "std_msgs/msg/String" else serialize_message(Int32(data=5)))
    said: list[str] = []
    with open_bag(tmp_path / "bag") as opened:
        player = Player(probe.node, opened, None, said.append)
        assert player.play(1.0, lambda deadline_s: True)
    assert player.report.published == 1
    assert said == ["not played: /a: it was recorded with several types: std_msgs/msg/Int32, std_msgs/msg/String"]


@pytest.mark.parametrize("is_unfinished", [False, True])
@pytest.mark.parametrize(("topic", "between_ms"), [("/a", 11), ("/b", 10)])
def test_it_begins_at_an_offset_from_the_beginning_of_the_bag(
    probe: Probe,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    is_unfinished: bool,
    topic: str,
    between_ms: int,
) -> None:
    topics = {"/a": "std_msgs/msg/String", "/b": "std_msgs/msg/String"}
    make_bag(tmp_path / "bag", topics, [1000, 1010, 1020, 1030, 1031, 1040], monkeypatch)
    if is_unfinished:
        (tmp_path / "bag" / "metadata.yaml").unlink()
    with open_bag(tmp_path / "bag") as bag:
        player = Player(probe.node, bag, [topic], print, 0.015)
        for turn in (1, 2):  # a loop begins there each time
            deadlines: list[float] = []
            assert player.play(1.0, partial(noted, deadlines))
            assert player.report.published == 2 * turn
            assert deadlines[1] - deadlines[0] == pytest.approx(between_ms * 1e-3)


@pytest.mark.parametrize("is_unfinished", [False, True])
@pytest.mark.parametrize("offset_s", [0.0401, 1e9, 1e300])
def test_an_offset_beyond_the_end_is_refused_with_the_length(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_unfinished: bool, offset_s: float
) -> None:
    topics = {"/a": "std_msgs/msg/String", "/b": "std_msgs/msg/String"}
    make_bag(tmp_path / "bag", topics, [1000, 1010, 1031, 1040], monkeypatch)
    if is_unfinished:
        (tmp_path / "bag" / "metadata.yaml").unlink()
    with open_bag(tmp_path / "bag") as bag:
        with pytest.raises(RecordingError, match=r"after the bag's beginning: it is 0\.040 s long") as caught:
            Player(probe.node, bag, None, print, offset_s)
        assert f"nothing to play {offset_s:g} s" in str(caught.value)
        # The bag goes on, but this topic does not.
        with pytest.raises(RecordingError, match="the topics to play are /a; give a smaller offset"):
            Player(probe.node, bag, ["/a"], print, 0.035)


def test_who_joins_late_gets_what_each_of_several_publishers_had_kept(probe: Probe, tmp_path: Path) -> None:
    """As /tf_static of two robots, or the baselines of two drivers."""
    kept = qos.to_bag([LATCHED, LATCHED])
    assert [profile.depth for profile in kept] == [1, 1]
    bag = BagWriter(tmp_path / "bag")
    topic = bag.add_topic("/kept", "std_msgs/msg/String", *Definitions().describe("std_msgs/msg/String"), kept)
    for word in ("a", "b"):
        bag.write(topic, serialize_message(String(data=word)))
    bag.close()
    with open_bag(tmp_path / "bag") as opened:
        assert Player(probe.node, opened, None, print).play(1.0, lambda _deadline_s: True)
    heard = probe.wait_for_messages("/kept", String, 2, TIMEOUT_S)
    assert [message.data for message in heard] == ["a", "b"]
    assert qos.for_publisher(kept, 5000).depth == 1000


def test_unknown_topics_and_types_are_refused_or_left_out(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_bag(tmp_path / "bag", {"/a": "std_msgs/msg/String", "/b": "gone_msgs/msg/Gone"}, [1, 2, 3, 4], monkeypatch)
    said: list[str] = []
    with open_bag(tmp_path / "bag") as bag:
        with pytest.raises(RecordingError, match=r"no topic '/c' \(it has: /a, /b\)"):
            Player(probe.node, bag, ["/c"], print)
        with pytest.raises(RecordingError, match="no topic that can be played"):
            Player(probe.node, bag, ["/b"], print)
        player = Player(probe.node, bag, None, said.append)
        assert player.play(1.0, lambda _deadline_s: True)
        assert player.report.published == 2
    assert len(said) == 1
    assert said[0].startswith("not played: /b: unknown message type 'gone_msgs/msg/Gone'")


@pytest.mark.parametrize(
    ("definition", "message"),
    [
        ("string data\nuint32 number", "/a was recorded with another definition of std_msgs/msg/String"),
        ("no definition at all", "the recorded definition of std_msgs/msg/String cannot be read"),
        ("", "/a was recorded with another definition of std_msgs/msg/String"),
    ],
)
def test_messages_of_another_definition_are_not_played(
    probe: Probe, tmp_path: Path, definition: str, message: str
) -> None:
    bag = BagWriter(tmp_path / "bag")
    changed = bag.add_topic("/a", "std_msgs/msg/String", definition, "RIHS01_0", [])
    same = bag.add_topic("/b", "std_msgs/msg/Empty", *Definitions().describe("std_msgs/msg/Empty"), [])
    bag.write(changed, b"\0\1\0\0\1\0\0\0\0")
    bag.write(same, b"\0\1\0\0\0")
    bag.close()
    said: list[str] = []
    with open_bag(tmp_path / "bag") as opened:
        player = Player(probe.node, opened, None, said.append)
        assert player.play(1.0, lambda _deadline_s: True)
        assert player.report.published == 1
    assert len(said) == 1
    assert said[0].startswith(f"not played: /a: {message}")


def test_playing_in_a_loop_reaches_subscribers_in_order_until_ctrl_c(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_bag(tmp_path / "bag", {"/a": "std_msgs/msg/String", "/b": "std_msgs/msg/String"}, list(range(20)), monkeypatch)
    with Probe(88) as probe, acts("play", str(tmp_path / "bag"), "--loop", "-t", "a", domain_id=88) as process:
        texts = [message.data for message in probe.wait_for_messages("/a", String, 40, TIMEOUT_S)]
        assert probe.node.count_publishers("/b") == 0
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 0
    assert re.search(r"\[play\] \d+ messages in", output)
    first = texts.index("0")
    assert texts[first : first + 10] == [str(index) for index in range(0, 20, 2)]
