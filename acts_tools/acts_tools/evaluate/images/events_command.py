# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate events`: bounces, slides and taps of the simulated skin."""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from acts_sim.pressing import EVENT_RATE_HZ, EVENTS, event_recordings
from acts_tools.arguments import at_least_one
from acts_tools.evaluate import report
from acts_tools.evaluate.images import options
from acts_tools.evaluate.images.recovery import Recording
from acts_tools.evaluate.images.tasks import HEADER, evaluate_shown, line, require_methods, require_scored


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate events``."""
    parser = commands.add_parser(
        "events",
        help="score recovery on simulated bounces, slides and taps",
        description="Let simulated objects bounce, slide and tap on the skin, sample them with each scheme and M as "
        "the board does, recover the image by each method, and compare it with the truth. docs/recovery.md explains "
        "the numbers.",
    )
    parser.add_argument("--event", nargs="+", default=list(EVENTS), choices=tuple(EVENTS), help="default: all")
    options.add_arguments(parser, noise_counts=3.0)
    parser.add_argument(
        "--recordings", type=at_least_one, metavar="N", help="per kind (default: enough for steady figures)"
    )
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    tasks = options.tasks(arguments)
    dictionary = options.dictionary(arguments)
    live = np.ones((32, 32), dtype=bool)
    results = options.results(arguments, recordings=arguments.recordings)
    require_methods(tasks, dictionary)
    print(f"{'event':13} {HEADER} {'further p99':>11}")
    for name in arguments.event:
        frames = event_recordings(name, arguments.recordings or EVENTS[name].recordings, arguments.seed)
        recordings = [Recording(one, EVENT_RATE_HZ, live) for one in frames]
        for task in tasks:
            scored = evaluate_shown(recordings, task, dictionary, f"{name}: ")
            further = report.number(scored["notice_further_ms"]["p99"], 11, 1)
            results.add({"event": name, **scored}, f"{name:13} {line(scored)} {further}")
    require_scored(results.entries, ", ".join(arguments.event), tasks[0].touch_counts)
    return 0
