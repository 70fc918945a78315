# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Subscriptions and services that are read when their reader is due; ROS_DOMAIN_ID 134."""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import pytest
from peers import Peers
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.service import Service
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

from acts_ros.executor import EventsExecutor
from acts_ros.polled import PolledSubscription, PollingNode
from acts_ros.qos import LATCHED, STREAM


class Pair(Peers):
    """A node that is asked, and another one that publishes."""

    turn_s = 0.02

    def __init__(self, make_executor: Callable[..., Executor]) -> None:
        super().__init__(134, make_executor=make_executor)
        self.node = self.add(PollingNode("asked", context=self.context))
        self.called: list[int] = []
        self.node.create_subscription(Int32, "called", lambda message: self.called.append(message.data), STREAM)
        self.polled: PolledSubscription[Int32] = self.node.create_polled_subscription(Int32, "polled", STREAM, depth=8)
        self.publishers = [self.peer.create_publisher(Int32, topic, STREAM) for topic in ("called", "polled")]
        self.until(lambda: all(publisher.get_subscription_count() == 1 for publisher in self.publishers))

    def send(self, *numbers: int) -> None:
        for number in numbers:
            for publisher in self.publishers:
                publisher.publish(Int32(data=number))

    def take_until(self, number: int) -> list[int]:
        taken: list[int] = []

        def is_there() -> bool:
            taken.extend(message.data for message, _ in self.polled.take_all())
            return number in taken

        self.until(is_there)
        return taken


@pytest.fixture(params=[one for one in (SingleThreadedExecutor, EventsExecutor) if one], ids=lambda one: one.__name__)
def pair(request: pytest.FixtureRequest) -> Iterator[Pair]:
    made = Pair(request.param)
    yield made
    made.close()


def test_messages_wait_until_they_are_asked_for(pair: Pair) -> None:
    pair.send(1, 2, 3)
    # The other subscription of the node is called back, so the executor has had its chance to take these as well.
    pair.until(lambda: 3 in pair.called)
    assert pair.take_until(3) == [1, 2, 3]
    assert pair.polled.take_all() == []
    assert pair.polled.topic_name == "/polled"


def test_of_too_many_the_newest_are_kept(pair: Pair) -> None:
    pair.send(*range(100))
    pair.until(lambda: 99 in pair.called)
    taken = pair.take_until(99)
    assert taken[-8:] == list(range(92, 100))
    assert taken == sorted(taken)
    # The length of one queue is that of no other.
    assert STREAM.depth == 256


def test_the_newest_message_tells_how_long_it_has_waited(pair: Pair) -> None:
    assert pair.polled.take_newest() is None
    begun_s = time.time()
    pair.send(1, 2)
    pair.until(lambda: 2 in pair.called)
    taken: list[tuple[Int32, float]] = []

    def is_there() -> bool:
        taken.extend(filter(None, [pair.polled.take_newest()]))
        return bool(taken) and taken[-1][0].data == 2

    pair.until(is_there)
    # Unless the middleware does not tell.
    if not math.isnan(waited_s := taken[-1][1]):
        assert 0.0 < waited_s < time.time() - begun_s
    assert pair.polled.take_newest() is None


def test_where_the_middleware_tells_no_time_of_reception_it_is_the_present_or_not_known() -> None:
    arrived: list[tuple[Int32, dict[str, int]]] = []

    class Handle(nullcontext[None]):
        def take_message(self, *_: object) -> tuple[Int32, dict[str, int]] | None:
            return arrived.pop(0) if arrived else None

    made: Any = SimpleNamespace(handle=Handle(), qos_profile=STREAM, msg_type=Int32, raw=False)
    polled: PolledSubscription[Int32] = PolledSubscription(made)
    unknown = {"received_timestamp": 0, "source_timestamp": 0}
    arrived += [(Int32(data=1), {**unknown, "received_timestamp": 5}), (Int32(data=2), unknown)]
    before_ns = time.time_ns()
    (_, known_ns), (_, present_ns) = polled.take_all()
    assert known_ns == 5
    assert before_ns <= present_ns <= time.time_ns()
    arrived += [(Int32(data=3), {**unknown, "received_timestamp": 5}), (Int32(data=4), unknown)]
    newest = polled.take_newest()
    assert newest is not None
    assert newest[0].data == 4
    assert math.isnan(newest[1])


