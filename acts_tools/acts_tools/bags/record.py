# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts record`: record topics to an MCAP bag in rosbag2's layout."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from contextlib import closing
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from acts_core.errors import RecordingError
from acts_core.names import full_name
from acts_core.words import counted
from acts_ros.bags import require_rosbags
from acts_tools import __version__
from acts_tools.arguments import seconds

if TYPE_CHECKING:
    from acts_ros.bags.recorder import Recorder
    from acts_ros.bags.writing import BagWriter

_TURN_S = 0.25


_EPILOG = """\
examples:
  acts record /plate/samples /plate/contact             a folder named after the time; Ctrl-C ends it
  acts record -o touch -d 10 /plate/samples             ten seconds, in the folder touch
  acts record -a -o all                                 every topic that is not hidden

`acts play touch` publishes the messages again, `acts view --bag touch` shows them, `acts export` makes tables of them.
docs/bags.md explains the rest.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``record`` to the acts command."""
    parser = subparsers.add_parser(
        "record",
        help="record topics to a bag",
        description="Record topics to an MCAP bag that `acts play`, `ros2 bag`, Foxglove and rosbags read. "
        "Topics may appear later. Ctrl-C ends it; if it is killed, only the last quarter of a second is lost.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("topics", nargs="*", metavar="TOPIC", help="topics, such as /plate/contact")
    parser.add_argument("-a", "--all", action="store_true", help="all topics that are not hidden")
    parser.add_argument("-o", "--output", type=Path, metavar="DIR", help="folder to make (default: rosbag2_<time>)")
    parser.add_argument("-d", "--duration", type=seconds, metavar="SECONDS", help="end by itself after this time")


def run(arguments: argparse.Namespace) -> int:
    """Run ``acts record``; return 0 when messages of every requested topic have been recorded."""
    if bool(arguments.topics) == arguments.all:
        raise RecordingError("say which topics to record: either their names, or -a for all")
    # One that is named twice would be told of twice.
    topics = None if arguments.all else list(dict.fromkeys(map(full_name, arguments.topics)))
    path = arguments.output or Path(f"rosbag2_{datetime.now():%Y_%m_%d-%H_%M_%S}")
    return record(path, topics, arguments.duration)


def record(path: Path, topics: list[str] | None, duration_s: float | None) -> int:
    """Record until the time is over or the user stops it.

    Parameters
    ----------
    path : Path
        Folder of the bag; it must not exist.
    topics : list of str or None
        Full names; None for all that are not hidden.
    duration_s : float or None
        Longest time [s].

    Returns
    -------
    int
        0 when there are messages of every topic of the list, or with None any at all; 1 otherwise.

    Raises
    ------
    RecordingError
        The bag cannot be made or written.
    """
    require_rosbags()
    # Imported here, because they are slow to import and other commands do not need them.
    from acts_ros.bags.recorder import Recorder
    from acts_ros.bags.writing import BagWriter, require_new
    from acts_ros.clocks import boot_time_s
    from acts_ros.executor import spin_for
    from acts_tools.running.near_names import NOTICE_S, near_topic
    from acts_tools.running.node import command_node
    from acts_tools.running.stopping import StopFlag

    require_new(path)
    with (
        StopFlag() as stop,
        command_node("acts_recorder") as (node, executor),
        # Made when ROS has started, so that nothing is left where it cannot; closed before ROS is shut down, so that it
        # is complete if that fails.
        closing(BagWriter(path, f"acts record {__version__}")) as bag,
    ):
        recorder = Recorder(node, bag, topics, _say)
        _say(f"recording to {path}, Ctrl-C ends it")
        started_s = boot_time_s()
        is_told = False
        with closing(recorder):
            while not stop.is_set and (duration_s is None or boot_time_s() - started_s < duration_s):
                if not is_told and boot_time_s() - started_s > NOTICE_S:
                    is_told = True
                    for topic in recorder.missing():
                        _say(f"not there yet: {topic}, no publisher found{near_topic(node, topic)}")
                recorder.discover()
                spin_for(executor, _TURN_S)
                bag.flush()
            ended_s = boot_time_s()
        hints = {topic: near_topic(node, topic) for topic in recorder.missing()}
    summarise(recorder, bag, hints, started_s, ended_s)
    return 0 if recorder.is_complete else 1


def summarise(recorder: Recorder, bag: BagWriter, hints: Mapping[str, str], started_s: float, ended_s: float) -> None:
    """Say what was recorded and what is missing.

    Parameters
    ----------
    recorder : Recorder
        Closed.
    bag : BagWriter
    hints : mapping of str to str
        Of each topic that never appeared, what may have been meant.
    started_s, ended_s : float
        CLOCK_BOOTTIME [s].
    """
    records = sorted(recorder.records.values(), key=lambda record: record.topic)
    width = max((len(record.topic) for record in records), default=0)
    for record in records:
        lost = "loss not known" if record.lost is None else f"{record.lost} lost"
        lost += f", {counted(record.missing, 'frame')} missing by their numbers" if record.missing else ""
        _say(f"{record.topic:{width}}  {record.received:8d} messages  {lost}")
    for topic in recorder.missing():
        _say(f"never appeared: {topic}, no publisher was found{hints[topic]}")
    for topic in recorder.silent():
        _say(f"no message: {topic} had a publisher, but nothing came")
    for record in records:
        pauses = record.pauses()
        if pauses:
            begin_s, length_s = pauses[0]
            further = f", the longest of {len(pauses)} pauses" if len(pauses) > 1 else ""
            _say(
                f"paused: no message for {length_s:.1f} s from {record.topic}, {begin_s - started_s:.1f} s after the "
                f"start{further}"
            )
        silence_s = record.silent_s(ended_s)
        if silence_s is not None:
            _say(f"ended before: {record.topic} came regularly, but not in the last {silence_s:.1f} s")
    total = sum(record.received for record in records)
    if not total:
        _say("nothing was recorded; the bag is empty and can be deleted")
    _say(f"{counted(total, 'message')} in {ended_s - started_s:.1f} s, {bag.size_bytes() / 1e6:.1f} MB in {bag.path}")


def _say(text: str) -> None:
    print(f"[record] {text}", flush=True)
