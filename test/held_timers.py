# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process whose Fast DDS hangs."""

from __future__ import annotations

import ctypes
import os
import threading
from concurrent.futures import Future
from pathlib import Path

import pytest
import rclpy

DEADLINE_S = 60.0
# From sys/ptrace.h and sys/wait.h.
SEIZE, INTERRUPT, WALL = 0x4206, 0x4207, 0x40000000


def hold_timers(pid: int) -> None:
    """Let the thread of timers of Fast DDS in a child process stand still, as in a deadlock, while all others run."""
    if not rclpy.get_rmw_implementation_identifier().startswith("rmw_fastrtps"):
        pytest.skip("only Fast DDS has the thread")
    if os.environ.get("ROS_DISTRO") == "humble":
        pytest.skip("on Humble Fast DDS announces a process more rarely, and is not watched")
    tasks = Path(f"/proc/{pid}/task").iterdir()
    (timers,) = (int(task.name) for task in tasks if (task / "comm").read_text().startswith("dds.ev."))
    held: Future[int] = Future()
    threading.Thread(target=_trace, args=(timers, held), daemon=True).start()
    error = held.result(DEADLINE_S)
    if error:
        pytest.skip(f"a thread cannot be held here ({os.strerror(error)}): allow ptrace of child processes")


def _trace(thread: int, held: Future[int]) -> None:
    """Hold a thread to its end, for which its tracer has to wait before its process can end."""
    libc = ctypes.CDLL(None, use_errno=True)
    for request in (SEIZE, INTERRUPT):
        if libc.ptrace(request, thread, None, None):
            held.set_result(ctypes.get_errno())
            return
    os.waitpid(thread, WALL)
    held.set_result(0)
    os.waitpid(thread, WALL)
