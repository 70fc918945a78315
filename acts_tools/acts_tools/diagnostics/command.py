# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts diagnostics`: print the newest reports of all nodes; the exit code is the worst level."""

from __future__ import annotations

import argparse
import json
import sys
import time
from functools import partial
from typing import TYPE_CHECKING

from acts_tools.arguments import seconds
from acts_tools.diagnostics.statuses import SILENT_AFTER_S, Statuses

if TYPE_CHECKING:
    from diagnostic_msgs.msg import DiagnosticArray

_TOPICS = ("/diagnostics", "/diagnostics_agg")
# Nodes report once a second, so this long after the first report each has reported.
_ALL_S = 2.2
_TURN_S = 0.1
_DEPTH = 100
_NOBODY = 3

_EPILOG = """\
exit codes: 0 all is OK, 1 a warning, 2 an error, 3 something is stale or silent, or no node reports

examples:
  acts diagnostics                  every node with all its values
  acts diagnostics --brief          one line for each node
  acts diagnostics --json | jq .    for programs
  acts diagnostics --watch 60       names also nodes that fall silent meanwhile; Ctrl-C prints at once

docs/driver.md explains the values of the driver.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``diagnostics`` to the acts command."""
    parser = subparsers.add_parser(
        "diagnostics",
        help="print the diagnostics of the running nodes",
        description="Listen to /diagnostics and /diagnostics_agg for some seconds and print the newest report of each "
        "node: level, message, values.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-b", "--brief", action="store_true", help="without the values")
    parser.add_argument("--json", action="store_true", help="as one JSON object: a list of reports for each topic")
    parser.add_argument(
        "-t",
        "--timeout",
        type=seconds,
        default=10.0,
        metavar="SECONDS",
        help="how long to wait for a first report (default: 10)",
    )
    parser.add_argument(
        "-w",
        "--watch",
        type=seconds,
        default=_ALL_S,
        metavar="SECONDS",
        help=f"how long to listen from the first report on (default: {_ALL_S}); a node that is silent for more than "
        f"{SILENT_AFTER_S:g} s at the end is named as stale",
    )


def run(arguments: argparse.Namespace) -> int:
    """Listen and print; return the worst level, or 3 if no node reports."""
    statuses = _heard(arguments.timeout, arguments.watch)
    if statuses.is_empty:
        print(
            f"no node has reported on {' or '.join(_TOPICS)} within {arguments.timeout:g} s: are nodes running, and "
            "with this ROS_DOMAIN_ID?",
            file=sys.stderr,
        )
        return _NOBODY
    if arguments.json:
        print(json.dumps(statuses.as_json(), indent=2))
    else:
        print("\n".join(statuses.lines(with_values=not arguments.brief)))
    return statuses.worst


def _heard(timeout_s: float, watch_s: float) -> Statuses:
    """Reports of `watch_s` from the first one on; empty if there is none within the timeout."""
    # Imported here, because they are slow to import and other commands do not need them.
    from diagnostic_msgs.msg import DiagnosticArray
    from rclpy.executors import SingleThreadedExecutor

    from acts_ros.executor import spin_for
    from acts_tools.running.node import command_node
    from acts_tools.running.stopping import StopFlag

    statuses = Statuses(_TOPICS)
    with StopFlag() as stop, command_node("acts_diagnostics", SingleThreadedExecutor) as (node, executor):
        for topic in _TOPICS:
            node.create_subscription(DiagnosticArray, topic, partial(_take, statuses, topic), _DEPTH)
        end_s = time.monotonic() + timeout_s
        is_first = True
        while not stop.is_set and time.monotonic() < end_s:
            spin_for(executor, _TURN_S)
            if is_first and not statuses.is_empty:
                is_first, end_s = False, time.monotonic() + watch_s
        if stop.is_set and statuses.is_empty:
            # Not the answer that nobody reports: the time for it is not over.
            raise KeyboardInterrupt
        statuses.tell_silent(time.monotonic())
    return statuses


def _take(statuses: Statuses, topic: str, array: DiagnosticArray) -> None:
    from acts_skins.overview.diagnostics_node import status_of

    for message in array.status:
        statuses.take(topic, status_of(message), time.monotonic())
