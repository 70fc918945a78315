# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Real-time scheduling of a process: priority, cores, and a message about what is in force.

Without a priority, threads have short time slices of the ordinary scheduler. What the machine does not allow is
reported, and the process goes on without it: late data is better than none. `realtime_guard` stops a thread that never
pauses.
"""

from __future__ import annotations

import ctypes
import os
import resource
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

from acts_core.errors import SettingsError
from acts_core.runtime.scheduling.realtime_guard import LogCallback, given_up, guard_process, guard_thread
from acts_core.runtime.scheduling.time_slices import SHORTEST_NS, set_time_slice
from acts_core.settings import setting, validate

# As the process was started, for instance by taskset: later its main thread may itself be bound to some of them.
_CORES = frozenset(os.sched_getaffinity(0))

NO_CORES = "none"
"""What a launch file gives where no cores are chosen; means the same as empty."""

_TASKS = Path("/proc/self/task")

# Longer than the kernel takes to put a new thread among the tasks.
_START_OF_A_THREAD_S = 1e-3

# Of sys/mman.h. On fault: pages are locked when they are touched, and not filled for it.
_MCL_CURRENT, _MCL_FUTURE, _MCL_ONFAULT = 1, 2, 4
_CAP_IPC_LOCK = 14


@dataclass(frozen=True)
class RealtimeConfig:
    """How the threads of the hot path are scheduled; to be inherited by the settings of what has such threads.

    Attributes
    ----------
    realtime_priority : int
        1 to 99 under SCHED_FIFO; 0 for the ordinary scheduler.
    cpu_affinity : str
        Numbers of cores and ranges of them, separated by commas; empty or none for any core.

    Raises
    ------
    SettingsError
        When made with a value out of range, or with a core that this process may not run on.
    """

    realtime_priority: int = setting(
        0,
        "priority under SCHED_FIFO, where the limits allow it, see docs/real_time.md; 0: the ordinary scheduler",
        minimum=0,
        maximum=99,
    )
    cpu_affinity: str = setting("", "cores to run on, as in 0,2-3; a single one needs a comma (2,); empty or none: any")

    def __post_init__(self) -> None:
        validate(self)
        parse_cores(self.cpu_affinity)

    @property
    def cores(self) -> frozenset[int]:
        """The cores of `cpu_affinity`; empty for any."""
        return parse_cores(self.cpu_affinity)


def parse_cores(text: str, allowed: Collection[int] = _CORES) -> frozenset[int]:
    """Numbers of cores from a text such as ``0,2-3``; blanks and empty parts do not count.

    Raises
    ------
    SettingsError
        When the text is none such, or names a core that is not `allowed`.
    """
    cores: set[int] = set()
    if text.strip() == NO_CORES:
        return frozenset()
    for part in filter(None, (part.strip() for part in text.split(","))):
        first, dash, last = part.partition("-")
        if not first.isdecimal() or (dash and not last.isdecimal()):
            raise SettingsError(f"cpu_affinity = {text!r}: allowed are cores and ranges, as in 0,2-3; {part!r} is none")
        begin, end = int(first), int(last or first)
        # Looked at before the range is made: that of a slip of the keyboard would be gigantic.
        if begin > end or begin not in allowed or end not in allowed:
            raise SettingsError(
                f"cpu_affinity = {text!r}: {part!r} is not among those allowed, {format_cores(allowed)}"
            )
        cores.update(range(begin, end + 1))
    if not cores.issubset(allowed):
        raise SettingsError(f"cpu_affinity = {text!r}: this process may run on the cores {format_cores(allowed)} only")
    return frozenset(cores)


def format_cores(cores: Collection[int]) -> str:
    """The shortest text that `parse_cores` reads as these cores, such as ``0,2-3``."""
    runs: list[list[int]] = []
    for core in sorted(cores):
        if runs and core == runs[-1][1] + 1:
            runs[-1][1] = core
        else:
            runs.append([core, core])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in runs)


def enter_realtime(config: RealtimeConfig, who: str, log: LogCallback) -> None:
    """Schedule all threads of this process, and those that they start from now on, as `config` asks.

    Under the ordinary scheduler they have the shortest time slices (see `time_slices`).

    All of them, and not only the one that must not be late: it shares Python's lock with the others, and waits for
    whichever has it and was put aside for some other program. The middleware's threads stand before the executor's too.

    To be called when what takes long only once, such as compiling, is over. Never raises for a missing right: `log`
    then takes a warning with the reason, and otherwise one line that says how the process runs. Nothing is logged where
    nothing is asked for. Called again, it holds for all threads again.

    Parameters
    ----------
    config : RealtimeConfig
        What is asked for.
    who : str
        Name of what runs here, in what is told.
    log : callable
        See `LogCallback`. Also called from another thread, should the guard end real time.
    """
    done: list[str] = []
    problems: list[str] = []
    # Also if a priority is asked for: it may be refused.
    for thread in _threads():
        set_time_slice(SHORTEST_NS, thread)
    if config.realtime_priority:
        problem = given_up() or _set_priority(config.realtime_priority)
        if problem:
            problems.append(problem)
            done.append("ordinary scheduler")
        else:
            guard_process(config.realtime_priority, who, log, _CORES)
            done.append(f"SCHED_FIFO priority {config.realtime_priority}")
            if _lock_memory():
                done.append("memory locked")
    if config.cores:
        problem = _set_cores(config.cores)
        if problem:
            problems.append(problem)
        else:
            done.append(f"cores {format_cores(config.cores)}")
    if not done and not problems:
        return
    level = "warning" if problems else "info"
    log(level, f"{who}: " + ", ".join(done) + "".join(f"; {problem}" for problem in problems))


def _threads() -> Iterator[int]:
    """All of them but the guard, and those that they start until the last has been given."""
    given = {guard_thread()}
    pauses = 0
    while pauses < 2:
        new = {int(path.name) for path in _TASKS.iterdir()} - given
        yield from new
        given |= new
        if not new:
            # A thread has the scheduling of the one that starts it some time before it is among the tasks.
            time.sleep(_START_OF_A_THREAD_S)
            pauses += 1


def _set_priority(priority: int) -> str:
    """Why it cannot be; empty where it is in force."""
    for thread in _threads():
        try:
            os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
        except ProcessLookupError:
            continue  # it has ended meanwhile
        except PermissionError:
            return _refusal(priority)
        except OSError as error:
            return f"the kernel refuses SCHED_FIFO ({error.strerror})"
    return ""


def _refusal(priority: int) -> str:
    limit, _ = resource.getrlimit(resource.RLIMIT_RTPRIO)
    if limit != resource.RLIM_INFINITY and limit < priority:
        return (
            f"no more than priority {limit} is allowed and {priority} is asked for (`ulimit -r`); "
            "`acts doctor` tells the command that mends it"
        )
    return (
        "the kernel refuses SCHED_FIFO although the limits allow it: a container or control group forbids it; "
        "`acts doctor` tells more"
    )


def _set_cores(cores: frozenset[int]) -> str:
    for thread in _threads():
        try:
            os.sched_setaffinity(thread, cores)
        except ProcessLookupError:
            continue
        except OSError as error:
            return f"it cannot be bound to the cores {format_cores(cores)} ({error.strerror})"
    return ""


def _lock_memory() -> bool:
    """Keep the pages of this process in memory, where that has no limit: beyond one, allocations would fail."""
    limit, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    if limit != resource.RLIM_INFINITY and not _has_capability(_CAP_IPC_LOCK):
        return False
    return bool(ctypes.CDLL(None).mlockall(_MCL_CURRENT | _MCL_FUTURE | _MCL_ONFAULT) == 0)


def _has_capability(number: int) -> bool:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("CapEff:"):
            return bool(int(line.split()[1], 16) >> number & 1)
    return False
