# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Real-time scheduling of the measured processes: their options, and the priorities that the kernel granted."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from acts_core.runtime import RealtimeConfig, demote_process, enter_realtime

BOARD_PRIORITY = 45
SKIN_PRIORITY = 40
SUBSCRIBER_PRIORITY = 35
"""SCHED_FIFO priorities, as in docs/real_time.md; the subscriber has that of a controller."""


def board_options(realtime: bool) -> list[str]:
    """Options of `virtual_board`."""
    return ["--realtime-priority", str(BOARD_PRIORITY)] if realtime else []


def tactile_options(realtime: bool) -> list[str]:
    """Options of `tactile`; the parameters of its driver schedule the whole process."""
    return ["--set", f"driver.realtime_priority={SKIN_PRIORITY}"] if realtime else []


@contextmanager
def subscriber(realtime: bool) -> Iterator[None]:
    """Run this process as a controller runs, in real time if that is chosen; no child may be started in the block.

    Under ordinary scheduling, it could be preempted while it holds a lock of the middleware, and block all publishers.
    """
    enter_realtime(RealtimeConfig(SUBSCRIBER_PRIORITY if realtime else 0), "bench", _tell)
    try:
        yield
    finally:
        demote_process()


def granted(pids: Mapping[str, int]) -> dict[str, int]:
    """SCHED_FIFO priority of the main thread of each process; 0 for ordinary scheduling."""
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
