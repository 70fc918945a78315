# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver for ten minutes at 1 kHz and M = 55: lost frames, memory, CPU, latency.

The memory of the driver's process is read every second. Its growth is the slope of a line fitted to all values but the
first tenth, in which buffers fill and kernels are loaded.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import psutil
from diagnostic_msgs.msg import DiagnosticArray

from acts_core.runtime import StreamCounter
from acts_msgs.msg import TactileSamples
from acts_ros.messages import seconds_of
from acts_ros.qos import STREAM
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.rigs.memory import GROWTH_MAX_MB_PER_H, JUDGED_S, Memory
from acts_tools.bench.rigs.processes import NAMESPACE, START_TIMEOUT_S, check_alive, driver, virtual_board
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.workbench import Workbench
from acts_tools.driver.status import driver_values
from acts_tools.percentiles import percentiles
from acts_tools.process_load import cpu_s

_SETTLE_S = 3.0
_MB = 1e6
_COUNTERS = ("frames", "lost", "overruns", "discarded", "crc_errors", "malformed", "repeated", "restarts", "reconnects")
_NAMES = {"median": "stamp to reception, median", "p99": "    99 % within", "p999": "    99.9 % within"}


class _Status(NamedTuple):
    """What the driver has counted until a time [s]."""

    time_s: float
    counts: dict[str, int]


def measure(workbench: Workbench) -> Result:
    """Run virtual board and driver, receive every message, and read the driver's memory once a second."""
    statuses: deque[_Status] = deque(maxlen=1)
    counter = StreamCounter()
    memory = Memory()

    def keep(message: DiagnosticArray) -> None:
        values = driver_values(message, NAMESPACE)
        if values is not None and values["state"] == "active":
            counts = {name: int(values[name]) for name in _COUNTERS}
            statuses.append(_Status(seconds_of(message.header.stamp), counts))

    def count(message: TactileSamples) -> None:
        counter.step(message.sequence, time.time() - seconds_of(message.header.stamp))

    with (
        virtual_board(workbench.folder, "--rate-hz", "1000", *pressed(workbench.folder)) as board,
        Graph(workbench) as graph,
        driver(workbench.folder, board.link) as process,
    ):

        def check() -> None:
            check_alive(process, workbench.folder / "driver.log")

        graph.node.create_subscription(DiagnosticArray, "/diagnostics", keep, 10)
        graph.node.create_subscription(TactileSamples, "samples", count, STREAM)
        graph.spin_until(lambda: counter.received, START_TIMEOUT_S, "the first message", check)
        graph.spin_for(_SETTLE_S)
        before = _next_status(graph, statuses, check)
        cpu_before_s, received_before, lost_before = cpu_s(process.pid), counter.received, counter.lost
        counter.take_latencies()
        passed_s = _watch(memory, process.pid, graph, workbench.seconds, check)
        cpu_percent = (cpu_s(process.pid) - cpu_before_s) / passed_s * 100
        received, missed = counter.received - received_before, counter.lost - lost_before
        latencies_ms = np.asarray(counter.take_latencies(), dtype=np.float64) * 1e3
        after = _next_status(graph, statuses, check)
    added = {name: after[name] - before[name] for name in _COUNTERS}
    figures = [
        Figure("frames_sent", "frames the board made", added["frames"] + added["lost"]),
        Figure("frames_read", "    read by the driver", added["frames"]),
        Figure("frames_lost", "    lost before the driver", added["lost"]),
        Figure("overruns", "        of them dropped by the board, as it says", added["overruns"]),
        Figure("discarded", "        of them thrown away by a driver that was too late", added["discarded"]),
        Figure("received", "messages received by this process", received),
        Figure("not_received", "    numbers missing between them", missed),
        Figure("damaged", "damaged packets", added["crc_errors"] + added["malformed"]),
        Figure("reconnects", "reconnections", added["reconnects"]),
        *_memory_figures(memory, passed_s),
        Figure("driver_percent", "driver", cpu_percent, "% of one core"),
        *(Figure(f"latency_ms.{name}", _NAMES[name], value, "ms") for name, value in percentiles(latencies_ms).items()),
    ]
    return Result(figures, problems(added, memory, workbench.seconds))


def _watch(memory: Memory, pid: int, graph: Graph, seconds: float, check: Callable[[], None]) -> float:
    """Receive messages, and read a process's memory each second and at the end; how long that took [s]."""
    watched = psutil.Process(pid)
    begin_s = time.monotonic()

    def read() -> float:
        passed_s = time.monotonic() - begin_s
        memory.time_s.append(passed_s)
        memory.mb.append(watched.memory_info().rss / _MB)
        return passed_s

    while time.monotonic() - begin_s < seconds:
        passed_s = read()
        graph.spin_for(min(1.0, max(seconds - passed_s, 0.0)))
        check()
    return read()


def problems(added: dict[str, int], memory: Memory, seconds: float) -> list[str]:
    """Failures; being slow is not one.

    Parameters
    ----------
    added : dict of str to int
        Counts of the driver.
    memory : Memory
        Memory of the driver.
    seconds : float
        Duration of the measurement [s].
    """
    found = []
    unexplained = added["lost"] - added["overruns"] - added["discarded"]
    if unexplained > 0:
        found.append(f"{unexplained} frames were lost between board and driver")
    for name in ("crc_errors", "malformed", "repeated", "restarts", "reconnects"):
        if added[name]:
            found.append(f"the driver counted {added[name]} {name} on an undisturbed line")
    growth = memory.growth_mb_per_h()
    if seconds >= JUDGED_S and growth > GROWTH_MAX_MB_PER_H:
        found.append(f"the driver's memory grows by {growth:.1f} MB an hour")
    return found


def _memory_figures(memory: Memory, passed_s: float) -> list[Figure]:
    minutes = [
        Figure(f"rss_mb.minute_{minute}", f"    after {minute} min", memory.at(60.0 * minute), "MB")
        for minute in range(1, int(passed_s // 60) + 1)
    ]
    return [
        Figure("rss_mb.start", "driver's memory at the start", memory.mb[0], "MB"),
        *minutes,
        Figure("rss_mb.end", "    at the end", memory.mb[-1], "MB"),
        Figure("rss_growth_mb_per_h", "    growth, behind the first tenth", memory.growth_mb_per_h(), "MB/h"),
    ]


def _next_status(graph: Graph, statuses: deque[_Status], check: Callable[[], None]) -> dict[str, int]:
    """What the driver reports from now on; on a busy machine reports from before may come yet."""
    since_s = time.time()
    graph.spin_until(
        lambda: statuses and statuses[-1].time_s >= since_s, START_TIMEOUT_S, "a report of the driver", check
    )
    return statuses[-1].counts
