# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts listen`: its arithmetic, and the command on a publisher of this process; ROS_DOMAIN_ID 151."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile

from acts_msgs.msg import Contact, Contacts, Impact, Outline, RegionContacts, TactileSamples
from acts_ros.qos import STREAM
from acts_tools.cli import main
from acts_tools.listen.arrivals import Arrivals
from acts_tools.listen.command import complaint_in_words, in_words
from acts_tools.listen.listener import Listener
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0


def test_gaps_are_counted_in_the_interval_they_belong_to() -> None:
    arrivals = Arrivals(10.0)
    for sequence in (2**32 - 1, 0, 3):
        arrivals.add(10.5, sequence, 0.002)
    first = arrivals.take(11.0)
    assert (first.received, first.lost, first.median_ms, first.seconds) == (3, 2, 2.0, 1.0)
    arrivals.add(11.5, 4, 0.030)
    arrivals.add(11.6, 6, 0.010)
    second = arrivals.take(12.0)
    assert (second.received, second.lost, second.median_ms, second.largest_ms) == (2, 1, 20.0, 30.0)
    assert (second.total_received, second.total_lost) == (5, 3)
    third = arrivals.take(13.0)
    assert (third.received, third.lost, third.median_ms) == (0, 0, None)
    assert third.silent_s == pytest.approx(1.4)


def test_messages_without_number_or_stamp_are_only_counted() -> None:
    arrivals = Arrivals(0.0)
    assert arrivals.take(1.0).silent_s is None
    arrivals.add(1.5, None, None)
    interval = arrivals.take(2.0)
    assert (interval.received, interval.lost, interval.median_ms) == (1, None, None)


def test_a_stamp_of_zero_is_none() -> None:
    arrivals = Arrivals(0.0)
    listener = Listener(None, [])  # type: ignore[arg-type]
    listener._note(arrivals, Contact())
    interval = arrivals.take(1.0)
    assert (interval.received, interval.median_ms, interval.largest_ms) == (1, None, None)


def test_only_what_has_a_message_of_every_frame_can_miss_some() -> None:
    lost = {}
    for kind in (TactileSamples, Contact, Contacts, Impact, Outline, RegionContacts):
        arrivals = Arrivals(0.0)
        listener = Listener(None, [])  # type: ignore[arg-type]
        for sequence in (1, 2, 5):
            listener._note(arrivals, kind(sequence=sequence))
        lost[kind.__name__] = arrivals.take(1.0).lost
    assert lost == {
        "TactileSamples": 2,
        "Contact": 2,
        "Contacts": None,
        "Impact": None,
        "Outline": None,
        "RegionContacts": None,
    }


def test_what_arrives_is_put_into_words() -> None:
    arrivals = Arrivals(0.0)
    assert in_words(None) == "no publisher found yet"
    assert in_words(arrivals.take(1.0)) == "nothing yet"
    for sequence in range(2, 502):
        arrivals.add(1.5, sequence, 0.0012)
    arrivals.add(1.6, 504, 0.0012)
    line = in_words(arrivals.take(2.0))
    assert " ".join(line.split()) == "501.0 messages/s 2 lost (2 in all) age 1.2 ms, at most 1.2"
    assert in_words(arrivals.take(4.6)) == "nothing for 3.0 s, 501 messages before"


def test_a_slow_topic_is_not_silent_between_two_messages() -> None:
    arrivals = Arrivals(0.0)
    for now_s in (0.4, 1.4, 2.4, 3.4):
        arrivals.add(now_s, None, None)
    arrivals.take(3.5)
    assert in_words(arrivals.take(4.0)).strip() == "0.0 messages/s"
    assert in_words(arrivals.take(6.0)) == "nothing for 2.6 s, 4 messages before"


