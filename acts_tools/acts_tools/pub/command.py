# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts pub TOPIC TYPE VALUES`: publish a message again and again, also where there is no `ros2 topic`."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from acts_core.errors import SettingsError
from acts_core.names import full_name
from acts_core.words import counted
from acts_tools.arguments import at_least_one, real, seconds
from acts_tools.running.near_names import NOTICE_S
from acts_tools.running.stopping import StopFlag

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.publisher import Publisher

_LOOK_S = 0.1
_DEPTH = 100
# Until the subscribers have the last message.
_DELIVERY_S = 1.0

_EPILOG = """\
examples:
  acts pub -r 20 /hand/command sensor_msgs/msg/JointState '{name: [index_pip], position: [0.4]}'
  acts pub -n 1 /plate/mark geometry_msgs/msg/PointStamped '{header: auto, point: {x: 0.02}}'

VALUES are YAML: fields by name, those of a message within it in braces. In place of a stamp stands `now`, in place of a
header `auto`: each message is stamped when it is published.
TOPIC, TYPE, VALUES and -r are as of `ros2 topic pub`.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``pub`` to the acts command."""
    parser = subparsers.add_parser(
        "pub",
        help="publish a message again and again",
        description="Publish a message at a rate, from when somebody subscribes to the topic on. Ctrl-C ends it.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("topic", metavar="TOPIC", help="topic, such as /hand/command")
    parser.add_argument("type", metavar="TYPE", help="type of its messages, such as sensor_msgs/msg/JointState")
    parser.add_argument("values", nargs="?", default="{}", metavar="VALUES", help="YAML (default: %(default)s)")
    parser.add_argument(
        "-r",
        "--rate-hz",
        type=real(0.001, 1000),
        default=1.0,
        metavar="HZ",
        help="messages per second (default: 1)",
    )
    parser.add_argument("-n", "--number", type=at_least_one, metavar="N", help="end after this many messages")
    parser.add_argument("-d", "--duration", type=seconds, metavar="SECONDS", help="end by itself after this time")


def run(arguments: argparse.Namespace) -> int:
    """Publish, and return 0 if there was at least one message.

    Raises
    ------
    SettingsError
        There is no such type, the topic has another one, or a field cannot have its value.
    """
    topic = full_name(arguments.topic)
    # Imported here, because they are slow to import and other commands do not need them.
    from acts_ros.bags import require_rosbags

    require_rosbags()
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile

    from acts_ros.bags.message_types import message_class
    from acts_ros.publishers import TolerantPublisher
    from acts_tools.pub.typed_message import typed_message, typed_values
    from acts_tools.running.node import command_node

    values = typed_values(arguments.values)
    if arguments.type.split("/")[1:-1] != ["msg"]:
        raise SettingsError(f"TYPE = {arguments.type}: allowed is a message, such as sensor_msgs/msg/JointState")
    kind = message_class(arguments.type)
    typed_message(kind, values, 0)
    # Every subscription takes this, also one that wants the last message of before.
    offered = QoSProfile(depth=_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    sent = 0
    with StopFlag() as stop, command_node("acts_pub") as (node, _):
        publisher = node.create_publisher(kind, topic, offered, publisher_class=TolerantPublisher)
        end_s = float("inf") if arguments.duration is None else time.monotonic() + arguments.duration
        if _await_subscriber(publisher, end_s, stop, lambda: _require_type(node, topic, arguments.type)):
            due_s = time.monotonic()
            while sent != arguments.number and due_s < end_s and stop.sleep_until(due_s):
                publisher.publish(typed_message(kind, values, time.time_ns()))
                sent += 1
                due_s = max(due_s + 1.0 / arguments.rate_hz, time.monotonic())
            publisher.wait_for_all_acked(Duration(seconds=_DELIVERY_S))
    if not sent:
        print(f"{topic}: no subscriber found, nothing published", file=sys.stderr)
        return 1
    print(f"{topic}: {counted(sent, 'message')} published")
    return 0


def _await_subscriber(publisher: Publisher, end_s: float, stop: StopFlag, look: Callable[[], None]) -> bool:
    """Wait until somebody subscribes, and call `look` now and then; whether somebody does."""
    notice_s = time.monotonic() + NOTICE_S
    while not publisher.get_subscription_count():
        look()
        now_s = time.monotonic()
        if now_s > end_s or not stop.sleep_until(now_s + _LOOK_S):
            return False
        if now_s > notice_s:
            print(f"{publisher.topic_name}: no subscriber found yet. Ctrl-C ends the waiting", file=sys.stderr)
            notice_s = end_s
    return True


def _require_type(node: Node, topic: str, kind: str) -> None:
    """Refuse a type that those who subscribe do not have."""
    types = {one.topic_type for one in node.get_subscriptions_info_by_topic(topic)} - {kind}
    if types:
        raise SettingsError(f"{topic} is of the type {', '.join(sorted(types))}, not {kind}")
