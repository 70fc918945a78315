# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""CPU load of a process tree, by process name.

It reads each process's CPU clock, not ``/proc/PID/stat``: where the kernel counts by ticks, a process that wakes 1000
times a second for a tenth of a tick may be counted at none of them, or at all.
"""

from __future__ import annotations

import ctypes
import errno
import os
import time
from collections import defaultdict
from pathlib import Path

import psutil

_LIBC = ctypes.CDLL(None)


class LoadMeter:
    """Measures the mean load of all descendants of a process between `start` and `percent`.

    Parameters
    ----------
    pid : int
        Process id of the root.
    root_name : str
        Name of the root in the result.
    """

    def __init__(self, pid: int, root_name: str = "launch") -> None:
        self._root = psutil.Process(pid)
        self._root_name = root_name
        self._before: dict[psutil.Process, float] = {}
        self._started_s = 0.0

    def start(self) -> None:
        """Start counting. Processes that start later are counted from their start."""
        self._started_s = time.monotonic()
        self._before = {process: _cpu_s(process) for process in self._processes()}

    def percent(self) -> dict[str, float]:
        """Load since `start` by process name [% of one core], without processes that have ended."""
        elapsed_s = max(time.monotonic() - self._started_s, 1e-9)
        loads: dict[str, float] = defaultdict(float)
        for process in self._processes():
            try:
                used_s = _cpu_s(process) - self._before.get(process, 0.0)
                loads[self._root_name if process == self._root else _name(process)] += used_s / elapsed_s * 100
            except psutil.NoSuchProcess:
                continue
        return dict(loads)

    def _processes(self) -> list[psutil.Process]:
        try:
            return [self._root, *self._root.children(recursive=True)]
        except psutil.NoSuchProcess:
            return []


def cpu_s(pid: int) -> float:
    """CPU time of a process, including all its threads, also those that have ended [s].

    Raises
    ------
    ProcessLookupError
        When there is no such process.
    """
    clock = ctypes.c_int32()
    code = _LIBC.clock_getcpuclockid(pid, ctypes.byref(clock))
    if code != 0:
        raise ProcessLookupError(code, os.strerror(code), pid)
    try:
        return time.clock_gettime(clock.value)
    except OSError as error:
        # It has just ended.
        raise ProcessLookupError(errno.ESRCH, os.strerror(errno.ESRCH), pid) from error


def _cpu_s(process: psutil.Process) -> float:
    try:
        return cpu_s(process.pid)
    except ProcessLookupError:
        return 0.0


def _name(process: psutil.Process) -> str:
    """Name of the program: the script or module where an interpreter runs one."""
    words = process.cmdline()
    if not words:
        return process.name()
    interpreted = Path(words[0]).name.startswith("python") and len(words) > 1
    if interpreted and words[1] == "-m" and len(words) > 2:
        return words[2].rpartition(".")[2]
    interpreted = interpreted and not words[1].startswith("-")
    return Path(words[1] if interpreted else words[0]).name
