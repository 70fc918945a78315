# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A guard against real-time threads that never pause, which would block the machine.

Two limits stand behind each other:

- A thread of this module, above the others in priority, looks ten times a second how long each real-time thread of the
  process computed. One that left no tenth of a core for a second runs away: the whole process goes back to the ordinary
  scheduler, goes on, and tells it.
- It cannot look where the runaway keeps the interpreter's lock in a loop in C. Then the kernel's own limit,
  RLIMIT_RTTIME, ends the process, which writes where it hangs. That limit alone would not do: it counts the time since
  a thread last slept, and every exchange of the interpreter's lock is a sleep.
"""

from __future__ import annotations

import faulthandler
import os
import resource
import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from pathlib import Path

from acts_core.runtime.scheduling.time_slices import set_time_slice

LogCallback = Callable[[str, str], None]
"""Takes a level ("info", "warning" or "error") and a sentence."""

# Below the 95 % that the kernel leaves to all real-time threads of a core together: a runaway never has more.
SHARE = 0.9
"""A real-time thread that takes more than this share of a core over `WINDOW_S` runs away."""

WINDOW_S = 1.0
"""How long that is looked at [s]."""

UNBROKEN_S = 2
"""A real-time thread that computes for so long without a single sleep ends the process [s]."""

_PERIOD_S = 0.1
_STANDARD_ERROR = 2
_HIGHEST_PRIORITY = 99
_TASKS = Path("/proc/self/task")


class BudgetWatch:
    """Finds a thread that uses more CPU time than allowed.

    Parameters
    ----------
    share : float
        Of one core; see `SHARE`.
    window_s : float
        See `WINDOW_S` [s].
    """

    def __init__(self, share: float = SHARE, window_s: float = WINDOW_S) -> None:
        self._share = share
        self._window_ns = round(window_s * 1e9)
        self._history: deque[tuple[int, Mapping[int, int]]] = deque()

    def step(self, now_ns: int, used_ns: Mapping[int, int]) -> tuple[int, float] | None:
        """Update by the CPU time that each thread has used so far.

        Parameters
        ----------
        now_ns : int
            Time of the look, on a clock that never goes back [ns].
        used_ns : mapping of int to int
            CPU time [ns] by thread number. A thread is judged once it has been there for a whole window.

        Returns
        -------
        tuple of int and float, or None
            Number of the thread that takes the most and its share of a core, if that is too much.
        """
        history = self._history
        history.append((now_ns, used_ns))
        while len(history) > 1 and history[1][0] <= now_ns - self._window_ns:
            history.popleft()
        then_ns, before = history[0]
        elapsed_ns = now_ns - then_ns
        if elapsed_ns < self._window_ns:
            return None
        shares = {thread: (used - before[thread]) / elapsed_ns for thread, used in used_ns.items() if thread in before}
        most = max(shares, key=shares.__getitem__, default=None)
        return None if most is None or shares[most] <= self._share else (most, shares[most])


class _Guard:
    """The looking thread of this process, and what it knows."""

    def __init__(self, cores: Collection[int]) -> None:
        self._cores = cores
        self._watch = BudgetWatch()
        self._who = ""
        self._log: LogCallback = lambda _level, _sentence: None
        self._thread = threading.Thread(target=self._run, name="acts_rt_guard", daemon=True)
        self.gave_up = ""

    @property
    def thread(self) -> int | None:
        """Number of the looking thread, once it has been started."""
        return self._thread.native_id

    def start(self, priority: int, who: str, log: LogCallback) -> None:
        self._who = who
        self._log = log
        if not self._thread.is_alive():
            _limit_unbroken_runs()
            self._thread.start()
        self._rise_above(priority)

    def _rise_above(self, priority: int) -> None:
        thread = self._thread.native_id
        assert thread is not None  # it has been started
        if _is_realtime(thread) and os.sched_getparam(thread).sched_priority > priority:
            return
        for own in (min(priority + 1, _HIGHEST_PRIORITY), priority):
            # Where only `priority` is allowed, the other cores and the kernel's limit remain.
            with suppress(PermissionError):
                os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(own))
                return

    def _run(self) -> None:
        # Started by a thread that may be bound to the very core that is to be watched.
        with suppress(OSError):
            os.sched_setaffinity(0, self._cores)
        while True:
            time.sleep(_PERIOD_S)
            runaway = self._watch.step(time.monotonic_ns(), _realtime_cpu_ns())
            if runaway is None:
                continue
            thread, share = runaway
            who = self._who
            # First, so that nobody enters again in between.
            self.gave_up = f"real time was given up after {who} had run away"
            demote_process()
            self._log(
                "error",
                f"{who} (thread {thread}) took {share:.0%} of a core for {WINDOW_S:g} s under SCHED_FIFO: "
                "the ordinary scheduler has all of this process now, until it is started anew",
            )
            return


_lock = threading.Lock()
_guard: _Guard | None = None


def guard_process(priority: int, who: str, log: LogCallback, cores: Collection[int]) -> None:
    """Watch over the real-time threads of this process from now on.

    Parameters
    ----------
    priority : int
        Of the threads that are to be watched.
    who : str
        Name of what runs here, in what is told.
    log : callable
        See `LogCallback`; called once, from the guard's thread, when real time is given up.
    cores : collection of int
        Where the guard may run.
    """
    global _guard
    with _lock:
        if _guard is None:
            _guard = _Guard(cores)
        _guard.start(priority, who, log)


def guard_thread() -> int | None:
    """Number of the thread that looks; None where there is none."""
    return None if _guard is None else _guard.thread


def given_up() -> str:
    """Why this process shall not enter real time any more; empty as long as it may."""
    return "" if _guard is None else _guard.gave_up


def demote_process() -> None:
    """Put every real-time thread of this process back on the ordinary scheduler, with its time slices."""
    for path in _TASKS.iterdir():
        with suppress(ProcessLookupError):
            if _is_realtime(int(path.name)):
                os.sched_setscheduler(int(path.name), os.SCHED_OTHER, os.sched_param(0))
        set_time_slice(0, int(path.name))


def _limit_unbroken_runs() -> None:
    # In C, without the interpreter's lock; then the signal has its usual effect, which is the end.
    faulthandler.register(signal.SIGXCPU, file=_STANDARD_ERROR, all_threads=True, chain=True)
    soft_us, hard_us = resource.getrlimit(resource.RLIMIT_RTTIME)
    # The hard limit is SIGKILL, should that hang as well. Whoever set lower ones meant it.
    resource.setrlimit(
        resource.RLIMIT_RTTIME,
        (_lower(soft_us, UNBROKEN_S * 1_000_000), _lower(hard_us, (UNBROKEN_S + 1) * 1_000_000)),
    )


def _lower(limit: int, wanted: int) -> int:
    return wanted if limit == resource.RLIM_INFINITY else min(limit, wanted)


def _is_realtime(thread: int) -> bool:
    return os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK in (os.SCHED_FIFO, os.SCHED_RR)


def _realtime_cpu_ns() -> dict[int, int]:
    used: dict[int, int] = {}
    for path in _TASKS.iterdir():
        thread = int(path.name)
        # It may end between the two lines.
        with suppress(OSError):
            if _is_realtime(thread):
                used[thread] = time.clock_gettime_ns(_cpu_clock(thread))
    return used


def _cpu_clock(thread: int) -> int:
    # As pthread_getcpuclockid makes it, which wants a pthread_t, and that is known of Python's own threads only.
    return ~thread << 3 | 6
