# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A publisher that offers less joins between two turns of a command that hears the topic; ROS_DOMAIN_ID 172."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from pathlib import Path

import pytest
from peers import Peers
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from std_msgs.msg import String

from acts_ros.bags.recorder import Recorder
from acts_ros.bags.writing import BagWriter
from acts_ros.executor import EventsExecutor
from acts_ros.qos import STREAM
from acts_tools.echo.inbox import Inbox
from acts_tools.listen.listener import Listener

TOPIC = "/word"


@contextmanager
def recorder(node: Node, folder: Path) -> Iterator[Callable[[], None]]:
    with closing(BagWriter(folder / "bag")) as bag, closing(Recorder(node, bag, [TOPIC], print)) as made:
        yield made.discover


@contextmanager
def listener(node: Node, _folder: Path) -> Iterator[Callable[[], None]]:
    yield Listener(node, [TOPIC]).discover


@contextmanager
def inbox(node: Node, _folder: Path) -> Iterator[Callable[[], None]]:
    yield Inbox(node, TOPIC).discover


@pytest.mark.parametrize("command", [recorder, listener, inbox])
def test_the_command_goes_on_and_hears_it(
    command: Callable[[Node, Path], AbstractContextManager[Callable[[], None]]], tmp_path: Path
) -> None:
    with (
        closing(Peers(172, make_executor=EventsExecutor or SingleThreadedExecutor)) as peers,
        command(peers.peer, tmp_path) as discover,
    ):
        peers.peer.create_publisher(String, TOPIC, QoSProfile(depth=10))

        def is_subscribed() -> bool:
            discover()
            return bool(subscriptions())

        def subscriptions() -> list[Subscription]:
            return [one for one in peers.peer.subscriptions if one.topic_name == TOPIC]

        peers.until(is_subscribed)
        peers.turn()  # from now on the executor is told of events
        present = subscriptions()
        weaker = peers.peer.create_publisher(String, TOPIC, STREAM)
        peers.until(lambda: discover() or subscriptions() != present)
        peers.turn()
        peers.until(lambda: weaker.get_subscription_count() == 1)
