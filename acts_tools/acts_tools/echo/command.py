# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts echo TOPIC`: print each message of a topic, also where there is no `ros2 topic`; without one list them."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from typing import Any

from acts_core.names import full_name
from acts_core.words import counted
from acts_tools.arguments import at_least_one, refuse_unused, seconds

_LIST_S = 2.0
_TURN_S = 0.1
# With what is waiting meanwhile, what a user sees is at most some 0.3 s old.
_BEHIND_S = 0.1

_EPILOG = """\
examples:
  acts echo                            the topics that running nodes publish
  acts echo /plate/impacts             each touch of the skin
  acts echo /plate/contact -n 1        the next message only

Where messages come faster than they can be printed, a terminal shows the newest ones, and a comment tells how many were
left out. A file or another program (`acts echo TOPIC | less`) gets all of them, late.

`acts listen` counts the messages of a topic, and those that are missing.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``echo`` to the acts command."""
    parser = subparsers.add_parser(
        "echo",
        help="print the messages of a topic",
        description="Print each message of a topic as YAML, with --- after it. The topic may appear later. "
        "Ctrl-C ends it. Without a name, list the topics there are, with their types.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("topic", nargs="?", metavar="TOPIC", help="topic, such as /plate/impacts")
    parser.add_argument("-n", "--number", type=at_least_one, metavar="N", help="end after this many messages")
    parser.add_argument("-d", "--duration", type=seconds, metavar="SECONDS", help="end by itself after this time")


def run(arguments: argparse.Namespace) -> int:
    """Print messages, or the topics there are; return 0 if there was at least one."""
    if arguments.topic is None:
        refuse_unused(arguments, "without a topic", "number", "duration")
        return _list()
    topic = full_name(arguments.topic)
    # Imported here, because they are slow to import and other commands do not need them.
    from acts_ros.bags import require_rosbags

    require_rosbags()
    from acts_ros.executor import spin_for
    from acts_tools.echo.inbox import Inbox
    from acts_tools.echo.message_text import message_text
    from acts_tools.running.near_names import NOTICE_S, near_topic
    from acts_tools.running.node import command_node
    from acts_tools.running.stopping import StopFlag

    printed = 0
    is_watched = sys.stdout.isatty()
    with StopFlag() as stop, command_node("acts_echo") as (node, executor):
        inbox = Inbox(node, topic)
        begin_s, is_told = time.monotonic(), False
        end_s = float("inf") if arguments.duration is None else begin_s + arguments.duration
        while not stop.is_set and printed != arguments.number and time.monotonic() < end_s:
            inbox.discover()
            spin_for(executor, min(_TURN_S, max(end_s - time.monotonic(), 0.001)))
            if not (printed or inbox.is_found or is_told) and time.monotonic() - begin_s > NOTICE_S:
                hint = near_topic(node, topic) or "."
                print(f"{topic}: no publisher found yet{hint} Ctrl-C ends the waiting", file=sys.stderr)
                is_told = True
            # Printed here, not in the callback: rclpy would report a reader that has ended (`| head`) as an error.
            for left_out, message in due(list(inbox.take()), is_watched):
                if left_out:
                    print(f"# {counted(left_out, 'message')} left out", flush=True)
                print(f"{message_text(message)}---", flush=True)
                printed += 1
                if stop.is_set or printed == arguments.number:
                    break
        if not printed:
            what = "no message came" if inbox.is_found else f"no publisher found{near_topic(node, topic)}"
            print(f"{topic}: {what}", file=sys.stderr)
    return 0 if printed else 1


def _list() -> int:
    """Print the topics that are published, and their types; the exit code."""
    from rclpy.executors import SingleThreadedExecutor

    from acts_ros.executor import spin_for
    from acts_tools.echo.topics import published
    from acts_tools.running.node import command_node

    with command_node("acts_echo", SingleThreadedExecutor) as (node, executor):
        spin_for(executor, _LIST_S)
        topics = published(node)
    if not topics:
        print("nobody publishes anything: is something launched, with this ROS_DOMAIN_ID?", file=sys.stderr)
        return 1
    width = max(map(len, topics))
    print("\n".join(f"{topic:<{width}}  {types}" for topic, types in topics.items()))
    return 0


def due(messages: list[Any], is_watched: bool) -> Iterator[tuple[int, Any]]:
    """Messages to print, each with the number of those before it that are left out.

    Parameters
    ----------
    messages : list
        Those that have come, the oldest first.
    is_watched : bool
        Whether only the newest is given once the others have waited for too long.
    """
    begin_s = time.monotonic()
    for number, message in enumerate(messages):
        left_out = len(messages) - 1 - number
        if is_watched and left_out and time.monotonic() - begin_s > _BEHIND_S:
            yield left_out, messages[-1]
            return
        yield 0, message
