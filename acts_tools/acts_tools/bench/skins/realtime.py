"""Real time for what is measured: options of the processes, and what the kernel granted of it."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

from acts_core.errors import ActsError
from acts_core.settings import describe
from acts_driver.settings import DriverSettings
from acts_tools.launch.packages import executable

BOARD_PRIORITY = 45
SKIN_PRIORITY = 40
SUBSCRIBER_PRIORITY = 35
"""Priorities under SCHED_FIFO: what stands for hardware first, a consumer of contacts last."""

_HELP_TIMEOUT_S = 10.0


def require_available() -> None:
    """Raise `ActsError` where the programs have no options for real time."""
    missing = []
    if "realtime_priority" not in describe(DriverSettings):
        missing.append("the driver has no parameter realtime_priority")
    board = str(executable("acts_firmware", "virtual_board", os.environ))
    told = subprocess.run([board, "--help"], capture_output=True, text=True, timeout=_HELP_TIMEOUT_S, check=False)
    if "--realtime-priority" not in told.stdout:
        missing.append("virtual_board has no option --realtime-priority")
    if missing:
        raise ActsError(f"--realtime on: not in this build, {' and '.join(missing)}")


def board_options(realtime: bool) -> list[str]:
    """For `virtual_board`."""
    return ["--realtime-priority", str(BOARD_PRIORITY)] if realtime else []


def tactile_options(realtime: bool) -> list[str]:
    """For `tactile`, whose driver's thread does all the work."""
    return ["--set", f"driver.realtime_priority={SKIN_PRIORITY}"] if realtime else []


def enter_subscriber() -> None:
    """Run this process in real time, the threads of the middleware among them, where that is allowed.

    What its threads start later is not: the children of this process were not meant.
    """
    flags = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
    for thread in _threads(os.getpid()):
        try:
            os.sched_setscheduler(thread, flags, os.sched_param(SUBSCRIBER_PRIORITY))
        except (ProcessLookupError, PermissionError):
            # `granted` tells.
            continue


def granted(pids: Mapping[str, int]) -> dict[str, int]:
    """The priority under SCHED_FIFO of each process, by its main thread; 0 for the ordinary scheduler."""
    return {name: _priority(pid) for name, pid in pids.items()}


def _threads(pid: int) -> list[int]:
    try:
        return [int(path.name) for path in Path(f"/proc/{pid}/task").iterdir()]
    except FileNotFoundError:
        return []


def _priority(thread: int) -> int:
    try:
        is_fifo = os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO
        return os.sched_getparam(thread).sched_priority if is_fifo else 0
    except ProcessLookupError:
        return 0
