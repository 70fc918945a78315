# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The processes of several skins."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil

from acts_core.errors import LaunchError
from acts_tools.bench.rigs.memory import JUDGED_S, Memory
from acts_tools.bench.rigs.processes import check_alive, command_line, tactile, virtual_board
from acts_tools.bench.rigs.realtime import board_options, tactile_options
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.skins.options import SkinsOptions
from acts_tools.process_load import cpu_s

RATE_HZ = 1000.0
BENCH = "bench"
"""Name of this process, which receives the contacts."""

_MB = 1e6


@dataclass(frozen=True)
class Watched:
    """A process that runs during the measurement.

    Attributes
    ----------
    name : str
        Program and skin.
    process : subprocess.Popen
        The process.
    log : Path
        Log with its standard error.
    """

    name: str
    process: subprocess.Popen[bytes]
    log: Path

    def check(self) -> None:
        """Raise `LaunchError` with the end of its log if it has ended."""
        check_alive(self.process, self.log, self.name)


@contextmanager
def running_skins(folder: Path, options: SkinsOptions) -> Iterator[list[Watched]]:
    """Run a virtual board and a process `tactile` for every skin; stop all at the end of the block."""
    field = pressed(folder)
    with ExitStack() as stack:
        watched: list[Watched] = []
        links: list[Path] = []
        for number, name in enumerate(options.names, 1):
            own = folder / name
            own.mkdir()
            words = ["--rate-hz", str(RATE_HZ), "--seed", str(number), "--board-id", str(number)]
            board = stack.enter_context(virtual_board(own, *words, *field, *board_options(options.realtime)))
            watched.append(Watched(f"virtual_board {name}", board.process, own / "virtual_board.log"))
            links.append(board.link)
        for name, link in zip(options.names, links, strict=True):
            own = folder / name
            process = stack.enter_context(tactile(own, link, f"/{name}", *tactile_options(options.realtime)))
            watched.append(Watched(f"tactile {name}", process, own / "tactile.log"))
        try:
            yield watched
        finally:
            # Signal all of them first, so that they end concurrently, and before their boards.
            for one in watched[options.skins :]:
                one.process.terminate()


@contextmanager
def computing(folder: Path, count: int) -> Iterator[list[Watched]]:
    """Run processes with busy loops, at ordinary priority."""
    with ExitStack() as stack:
        watched: list[Watched] = []
        for number in range(1, count + 1):
            name = f"load {number}"
            process = stack.enter_context(command_line(folder, name, [sys.executable, "-c", "while True: pass"]))
            watched.append(Watched(name, process, folder / f"{name}.log"))
        yield watched


class Consumption:
    """CPU and memory of processes, including this one, since construction.

    Parameters
    ----------
    watched : sequence of Watched
        Other processes; they must not end.
    clock : callable
        Returns the time [s].
    """

    def __init__(self, watched: Sequence[Watched], clock: Callable[[], float]) -> None:
        self._clock = clock
        self._processes = {BENCH: os.getpid(), **{one.name: one.process.pid for one in watched}}
        self._memory = {name: Memory() for name in self._processes}
        self._begin_s = clock()
        self.note_memory()
        self._begin_s = clock()
        self._cpu_before_s = self._cpu_s()

    def note_memory(self) -> None:
        """Read the memory of all processes, which takes some hundred microseconds."""
        passed_s = self._clock() - self._begin_s
        for name, pid in self._processes.items():
            try:
                self._memory[name].mb.append(psutil.Process(pid).memory_info().rss / _MB)
            except psutil.NoSuchProcess as error:
                raise LaunchError(f"{name} ended while it was measured") from error
            self._memory[name].time_s.append(passed_s)

    def cpu_percent(self) -> dict[str, float]:
        """Mean load of each process so far [% of one core]."""
        passed_s = max(self._clock() - self._begin_s, 1e-9)
        return {
            name: round((used_s - self._cpu_before_s[name]) / passed_s * 100, 2)
            for name, used_s in self._cpu_s().items()
        }

    def rss_mb(self) -> dict[str, dict[str, float | None]]:
        """Resident memory at the start and at the end [MB], and its growth after the first tenth [MB/h].

        The growth is None where the time is too short for it.
        """
        return {
            name: {
                "start": round(memory.mb[0], 2),
                "end": round(memory.mb[-1], 2),
                "growth_mb_per_h": round(memory.growth_mb_per_h(), 2) if memory.time_s[-1] >= JUDGED_S else None,
            }
            for name, memory in self._memory.items()
        }

    def _cpu_s(self) -> dict[str, float]:
        used: dict[str, float] = {}
        for name, pid in self._processes.items():
            try:
                used[name] = cpu_s(pid)
            except ProcessLookupError as error:
                raise LaunchError(f"{name} ended while it was measured") from error
        return used
