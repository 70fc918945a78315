# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Publishers whose failures end nothing, and a second publisher of a topic is reported; ROS_DOMAIN_ID 113."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from peers import Peers
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32

from acts_ros.diagnostics import ERROR, OK, DiagnosticsReporter
from acts_ros.publishers import SAME_NAME_S, OnlyPublishers, TolerantPublisher, published
from acts_ros.qos import LATCHED, STREAM


class Graph(Peers):
    """A node that watches `/plate/touch`, and others that publish it."""

    def __init__(self) -> None:
        super().__init__(113, "watcher", "/plate")
        self.watcher = self.peer
        self.others: list[Node] = []

    def publish(self, name: str) -> Node:
        other = Node(name, namespace="/plate", context=self.context)
        other.create_publisher(Int32, "touch", 10)
        self.others.append(other)
        self.until(lambda: self.watcher.count_publishers("/plate/touch") == len(self.others))
        return other


@pytest.fixture
def graph() -> Iterator[Graph]:
    made = Graph()
    yield made
    for node in made.others:
        node.destroy_node()
    made.close()


def test_a_second_publisher_is_named_as_long_as_it_is_there(graph: Graph) -> None:
    only = OnlyPublishers(graph.watcher, ["touch", "other"])
    assert only.problem() == ""
    graph.publish("skin")
    assert only.problem() == ""
    forger = graph.publish("forger")
    assert only.problem() == "/plate/touch has 2 publishers (/plate/forger, /plate/skin): end all but one"
    graph.others.remove(forger)
    forger.destroy_node()
    graph.until(lambda: only.problem() == "")


def test_a_node_that_was_killed_and_started_again_is_no_problem_at_first(graph: Graph) -> None:
    now_s = 100.0
    only = OnlyPublishers(graph.watcher, ["touch"], lambda: now_s)
    graph.publish("skin")
    graph.publish("skin")
    assert only.problem() == ""
    now_s += SAME_NAME_S - 1.0
    assert only.problem() == ""
    now_s += 1.0
    assert only.problem() == "/plate/touch has 2 publishers (/plate/skin, /plate/skin): end all but one"


def test_a_publisher_that_goes_while_it_is_looked_for_is_no_problem(
    graph: Graph, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s = 100.0
    only = OnlyPublishers(graph.watcher, ["touch"], lambda: now_s)
    graph.publish("skin")
    forger = graph.publish("forger")
    assert only.problem() != ""
    now_s += SAME_NAME_S
    graph.others.remove(forger)
    forger.destroy_node()
    graph.until(lambda: graph.watcher.count_publishers("/plate/touch") == 1)
    # As it was a moment before.
    monkeypatch.setattr(graph.watcher, "count_publishers", lambda _topic: 2)
    assert only.problem() == ""


@pytest.mark.parametrize(
    ("own", "message"), [(OK, "/plate/touch has 2 publishers"), (ERROR, "no port; /plate/touch has 2 publishers")]
)
def test_the_diagnostics_warn_of_it(own: int, message: str, graph: Graph) -> None:
    found: list[DiagnosticStatus] = []
    graph.watcher.create_subscription(DiagnosticArray, "/diagnostics", lambda report: found.extend(report.status), 10)
    reporter = DiagnosticsReporter(
        graph.watcher, "skin", lambda: (own, "no port", {}), only_publishers=["touch"], period_s=0.05
    )
    graph.publish("skin")
    graph.publish("forger")
    graph.until(lambda: any(one.message.startswith(message) for one in found))
    assert found[-1].level == (DiagnosticStatus.WARN if own == OK else DiagnosticStatus.ERROR)
    reporter.destroy()


class Middleware:
    """Takes messages, but for the first few of them."""

    def __init__(self, refused: int, words: str) -> None:
        self.refused = refused
        self.words = words
        self.asked = 0
        self._publish = Publisher.publish

    def publish(self, publisher: Publisher[Int32], msg: Int32) -> None:
        self.asked += 1
        if self.asked <= self.refused:
            raise rclpy_implementation.RCLError(f"{self.words}, at /project/src/rmw_publish.cpp:68")
        self._publish(publisher, msg)


@pytest.mark.parametrize(("profile", "refused", "asked"), [(STREAM, 1, 1), (LATCHED, 2, 3), (LATCHED, 9, 3)])
def test_a_message_that_the_middleware_does_not_take_is_told_and_ends_nothing(
    graph: Graph,
    profile: QoSProfile,
    refused: int,
    asked: int,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    publisher = graph.watcher.create_publisher(Int32, "touch", **published(profile))
    middleware = Middleware(refused, "Failed to publish: cannot publish data")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    publisher.publish(Int32(data=1))
    assert middleware.asked == asked
    line = "a message on /plate/touch was not published: Failed to publish: cannot publish data\n"
    assert (line in capfd.readouterr().err) == (asked <= refused)


def test_of_each_topic_it_is_told_once_a_second(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    stream = graph.watcher.create_publisher(Int32, "touch", **published(STREAM))
    kept = graph.watcher.create_publisher(Int32, "board", **published(LATCHED))
    middleware = Middleware(1000, "Failed to publish: cannot publish data")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    begin_s = time.monotonic()
    for _ in range(100):
        stream.publish(Int32(data=1))
    kept.publish(Int32(data=1))
    lines = capfd.readouterr().err
    assert 1 <= lines.count("a message on /plate/touch was not published") <= 1 + time.monotonic() - begin_s
    assert lines.count("a message on /plate/board was not published") == 1


def test_what_is_kept_for_late_joiners_comes_when_the_middleware_takes_it_again(
    graph: Graph, monkeypatch: pytest.MonkeyPatch
) -> None:
    publisher = graph.watcher.create_publisher(Int32, "board", **published(LATCHED))
    middleware = Middleware(1000, "Failed to publish: cannot publish data")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    publisher.publish(Int32(data=1))
    publisher.publish(Int32(data=2))
    late = graph.listen(Int32, "board", LATCHED)
    # It is tried again without another message.
    asked = middleware.asked
    graph.until(lambda: middleware.asked > asked)
    assert not late
    middleware.refused = 0
    graph.until(lambda: late)
    publisher.publish(Int32(data=3))
    graph.until(lambda: len(late) == 2)
    assert [one.data for one in late] == [2, 3]


def test_another_error_of_a_publisher_is_raised(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    publisher = graph.watcher.create_publisher(Int32, "touch", 10, publisher_class=TolerantPublisher)
    middleware = Middleware(1, "the context is invalid")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    with pytest.raises(rclpy_implementation.RCLError, match="the context is invalid"):
        publisher.publish(Int32(data=1))
