# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts echo`: messages as text, and the command on a publisher of this process; ROS_DOMAIN_ID 230."""

from __future__ import annotations

import array
import contextlib
import itertools
import subprocess
import sys
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState, Image
from std_msgs.msg import UInt8
from waiting import wait_for

from acts_msgs.msg import BalanceStatus, Impact
from acts_ros.qos import STREAM
from acts_tools.cli import main
from acts_tools.echo.inbox import Inbox
from acts_tools.echo.message_text import LONGEST_LIST, message_text
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0


def test_a_message_is_told_field_by_field() -> None:
    impact = Impact(number=3, is_over=True, peak_force=0.1, onset_sigma=1e-5, force=array.array("f", [0.1, 2.0]))
    impact.header.frame_id = "plate"
    impact.onset.nanosec = 5
    text = message_text(impact)
    lines = text.splitlines()
    assert "onset: {sec: 0, nanosec: 5}" in lines
    assert "is_over: true" in lines
    assert "force: [0.1, 2.0]" in lines
    told = yaml.safe_load(text)
    assert list(told) == list(impact.get_fields_and_field_types())
    assert told["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "plate"}
    assert (told["number"], told["peak_force"], told["onset_sigma"], told["path_x"]) == (3, 0.1, 1e-5, [])


class Drawing:
    """As visualization_msgs/ImageMarker: constants of other fields, of which two have the same value."""

    ADD, REMOVE, CIRCLE = 0, 1, 0
    filled, points = 0, (1.0,)

    def get_fields_and_field_types(self) -> dict[str, str]:
        return {"filled": "uint8", "points": "sequence<double>"}


@pytest.mark.parametrize(
    ("message", "line"),
    [
        (BalanceStatus(state=BalanceStatus.STATE_BALANCING), "state: 3  # STATE_BALANCING"),
        # Its constants do not bear the name of their field.
        (Impact(kind=Impact.TAP), "kind: 2  # TAP"),
        (BalanceStatus(state=200), "state: 200"),
        # Of a message without nested fields, and without constants.
        (UInt8(data=3), "{data: 3}"),
        (Drawing(), "filled: 0"),
        (BatteryState(power_supply_health=1), "power_supply_health: 1  # POWER_SUPPLY_HEALTH_GOOD"),
    ],
)
def test_a_constant_is_told_by_its_name(message: Any, line: str) -> None:
    text = message_text(message)
    assert line in text.splitlines()
    assert isinstance(yaml.safe_load(text), dict)


def test_messages_in_messages_and_bytes_are_told() -> None:
    status = DiagnosticStatus(level=b"\x02", name="plate/driver", values=[KeyValue(key="lost", value="yes: 3")])
    told = yaml.safe_load(message_text(DiagnosticArray(status=[status])))
    (only,) = told["status"]
    assert (only["level"], only["name"], only["values"]) == (2, "plate/driver", [{"key": "lost", "value": "yes: 3"}])


@pytest.mark.parametrize("kind", [array.array, np.array])
def test_long_lists_are_cut(kind: type) -> None:
    data = array.array("B", range(200)) if kind is array.array else np.arange(200, dtype=np.uint8)
    image = Image(height=1, width=200)
    image._data = data
    told = yaml.safe_load(message_text(image))["data"]
    assert told == [*range(LONGEST_LIST), "... 200 in all"]


@pytest.fixture
def talker(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    monkeypatch.setenv("ROS_DOMAIN_ID", "230")
    with Probe(230) as probe:
        yield probe.node


def publish_until_it_ends(process: subprocess.Popen[str], publisher: Publisher) -> None:
    """Publish impacts, numbered from 1 on, every 10 ms until the process has ended."""
    numbers = itertools.count(1)

    def publish() -> None:
        publisher.publish(Impact(number=next(numbers)))
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.01)

    wait_for(lambda: process.poll() is not None, "the end of the process", DEADLINE_S, publish)


def test_the_command_prints_as_many_messages_as_are_wanted(talker: Node) -> None:
    impacts = talker.create_publisher(Impact, "/plate/impacts", STREAM)
    command = [sys.executable, "-m", "acts_tools", "echo", "plate/impacts", "-n", "2"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        publish_until_it_ends(process, impacts)
        assert process.stdout is not None
        told = list(yaml.safe_load_all(process.stdout.read()))
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 0
    assert told.pop() is None  # behind the last ---
    first, second = told
    assert second["number"] == first["number"] + 1


@pytest.mark.parametrize("is_watched", [True, False])
def test_a_terminal_shows_the_present_and_a_file_gets_all(
    is_watched: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A thousand messages have come at once; each takes 16 ms to print."""
    clock = SimpleNamespace(now_s=0.0)

    def slowly(message: int) -> str:
        clock.now_s += 1 / 64
        return f"data: {message}\n"

    @contextmanager
    def no_node(_name: str) -> Iterator[tuple[None, None]]:
        yield None, None

    waiting = deque([range(1000), range(1000, 1003)])
    monkeypatch.setattr("acts_tools.running.node.command_node", no_node)
    monkeypatch.setattr("acts_ros.executor.spin_for", lambda _executor, _seconds: None)
    monkeypatch.setattr("acts_tools.echo.inbox.Inbox.discover", lambda _self: None)
    monkeypatch.setattr("acts_tools.echo.inbox.Inbox.take", lambda _self: iter(waiting.popleft()))
    monkeypatch.setattr("acts_tools.echo.message_text.message_text", slowly)
    monkeypatch.setattr("acts_tools.echo.command.time", SimpleNamespace(monotonic=lambda: clock.now_s))
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_watched)
    shown = 7 + 1 + 3 if is_watched else 1003
    assert main(["echo", "/word", "-n", str(shown)]) == 0
    text = capsys.readouterr().out
    numbers = [document["data"] for document in yaml.safe_load_all(text) if document]
    if is_watched:
        assert numbers == [*range(7), 999, 1000, 1001, 1002]
        assert "data: 6\n---\n# 992 messages left out\ndata: 999\n---\n" in text
    else:
        assert numbers == list(range(1003))
        assert "#" not in text


def test_a_weaker_publisher_that_comes_later_is_heard_too() -> None:
    """As a driver that was started again with another quality of service."""
    with Probe(230) as probe:
        inbox = Inbox(probe.node, "/word")
        heard: set[int] = set()

        def hears(publisher: Publisher, word: int) -> bool:
            publisher.publish(UInt8(data=word))
            inbox.discover()
            heard.update(message.data for message in inbox.take())
            return word in heard

        strong = probe.node.create_publisher(UInt8, "/word", QoSProfile(depth=10))
        probe.wait_for(lambda: hears(strong, 1), DEADLINE_S, "the first publisher")
        weak = probe.node.create_publisher(UInt8, "/word", STREAM)
        probe.wait_for(lambda: hears(weak, 2), DEADLINE_S, "the second publisher")


def test_a_reader_that_ends_ends_the_command_without_a_word(talker: Node) -> None:
    impacts = talker.create_publisher(Impact, "/plate/impacts", STREAM)
    for _ in range(5):
        ended = end_of_a_command_that_nobody_reads(impacts)
        # On a busy machine a publisher may be found late, which is told: then this says nothing of the end.
        if ended != (1, "/plate/impacts: no publisher found yet. Ctrl-C ends the waiting\n"):
            break
    assert ended == (1, "")


def end_of_a_command_that_nobody_reads(publisher: Publisher) -> tuple[int, str]:
    """Exit code and standard error output."""
    command = [sys.executable, "-m", "acts_tools", "echo", "plate/impacts"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    process.stdout.close()
    try:
        publish_until_it_ends(process, publisher)
    finally:
        process.kill()
    assert process.stderr is not None
    with process.stderr as errors:
        return process.wait(), errors.read()


def test_who_hears_nothing_is_told(talker: Node) -> None:
    command = [sys.executable, "-m", "acts_tools", "echo", "-d", "0.3", "/nobody"]
    finished = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)
    assert (finished.returncode, finished.stdout) == (1, "")
    assert finished.stderr == "/nobody: no publisher found\n"


def test_without_a_topic_those_that_are_published_are_listed(talker: Node, capsys: pytest.CaptureFixture[str]) -> None:
    talker.create_publisher(Impact, "/plate/impacts", STREAM)
    talker.create_publisher(UInt8, "/a", STREAM)
    talker.create_publisher(UInt8, "/_hidden/a", STREAM)
    talker.create_subscription(UInt8, "/only_wanted", lambda message: None, STREAM)
    assert main(["echo"]) == 0
    lines = capsys.readouterr().out.splitlines()
    # Those of every node of ROS are among them.
    ours = [line for line in lines if not line.startswith(("/parameter_events ", "/rosout "))]
    assert [line.split() for line in ours] == [["/a", "std_msgs/msg/UInt8"], ["/plate/impacts", "acts_msgs/msg/Impact"]]
    assert len({line.index(line.split()[1]) for line in lines}) == 1


def test_where_nothing_is_published_that_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "230")
    assert main(["echo"]) == 1
    assert capsys.readouterr().err == "nobody publishes anything: is something launched, with this ROS_DOMAIN_ID?\n"
    assert main(["echo", "-n", "2"]) == 1
    assert "--number 2 has no effect without a topic; leave it out" in capsys.readouterr().err
