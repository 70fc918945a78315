# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process whose middleware hangs ends, so that a new one, or its spare, takes its place.

Fast DDS can deadlock where other processes come and go (https://github.com/eProsima/Fast-DDS/issues/6502). The process
runs on, and announces itself no more: after 20 s no other process knows it, and nothing tells anybody. But its thread
of timers never wakes again, which wakes twice a second otherwise, to announce the process (`network` of acts_config).
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from acts_ros.middleware import announces_often

PERIOD_S = 1.0
"""Time between two looks [s]."""

PATIENCE = 10
"""So many looks in a row without a wake-up are a hang.

Looks, not seconds: a process that was held is not ended. They take half of the 20 s after which other processes give
this one up.
"""

_TASKS = Path("/proc/self/task")
_TIMERS = "dds.ev."
_SWITCHES = "ctxt_switches:"
_PRINTING_S = 1.0


def watch_middleware(environment: Mapping[str, str]) -> None:
    """Watch the middleware of this process, which is initialised, to its end, on a thread of its own.

    Does nothing where it is not known how often the middleware announces the process: with another middleware than
    Fast DDS, a profile of the user's, and on Humble.
    """
    if not announces_often(environment):
        return
    timers = []
    for task in _TASKS.iterdir():
        # A thread may just have ended.
        with suppress(OSError):
            if (task / "comm").read_text().startswith(_TIMERS):
                timers.append(task)
    if timers:
        threading.Thread(target=_watch, args=(timers,), name="acts_dds_watch", daemon=True).start()


class Silence:
    """Counts the looks in a row at which one of some threads had not run since the look before."""

    def __init__(self) -> None:
        self._before: Mapping[Path, int] = {}
        self._looks: dict[Path, int] = {}

    def step(self, switches: Mapping[Path, int]) -> int:
        """Take how often each thread has gone to sleep or was interrupted so far; the looks of the most silent one."""
        for thread, count in switches.items():
            silent = self._before.get(thread) == count
            self._looks[thread] = self._looks.get(thread, 0) + 1 if silent else 0
        self._before = switches
        return max(self._looks.values())


def _watch(timers: Sequence[Path]) -> None:
    silence = Silence()
    try:
        while silence.step({timer: _switches(timer) for timer in timers}) < PATIENCE:
            time.sleep(PERIOD_S)
    except OSError:
        # A thread has ended, and the middleware with it.
        return
    _end()


def _switches(task: Path) -> int:
    """How often a thread has gone to sleep or was interrupted so far."""
    return sum(int(line.split()[1]) for line in (task / "status").read_text().splitlines() if _SWITCHES in line)


def _end() -> NoReturn:
    # Not in order: the middleware would not come to its end. The rest may hang too, as where a terminal is held.
    words = (
        f"error: Fast DDS hangs: its timers have not run for {PATIENCE * PERIOD_S:g} s, so that other processes lose "
        "this one. It ends; start it again where no launch file does (docs/faults.md)"
    )
    printing = threading.Thread(target=print, args=(words,), kwargs={"file": sys.stderr, "flush": True}, daemon=True)
    printing.start()
    printing.join(_PRINTING_S)
    os._exit(1)
