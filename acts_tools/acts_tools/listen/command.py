# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts listen TOPIC...`: print once a second what arrives on this machine, what is missing, and its delay."""

from __future__ import annotations

import argparse
import json
import math
import time
from dataclasses import asdict
from typing import TYPE_CHECKING

from acts_core.names import full_name
from acts_core.words import counted
from acts_tools.arguments import real, seconds
from acts_tools.diagnostics.statuses import SILENT_AFTER_S

if TYPE_CHECKING:
    from acts_tools.listen.arrivals import Interval
    from acts_tools.listen.listener import Listener

_EPILOG = """\
examples:
  acts listen /plate/contact                   loss and delay of the 1 kHz stream
  acts listen /plate/samples /diagnostics      also warnings and errors of the nodes

The age of a message is the time from its stamp to its arrival: on two machines it is as accurate as their clocks agree.
docs/two_machines.md explains the rest.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``listen`` to the acts command."""
    parser = subparsers.add_parser(
        "listen",
        help="measure loss and delay of a topic on this machine",
        description="Count the messages of topics that arrive, of samples and contact also those that are missing by "
        "their numbers, and measure their age. Topics may appear later. Ctrl-C ends it.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("topics", nargs="+", metavar="TOPIC", help="topics, such as /plate/contact")
    parser.add_argument("-d", "--duration", type=seconds, metavar="SECONDS", help="end by itself after this time")
    parser.add_argument(
        "--every", type=real(0.05), default=1.0, metavar="SECONDS", help="time between two reports (default: 1)"
    )
    parser.add_argument("--json", action="store_true", help="reports as lines of JSON")


def run(arguments: argparse.Namespace) -> int:
    """Listen; return 0 if messages arrived on every topic."""
    topics = list(dict.fromkeys(map(full_name, arguments.topics)))
    # Imported here, because they are slow to import and other commands do not need them.
    from acts_ros.bags import require_rosbags

    require_rosbags()
    from acts_ros.executor import spin_for
    from acts_tools.listen.listener import Listener
    from acts_tools.running.node import command_node
    from acts_tools.running.stopping import StopFlag

    with StopFlag() as stop, command_node("acts_listener") as (node, executor):
        listener = Listener(node, topics)
        begin_s = time.monotonic()
        end_s = math.inf if arguments.duration is None else begin_s + arguments.duration
        report_s = begin_s + arguments.every
        is_over = False
        while not is_over:
            listener.discover()
            turn_s = min(report_s, end_s) - time.monotonic()
            spin_for(executor, min(max(turn_s, 0.001), 0.1))
            now_s = time.monotonic()
            is_over = stop.is_set or now_s >= end_s
            # The last report is of what has come since the one before, however short that was.
            if is_over or now_s >= report_s:
                report_s += arguments.every
                if report_s <= now_s:
                    # The machine stood still: no reports of intervals that have passed.
                    report_s = now_s + arguments.every
                intervals = {topic: arrivals.take(now_s) for topic, arrivals in listener.arrivals.items()}
                _print(topics, intervals, listener, now_s, as_json=arguments.json)
    return 0 if all(topic in intervals and intervals[topic].total_received for topic in topics) else 1


def _print(
    topics: list[str], intervals: dict[str, Interval], listener: Listener, now_s: float, *, as_json: bool
) -> None:
    ages_s = {name: now_s - said_s for name, said_s in listener.complained_s.items()}
    if as_json:
        topic_values = {topic: asdict(interval) for topic, interval in intervals.items()}
        told = {"topics": topic_values, "complaints": listener.complaints, "complaint_ages_s": ages_s}
        print(json.dumps(told), flush=True)
        return
    width = max(map(len, topics))
    for topic in topics:
        hint = listener.hints.get(topic, "")
        print(f"{topic:{width}}  {in_words(intervals.get(topic))}{hint}", flush=True)
    for name, words in listener.complaints.items():
        print(f"  {complaint_in_words(name, words, ages_s[name])}", flush=True)


def complaint_in_words(name: str, words: str, age_s: float) -> str:
    """One line about a component that has warned; with the age of its report where it has fallen silent since."""
    silent = f" ({age_s:.0f} s ago, silent since)" if age_s > SILENT_AFTER_S else ""
    return f"{name}: {words}{silent}"


def in_words(interval: Interval | None) -> str:
    """One line about a topic; `interval` is None where there is no publisher."""
    if interval is None:
        return "no publisher found yet"
    if not interval.received and interval.is_silent:
        if interval.silent_s is None:
            return "nothing yet"
        return f"nothing for {interval.silent_s:.1f} s, {counted(interval.total_received, 'message')} before"
    words = f"{interval.received / interval.seconds:7.1f} messages/s"
    if interval.lost is not None:
        words += f"  {interval.lost:5d} lost ({interval.total_lost} in all)"
    if interval.median_ms is not None:
        words += f"  age {interval.median_ms:.1f} ms, at most {interval.largest_ms:.1f}"
    return words
