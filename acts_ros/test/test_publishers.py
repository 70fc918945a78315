# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Publishers whose failures end nothing, and a second publisher of a topic is reported; ROS_DOMAIN_ID 113."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from peers import Peers
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32
from waiting import wait_for

from acts_ros import publishers
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


class MadeGraph:
    """Says who publishes the topics of the namespace of a robot."""

    def __init__(self) -> None:
        self.names: list[tuple[str, str]] = []
        """Namespace and name of each publisher."""

    def resolve_topic_name(self, topic: str) -> str:
        return f"/{topic}"

    def count_publishers(self, _topic: str) -> int:
        return len(self.names)

    def get_publishers_info_by_topic(self, _topic: str) -> list[Any]:
        return [SimpleNamespace(node_namespace=namespace, node_name=name) for namespace, name in self.names]


def test_of_publishers_of_one_name_the_time_begins_anew_when_one_of_them_has_gone() -> None:
    now_s = 100.0
    graph = MadeGraph()
    only = OnlyPublishers(graph, ["touch"], lambda: now_s)  # type: ignore[arg-type]
    skin = ("/plate", "skin")
    graph.names = [skin, skin]
    assert only.problem() == ""
    graph.names = [skin]
    assert only.problem() == ""
    # Killed once more, an hour later.
    now_s += 3600.0
    graph.names = [skin, skin]
    assert only.problem() == ""
    now_s += SAME_NAME_S
    assert only.problem() != ""


def test_nodes_without_a_namespace_and_programs_without_a_node_are_named() -> None:
    graph = MadeGraph()
    graph.names = [("/", "skin"), ("_NODE_NAMESPACE_UNKNOWN_", "_NODE_NAME_UNKNOWN_")]
    only = OnlyPublishers(graph, ["touch"])  # type: ignore[arg-type]
    assert only.problem() == "/touch has 2 publishers (/skin, a program without a node): end all but one"


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
        self.taken: list[Int32] = []
        self._publish = Publisher.publish

    def publish(self, publisher: Publisher[Int32], msg: Int32) -> None:
        self.asked += 1
        if self.asked <= self.refused:
            raise rclpy_implementation.RCLError(f"{self.words}, at /project/src/rmw_publish.cpp:68")
        self._publish(publisher, msg)
        self.taken.append(msg)


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


def owing() -> int:
    """How many threads are about to publish again."""
    return sum(thread.name == "acts_owed" for thread in threading.enumerate())


@pytest.fixture
def soon_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(publishers, "_PERIOD_S", 0.01)


@pytest.mark.filterwarnings("error::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.usefixtures("soon_again")
def test_an_older_message_does_not_come_after_a_newer_one(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    publisher = graph.watcher.create_publisher(Int32, "board", **published(LATCHED))
    middleware = Middleware(0, "Failed to publish: cannot publish data")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    for number in (0, 10):
        middleware.refused = middleware.asked + 1000
        publisher.publish(Int32(data=number + 1))
        publisher.publish(Int32(data=number + 2))
        assert owing() == 1
        middleware.refused = 0
        publisher.publish(Int32(data=number + 3))
        wait_for(lambda: not owing(), "that nothing is owed")
        # One that nothing newer follows comes, too.
        middleware.refused = middleware.asked + 4
        publisher.publish(Int32(data=number + 4))
        wait_for(lambda: not owing(), "that it is taken")
    assert [one.data for one in middleware.taken] == [3, 4, 13, 14]


@pytest.mark.filterwarnings("error::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.usefixtures("soon_again")
@pytest.mark.parametrize("is_destroyed", [True, False])
def test_what_is_owed_where_a_publisher_or_its_context_has_ended_is_given_up_without_a_word(
    is_destroyed: bool, graph: Graph, monkeypatch: pytest.MonkeyPatch
) -> None:
    publisher = graph.watcher.create_publisher(Int32, "board", **published(LATCHED))
    middleware = Middleware(1000, "Failed to publish: cannot publish data")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    publisher.publish(Int32(data=1))
    assert owing() == 1
    if is_destroyed:
        graph.watcher.destroy_publisher(publisher)
        middleware.refused = 0
    else:
        middleware.words = "the context is invalid"
    wait_for(lambda: not owing(), "the end of the attempts")
    assert middleware.taken == []


def test_another_error_of_a_publisher_is_raised(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    publisher = graph.watcher.create_publisher(Int32, "touch", 10, publisher_class=TolerantPublisher)
    middleware = Middleware(1, "the context is invalid")
    monkeypatch.setattr(Publisher, "publish", lambda one, msg: middleware.publish(one, msg))
    with pytest.raises(rclpy_implementation.RCLError, match="the context is invalid"):
        publisher.publish(Int32(data=1))