def test_a_service_is_answered_when_the_answer_is_known(pair: Pair) -> None:
    service = pair.node.create_polled_service(Trigger, "later")
    client = pair.peer.create_client(Trigger, "later")
    pair.until(client.service_is_ready)
    assert service.take() is None
    answers = [client.call_async(Trigger.Request()) for _ in range(2)]
    taken: list[tuple[Trigger.Request, object]] = []

    def are_there() -> bool:
        request = service.take()
        if request is not None:
            taken.append(request)
        return len(taken) == 2

    pair.until(are_there)
    # Meanwhile the executor goes on.
    pair.send(5)
    pair.until(lambda: 5 in pair.called)
    assert not any(answer.done() for answer in answers)
    for place, (_request, header) in enumerate(taken):
        service.answer(Trigger.Response(success=True, message=str(place)), header)
    pair.until(lambda: all(answer.done() for answer in answers))
    assert [answer.result().message for answer in answers] == ["0", "1"]


def test_an_answer_that_the_middleware_does_not_take_keeps_nobody_else_from_theirs(
    pair: Pair, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    service = pair.node.create_polled_service(Trigger, "later")
    client = pair.peer.create_client(Trigger, "later")
    pair.until(client.service_is_ready)
    answers = [client.call_async(Trigger.Request()) for _ in range(2)]
    headers: list[object] = []
    refused: list[object] = []
    send = Service.send_response

    def refuse_first(one: Service, response: Trigger.Response, header: object) -> None:
        if not refused:
            refused.append(header)
            raise rclpy_implementation.RCLError("failed to send response: cannot publish data, at x.cpp:68")
        send(one, response, header)  # type: ignore[arg-type]

    monkeypatch.setattr(Service, "send_response", refuse_first)

    def are_there() -> bool:
        taken = service.take()
        if taken is not None:
            headers.append(taken[1])
        return len(headers) == 2

    pair.until(are_there)
    for header in headers:
        service.answer(Trigger.Response(success=True), header)
    pair.until(answers[1].done)
    assert (answers[0].done(), refused) == (False, headers[:1])
    assert "[acts_ros]: later: failed to send response: cannot publish data\n" in capfd.readouterr().err


def test_another_error_of_an_answer_is_raised(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    service = pair.node.create_polled_service(Trigger, "later")

    def fail(*_: object) -> None:
        raise rclpy_implementation.RCLError("service is invalid, at x.cpp:68")

    monkeypatch.setattr(Service, "send_response", fail)
    with pytest.raises(rclpy_implementation.RCLError, match="service is invalid"):
        service.answer(Trigger.Response(success=True), None)


def test_the_time_of_reception_is_told(pair: Pair) -> None:
    before_ns = time.time_ns()
    pair.send(7)
    found: list[tuple[Int32, int]] = []

    def is_there() -> bool:
        found.extend(pair.polled.take_all())
        return bool(found)

    pair.until(is_there)
    assert before_ns <= found[0][1] <= time.time_ns()


def test_the_time_of_sending_is_told(pair: Pair) -> None:
    before_ns = time.time_ns()
    pair.send(7)
    found: list[tuple[Int32, int]] = []

    def is_there() -> bool:
        found.extend(pair.polled.take_all_sent())
        return bool(found)

    pair.until(is_there)
    assert found[0][0].data == 7
    assert before_ns <= found[0][1] <= time.time_ns()
    assert pair.polled.take_all_sent() == []


def test_a_subscription_may_be_destroyed_while_an_event_of_it_waits(pair: Pair) -> None:
    """As when a publisher joins that offers less: the executor is told of it, and then finds no subscription."""
    strict = pair.node.create_polled_subscription(Int32, "late", LATCHED)
    pair.turn()
    pair.peer.create_publisher(Int32, "late", STREAM)
    pair.node.destroy_polled_subscription(strict)
    assert strict._subscription not in pair.node._polled
    pair.send(1)
    pair.until(lambda: 1 in pair.called)
