# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts listen` on one of the machines, and its reports."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from acts_core.errors import LaunchError
from acts_tools.listen.arrivals import Interval
from acts_tools.two_machines.machines import Machine

EVERY_S = 0.2
"""Time between two reports [s]."""

_POLL_S = 0.02
_LOG_LINES = 5


@dataclass(frozen=True)
class Report:
    """One line of `acts listen --json`.

    Attributes
    ----------
    topics : dict of str to Interval
        Intervals of the topics that have appeared.
    complaints : dict of str to str
        Warnings and errors of nodes on /diagnostics, by their names.
    """

    topics: dict[str, Interval]
    complaints: dict[str, str]

    def received(self, topic: str) -> int:
        """Messages since the start."""
        return self.topics[topic].total_received if topic in self.topics else 0

    def lost(self, topic: str) -> int:
        """Missing messages since the start."""
        return self.topics[topic].total_lost or 0 if topic in self.topics else 0


class Listener:
    """Reads the reports of a running `acts listen`.

    Parameters
    ----------
    path : Path
        File of its output.
    check : callable
        Raises an error when waiting is useless.
    """

    def __init__(self, path: Path, check: Callable[[], None]) -> None:
        self._path = path
        self._check = check
        self._position = 0
        self._rest = b""

    def wait_for(self, condition: Callable[[Report], bool], timeout_s: float, what: str) -> Report:
        """The first report from now on for which a condition is true.

        Raises
        ------
        LaunchError
            There is none within `timeout_s` [s].
        """
        self._new()
        deadline_s = time.monotonic() + timeout_s
        while True:
            for report in self._new():
                if condition(report):
                    return report
            self._check()
            if time.monotonic() > deadline_s:
                raise LaunchError(f"waited {timeout_s:g} s in vain for {what}: {self._end()}")
            time.sleep(_POLL_S)

    def collect(self, count: int, timeout_s: float) -> list[Report]:
        """The next reports, without the present one, whose interval has already begun."""
        reports: list[Report] = []

        def is_enough(report: Report) -> bool:
            reports.append(report)
            return len(reports) > count

        self.wait_for(is_enough, timeout_s, f"{count} reports")
        return reports[1:]

    def _new(self) -> list[Report]:
        with self._path.open("rb") as file:
            file.seek(self._position)
            data = file.read()
        self._position += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [_parse(line) for line in lines if line.startswith(b"{")]

    def _end(self) -> str:
        return " / ".join(self._path.read_text(errors="replace").splitlines()[-_LOG_LINES:])


def _parse(line: bytes) -> Report:
    values = json.loads(line)
    return Report({topic: Interval(**interval) for topic, interval in values["topics"].items()}, values["complaints"])


@contextmanager
def listener(
    machine: Machine,
    topics: Sequence[str],
    domain_id: int,
    log: Path,
    variables: Mapping[str, str] = MappingProxyType({}),
) -> Iterator[Listener]:
    """Listen on a machine for the length of a block, with additional environment variables."""
    words = [sys.executable, "-m", "acts_tools", "listen", "--json", "--every", str(EVERY_S), *topics]
    with machine.running(words, domain_id, log, variables) as process:

        def check() -> None:
            if process.poll() is not None:
                raise LaunchError(f"`acts listen` ended early: {log.read_text(errors='replace')[-500:]}")

        yield Listener(log, check)
