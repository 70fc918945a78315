# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Measure several skins: latency from the stamp of a frame to a subscriber's callback, lost frames, CPU and memory.

This process is the subscriber of all skins, with the executor and settings of an ACTS node. While it counts, it only
prints a line per second on a terminal and rarely reads the memory.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping, Sequence
from typing import Any, TextIO

from acts_msgs.msg import Contact
from acts_ros.executor import settle
from acts_ros.qos import STREAM
from acts_tools.bench.machine import BusyMeter
from acts_tools.bench.rigs import realtime
from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.skins.options import SkinsOptions
from acts_tools.bench.skins.processes import BENCH, Consumption, Watched, computing, running_skins
from acts_tools.bench.skins.reports import added, next_counts
from acts_tools.bench.skins.status_line import StatusLine
from acts_tools.bench.skins.stream import ContactStream
from acts_tools.bench.workbench import Workbench

SETTLE_S = 6.0
"""The driver's clock estimate includes the drift after 2.5 s, and has settled after 5 s [s]."""

# At the first start on a machine, all skins compile their kernels at the same time.
_START_TIMEOUT_S = 180.0
_SLICE_S = 0.5
_LINE_EVERY_S = 1.0
# Rarely, because it takes as long as some frames.
_MEMORY_EVERY_S = 10.0


def measure(workbench: Workbench, options: SkinsOptions, terminal: TextIO | None = None) -> dict[str, Any]:
    """Run all processes, and count for ``workbench.seconds``.

    Parameters
    ----------
    workbench : Workbench
        Duration, folder and stop flag.
    options : SkinsOptions
        Numbers of skins and busy loops, and their scheduling.
    terminal : TextIO or None
        Stream for the progress line, if it is a terminal; None for standard error.

    Returns
    -------
    dict
        Figures, as in ``docs/benchmarks.md``.

    Raises
    ------
    LaunchError
        When a process does not start, or ends early.
    """
    with running_skins(workbench.folder, options) as skins, Graph(workbench) as graph:
        streams = {name: ContactStream() for name in options.names}
        for name, stream in streams.items():
            graph.node.create_subscription(Contact, f"/{name}/contact", stream.take, STREAM)
        with realtime.subscriber(options.realtime):
            graph.spin_until(
                lambda: all(stream.ever_received for stream in streams.values()),
                _START_TIMEOUT_S,
                "the first contact of every skin",
                lambda: _check(skins),
            )
        with computing(workbench.folder, options.load) as load:
            watched = [*skins, *load]
            settle()
            # Only after the children were started, because they would inherit it.
            with realtime.subscriber(options.realtime):
                graph.spin_for(min(SETTLE_S, workbench.seconds))
                before = next_counts(graph, options.names, lambda: _check(watched))
                line = StatusLine(workbench.seconds, sys.stderr if terminal is None else terminal)
                report = _count(workbench, graph, streams, watched, line)
                after = next_counts(graph, options.names, lambda: _check(watched))
    for skin in report["skins"]:
        skin |= added(before[skin["name"]], after[skin["name"]])
    return report


def _count(
    workbench: Workbench,
    graph: Graph,
    streams: Mapping[str, ContactStream],
    watched: Sequence[Watched],
    line: StatusLine,
) -> dict[str, Any]:
    """Count for the duration; return figures of contacts, CPU and memory."""
    machine = BusyMeter()
    consumption = Consumption(watched, time.monotonic)
    begin_s = now_s = time.monotonic()
    for stream in streams.values():
        stream.begin(begin_s)
    end_s = begin_s + workbench.seconds
    line_s, memory_s = begin_s + _LINE_EVERY_S, begin_s + _MEMORY_EVERY_S
    while now_s < end_s:
        workbench.check_stop()
        graph.spin_slice(min(_SLICE_S, end_s - now_s))
        now_s = time.monotonic()
        _check(watched)
        if now_s >= line_s:
            line_s += _LINE_EVERY_S
            rates = {name: stream.look(now_s) for name, stream in streams.items()}
            line.show(now_s - begin_s, rates, {name: stream.lost for name, stream in streams.items()})
        if now_s >= memory_s and now_s < end_s:
            memory_s += _MEMORY_EVERY_S
            consumption.note_memory()
    cpu_percent = consumption.cpu_percent()
    machine_percent = machine.percent()
    consumption.note_memory()
    line.clear()
    passed_s = now_s - begin_s
    granted = realtime.granted({BENCH: os.getpid(), **{one.name: one.process.pid for one in watched}})
    return {
        "seconds": round(passed_s, 3),
        "skins": [
            {
                "name": name,
                "received": stream.received,
                "rate_hz": round(stream.received / passed_s, 2),
                "lost": stream.lost,
                "silent_s": round(stream.silent_s, 1),
                "latency_ms": stream.take_latencies_ms(),
            }
            for name, stream in streams.items()
        ],
        "cpu_percent": cpu_percent,
        "others_cpu_percent": round(max(0.0, machine_percent - sum(cpu_percent.values())), 1),
        "rss_mb": consumption.rss_mb(),
        "realtime_granted": granted,
    }


def _check(watched: Sequence[Watched]) -> None:
    for one in watched:
        one.check()
