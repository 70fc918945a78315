# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts info`: what a bag holds."""

from __future__ import annotations

import argparse
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from acts_core.errors import RecordingError
from acts_core.words import counted
from acts_ros.bags import require_rosbags

if TYPE_CHECKING:
    from acts_ros.bags.reading import Bag

_EPILOG = """\
examples:
  acts info touch                   a bag of acts record or ros2 bag record
  acts info touch/touch.mcap        one file of it

Of a whole bag only the index is read, so that damage between the messages is not noticed.
docs/bags.md says which bags are read.
"""

_HEADINGS = ("topic", "type", "messages", "a second")


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``info`` to the acts command."""
    parser = subparsers.add_parser(
        "info",
        help="print what a bag holds",
        description="Print what a bag holds: when it was recorded, and of each topic the type and how many messages, "
        "on average over the bag's length how many a second.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("bag", type=Path, metavar="BAG", help="folder of the bag, or its .mcap or .db3 file")


def run(arguments: argparse.Namespace) -> int:
    """Print what there is, and return 0.

    Raises
    ------
    RecordingError
        There is no bag, or nothing in it can be read.
    """
    require_rosbags()
    # Imported here, because it is slow to import and other commands do not need it.
    from acts_ros.bags.reading import open_bag

    with open_bag(arguments.bag) as bag:
        if bag.note is not None:
            print(f"note: {bag.note}")
        print("\n".join(contents(bag)))
    return 0


def contents(bag: Bag) -> list[str]:
    """Lines for a person.

    Parameters
    ----------
    bag : Bag
        Open.

    Raises
    ------
    RecordingError
        It has no index, and is damaged.
    """
    types = bag.topics()
    counts = {topic: bag.message_count(topic) for topic in sorted(types)}
    total = sum(counts.values())
    if not total:
        return [f"no message; {counted(len(types), 'topic')}", *_table(types, counts, 0.0)]
    begin_ns, end_ns = bag.span_ns(list(types))
    length_s = 1e-9 * (end_ns - begin_ns)
    when = f"{_clock_time(begin_ns)}, {length_s:.1f} s long"
    return [
        f"{counted(total, 'message')} from {when}",
        *_table(types, counts, length_s),
        *_unreadable(bag, list(counts)),
    ]


def _table(types: dict[str, str], counts: dict[str, int], length_s: float) -> list[str]:
    # A topic with one message, such as a baseline, has no rate.
    rates = {topic: f"{count / length_s:.1f}" if length_s and count > 1 else "" for topic, count in counts.items()}
    rows = [_HEADINGS, *((topic, types[topic], str(count), rates[topic]) for topic, count in counts.items())]
    topic, kind, number, rate = (max(len(row[column]) for row in rows) for column in range(len(_HEADINGS)))
    return [f"{row[0]:<{topic}}  {row[1]:<{kind}}  {row[2]:>{number}}  {row[3]:>{rate}}".rstrip() for row in rows]


def _unreadable(bag: Bag, topics: list[str]) -> list[str]:
    """A line for each topic whose messages cannot be read here."""
    lines = []
    for topic in topics:
        try:
            bag.message_class(topic)
        except RecordingError as error:
            lines.append(f"not readable here: {topic}: {error}")
    return lines


def _clock_time(stamp_ns: int) -> str:
    """The time here at a stamp of the system clock."""
    return datetime.fromtimestamp(stamp_ns // 10**9).astimezone().isoformat(sep=" ")
