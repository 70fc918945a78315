# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts play`: publish the messages of a bag."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from acts_core.words import counted
from acts_ros.bags import require_rosbags
from acts_tools.arguments import real

_EPILOG = """\
examples:
  acts play touch                                       all of it, once
  acts play touch --rate 0.5 --loop                     half as fast, again and again
  acts play touch -t /plate/contact --start-offset 20   one topic, from 20 s after the beginning on

docs/bags.md says which bags are read.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``play`` to the acts command."""
    parser = subparsers.add_parser(
        "play",
        help="publish a bag's messages again",
        description="Publish a bag's messages at the pace and with the quality of service of their recording. "
        "Reads bags of `acts record` and of ROS 2, also those whose recorder was killed.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("bag", type=Path, metavar="BAG", help="folder of the bag, or its .mcap or .db3 file")
    parser.add_argument("-r", "--rate", type=real(1e-3), default=1.0, help="speed, 2 is twice as fast (default: 1)")
    parser.add_argument("-l", "--loop", action="store_true", help="start again at the end, until Ctrl-C")
    parser.add_argument(
        "--start-offset",
        type=real(0.0),
        default=0.0,
        metavar="SECONDS",
        help="begin so long after the bag's beginning; with --loop, each time (default: 0)",
    )
    parser.add_argument("-t", "--topics", nargs="+", metavar="TOPIC", help="only these topics")
    parser.add_argument(
        "--delay",
        type=real(0.0),
        default=1.0,
        metavar="SECONDS",
        help="wait this long before the first message, so that subscribers find the topics (default: 1)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run ``acts play``; return 0 when the bag was played to its end or until Ctrl-C."""
    topics = None if arguments.topics is None else [f"/{name.lstrip('/')}" for name in arguments.topics]
    play(arguments.bag, arguments.rate, arguments.loop, topics, arguments.delay, arguments.start_offset)
    return 0


def play(path: Path, rate: float, loop: bool, topics: list[str] | None, delay_s: float, offset_s: float = 0.0) -> None:
    """Play a bag.

    Parameters
    ----------
    path : Path
        Folder of the bag, or an MCAP file.
    rate : float
        Speed; 2 plays twice as fast.
    loop : bool
        Start again at the end, until the user stops it.
    topics : list of str or None
        Full names; None for all.
    delay_s : float
        Time before the first message [s].
    offset_s : float
        Leave out so much of the bag's beginning [s].

    Raises
    ------
    RecordingError
        There is no bag, a topic is not in it, nothing is in it after the offset, or it is damaged (after the readable
        messages have been played).
    """
    require_rosbags()
    # Imported here, because they are slow to import and other commands do not need them.
    from acts_ros.bags.reading import open_bag
    from acts_tools.bags.player import Player
    from acts_tools.running.node import command_node
    from acts_tools.running.stopping import StopFlag

    with open_bag(path) as bag, StopFlag() as stop, command_node("acts_player") as (node, _):
        if bag.note is not None:
            _say(bag.note)
        player = Player(node, bag, topics, _say, offset_s)
        started_s = time.monotonic() + delay_s
        try:
            going = stop.sleep_until(started_s)
            while going:
                before = player.report.published
                # A bag without messages also ends a loop.
                going = player.play(rate, stop.sleep_until) and loop and player.report.published > before
        finally:
            player.finish()
            report = player.report
            _say(
                f"{counted(report.published, 'message')} in {max(0.0, time.monotonic() - started_s):.1f} s, "
                f"at most {report.worst_lateness_s * 1e3:.1f} ms late"
            )


def _say(text: str) -> None:
    print(f"[play] {text}", flush=True)
