# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page: what it costs, how soon and how often it shows touch, and whether the stream notices.

A skin is read at 1 kHz, half of the time with nobody looking, half with four clients and one that takes nothing. Where
playwright and chromium are installed, one of the four is the page in a real browser.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

import numpy as np
import psutil

from acts_msgs.msg import Contact
from acts_ros.processes.packages import executable
from acts_ros.qos import STREAM
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs import realtime, view_browser
from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.rigs.processes import (
    NAMESPACE,
    START_TIMEOUT_S,
    Running,
    check_alive,
    command_line,
    python_module,
    tactile,
    virtual_board,
)
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.rigs.view_clients import Watched
from acts_tools.bench.skins.stream import ContactStream
from acts_tools.bench.workbench import Workbench
from acts_tools.percentiles import percentiles
from acts_tools.process_load import cpu_s

CLIENTS = 4
_SETTLE_S = 3.0
_MB = 1e6
# Programs that watch start, and tell what they have got, in this time besides [s].
_WATCHERS_S = 60.0


def measure(workbench: Workbench, *, is_realtime: bool = False) -> Result:
    """Count contacts without and with clients; watch the server meanwhile.

    Parameters
    ----------
    workbench : Workbench
    is_realtime : bool
        Whether board, skin and subscriber run under SCHED_FIFO, where that is allowed; the page's server never does.
    """
    contacts = ContactStream()
    port = _free_port()
    with (
        virtual_board(
            workbench.folder,
            *["--rate-hz", "1000", *pressed(workbench.folder), *realtime.board_options(is_realtime)],
        ) as board,
        Graph(workbench) as graph,
        tactile(workbench.folder, board.link, NAMESPACE, *realtime.tactile_options(is_realtime)) as skin,
        _server(workbench, port) as server,
    ):

        def check() -> None:
            check_alive(skin, workbench.folder / "tactile.log")
            check_alive(server, workbench.folder / "view.log")

        graph.node.create_subscription(Contact, "contact", contacts.take, STREAM)
        graph.spin_until(lambda: contacts.ever_received, START_TIMEOUT_S, "the first contact", check)
        graph.spin_until(lambda: _listens(port), START_TIMEOUT_S, "the page", check)
        half_s = workbench.seconds / 2
        with realtime.subscriber(is_realtime):
            graph.spin_for(_SETTLE_S)
            alone = _count(contacts, graph, half_s)
        with _watchers(workbench, port, half_s + _SETTLE_S) as watchers:
            with realtime.subscriber(is_realtime):
                graph.spin_for(_SETTLE_S)
                load = _Load(server.pid)
                watched = _count(contacts, graph, half_s)
            load.end()
            graph.spin_until(
                lambda: all(one.poll() is not None for one in watchers.values()), _WATCHERS_S, "the clients' end", check
            )
        got = {name: _told(workbench, name) for name in watchers}
    return _result(alone, watched, load, got)


class _Stretch(NamedTuple):
    """What came of the stream for a while: contacts a second, how many were lost, and how late 99 % were."""

    hz: float
    lost: int
    p99_ms: float | None

    def figures(self, key: str, label: str) -> list[Figure]:
        """As figures."""
        return [
            Figure(f"{key}_hz", f"contacts, {label}", self.hz, "Hz"),
            Figure(f"{key}_lost", "    lost", self.lost),
            Figure(f"{key}_p99_ms", "    stamp to reception, 99 % within", self.p99_ms, "ms"),
        ]


def _count(contacts: ContactStream, graph: Graph, seconds: float) -> _Stretch:
    began_s = time.monotonic()
    contacts.begin(began_s)
    graph.spin_for(seconds)
    hz = contacts.received / (time.monotonic() - began_s)
    return _Stretch(hz, contacts.lost, contacts.take_latencies_ms()["p99"])


class _Load:
    """What a process takes from now until `end`.

    Attributes
    ----------
    percent : float
        CPU [% of a core].
    grown_mb : float
        Growth of its memory [MB].
    """

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._began = time.monotonic(), cpu_s(pid), psutil.Process(pid).memory_info().rss

    def end(self) -> None:
        """It is over."""
        began_s, used_s, memory_bytes = self._began
        self.percent = 100 * (cpu_s(self._pid) - used_s) / (time.monotonic() - began_s)
        self.grown_mb = (psutil.Process(self._pid).memory_info().rss - memory_bytes) / _MB


def _result(alone: _Stretch, watched: _Stretch, load: _Load, got: dict[str, Watched]) -> Result:
    """The figures of both stretches, and what the clients got, by their names."""
    figures = [
        *alone.figures("alone", "nobody looks"),
        *watched.figures("watched", f"{CLIENTS} clients and a stalled one"),
    ]
    if alone.p99_ms and watched.p99_ms:
        ratio = watched.p99_ms / alone.p99_ms
        figures.append(Figure("p99_ratio", "    with to without", ratio, "times", is_ratio=True))
    figures += [
        Figure("server_percent", "server of the page", load.percent, "% of one core"),
        Figure("server_growth_mb", "    growth of its memory meanwhile", load.grown_mb, "MB"),
        *_of_clients("clients", "clients", got["clients"]),
        *_of_clients("browser", "page in a browser", got.get("browser", Watched())),
    ]
    pictures = sum(len(one.images_hz) for one in got.values())
    return Result(figures, [] if pictures == CLIENTS else [f"{pictures} of {CLIENTS} clients got pictures"])


def _of_clients(key: str, label: str, watched: Watched) -> list[Figure]:
    ages = percentiles(np.asarray(watched.age_ms, dtype=np.float64))
    what = "shown" if key == "browser" else "received"
    return [
        Figure(f"{key}_images_hz", f"{label}: images {what}, the fewest", min(watched.images_hz, default=None), "Hz"),
        Figure(f"{key}_first_s", "    first image after", max(watched.first_s, default=None), "s"),
        Figure(f"{key}_age_ms.median", f"    stamp until {what}, median", ages["median"], "ms"),
        Figure(f"{key}_age_ms.p99", "    99 % within", ages["p99"], "ms"),
    ]


def _server(workbench: Workbench, port: int) -> Running:
    words = ["--set", f"view.port={port}", "--set", f"view.skins={NAMESPACE}"]
    return command_line(workbench.folder, "view", [str(executable("acts_view", "view", os.environ)), *words])


@contextmanager
def _watchers(workbench: Workbench, port: int, seconds: float) -> Iterator[dict[str, subprocess.Popen[bytes]]]:
    """Programs that watch for a while, each by the name of the file it writes."""
    rigs = view_browser.__package__
    has_browser = view_browser.browser() is not None
    words = {"clients": [str(CLIENTS - has_browser)], **({"browser": []} if has_browser else {})}
    with ExitStack() as stack:
        yield {
            name: stack.enter_context(
                python_module(
                    workbench.folder,
                    f"{rigs}.view_{name}",
                    [str(port), *more, str(seconds), str(workbench.folder / f"{name}.json")],
                )
            )
            for name, more in words.items()
        }


def _told(workbench: Workbench, name: str) -> Watched:
    file = workbench.folder / f"{name}.json"
    return Watched(**json.loads(file.read_text())) if file.is_file() else Watched()


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
