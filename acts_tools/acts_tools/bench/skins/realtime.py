"""Real time for what is measured: options of the processes, and what the kernel granted of it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from acts_core.runtime import RealtimeConfig, demote_process, enter_realtime

BOARD_PRIORITY = 45
SKIN_PRIORITY = 40
SUBSCRIBER_PRIORITY = 35
"""Priorities under SCHED_FIFO, as in docs/real_time.md; a subscriber has that of a controller."""


def board_options(realtime: bool) -> list[str]:
    """For `virtual_board`."""
    return ["--realtime-priority", str(BOARD_PRIORITY)] if realtime else []


def tactile_options(realtime: bool) -> list[str]:
    """For `tactile`, all of which is scheduled as its driver asks."""
    return ["--set", f"driver.realtime_priority={SKIN_PRIORITY}"] if realtime else []


@contextmanager
def subscriber(realtime: bool) -> Iterator[None]:
    """Run this process in real time, where that is asked for and allowed; no child is to be started meanwhile.

    One under the ordinary scheduler that is put aside while it has a lock of the middleware holds up all publishers.
    """
    enter_realtime(RealtimeConfig(SUBSCRIBER_PRIORITY if realtime else 0), "bench", _tell)
    try:
        yield
    finally:
        if realtime:
            demote_process()


def granted(pids: Mapping[str, int]) -> dict[str, int]:
    """The priority under SCHED_FIFO of each process, by its main thread; 0 for the ordinary scheduler."""
    return {name: _priority(pid) for name, pid in pids.items()}


def _priority(pid: int) -> int:
    try:
        is_fifo = os.sched_getscheduler(pid) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO
        return os.sched_getparam(pid).sched_priority if is_fifo else 0
    except ProcessLookupError:
        return 0


def _tell(level: str, sentence: str) -> None:
    if level != "info":
        print(f"{level}: {sentence}", file=sys.stderr, flush=True)