def test_the_complaint_of_a_node_that_has_fallen_silent_is_told_with_its_age(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = 10.0
    monkeypatch.setattr("acts_tools.listen.listener.time.monotonic", lambda: now_s)
    listener = Listener(None, [])  # type: ignore[arg-type]
    for level, name in ((b"\x01", "plate/driver"), (b"\x02", "arm/driver")):
        listener._note_complaints(
            DiagnosticArray(status=[DiagnosticStatus(level=level, name=name, message="no frames")])
        )
    now_s = 12.0
    listener._note_complaints(DiagnosticArray(status=[DiagnosticStatus(level=b"\x00", name="arm/driver")]))
    assert (listener.complaints, listener.complained_s) == ({"plate/driver": "no frames"}, {"plate/driver": 10.0})
    assert complaint_in_words("plate/driver", "no frames", 2.0) == "plate/driver: no frames"
    assert complaint_in_words("plate/driver", "no frames", 7.0) == "plate/driver: no frames (7 s ago, silent since)"


@pytest.fixture
def talker(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    monkeypatch.setenv("ROS_DOMAIN_ID", "151")
    with Probe(151) as probe:
        yield probe.node


def test_the_command_reports_as_long_as_it_runs(talker: Node) -> None:
    contacts = talker.create_publisher(Contact, "/plate/contact", STREAM)
    diagnostics = talker.create_publisher(DiagnosticArray, "/diagnostics", 10)
    status = DiagnosticStatus(level=b"\x01", name="plate/driver", message="no frames")
    command = [sys.executable, "-m", "acts_tools", "listen", "--json", "--every", "0.1", "plate/contact"]
    process = subprocess.Popen([*command, "/diagnostics"], stdout=subprocess.PIPE)
    assert process.stdout is not None
    deadline_s = time.monotonic() + DEADLINE_S
    sequence = 0
    try:
        while True:
            assert time.monotonic() < deadline_s, "no report of a loss and a complaint"
            report = json.loads(process.stdout.readline())
            # Every second number is left out.
            contacts.publish(Contact(sequence=sequence))
            sequence += 2
            diagnostics.publish(DiagnosticArray(status=[status]))
            heard = report["topics"].get("/plate/contact", {"total_lost": None})
            if (heard["total_lost"] or 0) >= 3 and report["complaints"]:
                break
    finally:
        process.terminate()
        code = process.wait(DEADLINE_S)
        process.stdout.close()
    assert code == 0
    assert heard["total_lost"] == heard["total_received"] - 1
    assert report["complaints"] == {"plate/driver": "no frames"}
    assert list(report["complaint_ages_s"]) == ["plate/driver"]


def test_a_weaker_publisher_that_comes_later_is_heard_too() -> None:
    """As a driver that was started again with another quality of service."""
    with Probe(151) as probe:
        listener = Listener(probe.node, ["/steps"])
        numbers: set[int] = set()

        def hears(publisher: Publisher, number: int) -> bool:
            publisher.publish(DiagnosticArray(status=[DiagnosticStatus(level=b"\x01", name=str(number))]))
            listener.discover()
            numbers.update(map(int, listener.complaints))
            return number in numbers

        strong = probe.node.create_publisher(DiagnosticArray, "/steps", QoSProfile(depth=10))
        probe.wait_for(lambda: hears(strong, 1), DEADLINE_S, "the first publisher")
        received = listener.arrivals["/steps"].take(time.monotonic()).total_received
        weak = probe.node.create_publisher(DiagnosticArray, "/steps", STREAM)
        probe.wait_for(lambda: hears(weak, 2), DEADLINE_S, "the second publisher")
        assert listener.arrivals["/steps"].take(time.monotonic()).total_received > received > 0


def test_who_hears_nothing_is_told(talker: Node) -> None:
    command = [sys.executable, "-m", "acts_tools", "listen", "-d", "0.3", "--every", "0.1", "/nobody"]
    finished = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)
    assert finished.returncode == 1
    assert "/nobody  no publisher found yet" in finished.stdout


@dataclass
class Clock:
    """The time that the command sees [s]."""

    now_s: float = 0.0

    def go_on(self, seconds: float) -> None:
        self.now_s += seconds


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """A clock that goes on by 5 s where ROS starts, and by what the command waits."""
    clock = Clock()

    @contextmanager
    def slowly_made(_name: str) -> Iterator[tuple[None, None]]:
        clock.go_on(5.0)
        yield None, None

    monkeypatch.setattr("acts_tools.running.node.command_node", slowly_made)
    monkeypatch.setattr("acts_ros.executor.spin_for", lambda _executor, seconds: clock.go_on(seconds))
    monkeypatch.setattr("acts_tools.listen.listener.Listener.discover", lambda _self: None)
    monkeypatch.setattr("acts_tools.listen.command.time", SimpleNamespace(monotonic=lambda: clock.now_s))
    return clock


def test_the_duration_begins_when_it_listens(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["listen", "-d", "0.35", "--every", "0.1", "/nobody"]) == 1
    assert set(capsys.readouterr().out.splitlines()) == {"/nobody  no publisher found yet"}
    assert clock.now_s == pytest.approx(5.35, abs=0.1)


@pytest.mark.parametrize(("words", "seconds"), [("-d 0.5", [0.5]), ("-d 2.5", [1.0, 1.0, 0.5]), ("-d 2", [1.0, 1.0])])
def test_what_comes_after_the_last_whole_interval_is_told(
    words: str,
    seconds: list[float],
    clock: Clock,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def discover(listener: Listener) -> None:
        listener.arrivals.setdefault("/cop", Arrivals(clock.now_s)).add(clock.now_s, None, None)

    monkeypatch.setattr("acts_tools.listen.listener.Listener.discover", discover)
    assert main(["listen", *words.split(), "--json", "/cop"]) == 0
    told = [json.loads(line)["topics"]["/cop"] for line in capsys.readouterr().out.splitlines()]
    assert [one["seconds"] for one in told] == pytest.approx(seconds, abs=0.01)
    assert all(one["received"] for one in told)


def test_there_are_no_reports_of_the_time_in_which_the_machine_stood_still(
    clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def stand_still(listener: Listener) -> None:
        if "/cop" not in listener.arrivals:
            listener.arrivals["/cop"] = Arrivals(clock.now_s)
            clock.go_on(7.0)

    monkeypatch.setattr("acts_tools.listen.listener.Listener.discover", stand_still)
    assert main(["listen", "-d", "9", "--json", "/cop"]) == 1
    told = [json.loads(line)["topics"]["/cop"]["seconds"] for line in capsys.readouterr().out.splitlines()]
    assert told == pytest.approx([7.0, 1.0, 1.0], abs=0.01)


@pytest.mark.parametrize("name", ["bad topic", "", "/", "/a//b", "/1a", "/a-b", "/touché"])
@pytest.mark.parametrize("command", [["listen", "-d", "1"], ["record", "-d", "1"]])
def test_words_that_are_no_topic_are_refused(
    command: list[str], name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*command, name]) == 1
    assert capsys.readouterr().err.startswith(f"error: {name!r} is no topic: allowed are letters, digits (not first)")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["listen", "echo"])
def test_a_missing_library_is_told(command: str) -> None:
    # In a process of its own, in which nothing is imported yet.
    code = f"""import sys
sys.modules["rosbags"] = None
from acts_tools.cli import main
sys.exit(main(["{command}", "/plate/contact"]))"""
    finished = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=DEADLINE_S)
    assert finished.returncode == 1
    assert finished.stderr.startswith("error: the Python package rosbags is not installed. Install it with: pip")
