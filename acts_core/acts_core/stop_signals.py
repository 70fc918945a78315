# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""SIGINT, SIGTERM and SIGHUP as one request to stop; further signals have no effect.

A program that ends motion must not be interrupted while it does so. Python's own answer to SIGINT, an exception in the
main thread wherever that is, interrupts it; a second signal does so again. Here a signal is an exception only while
nothing is under way yet (`interrupting`), and later a callback from a thread of its own, once.
"""

from __future__ import annotations

import _thread
import faulthandler
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import FrameType

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

# As the process was started: later `StopSignals.ended` has it ignored, too.
_NOHUP = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN

LAST_RESORT_S = 9.0
"""A program that has not ended so long after the first signal writes where it hangs and exits with code 1 [s].

A second before ``ros2 launch`` would kill it without a word.
"""

LAST_RESORT_VARIABLE = "ACTS_LAST_RESORT_S"
"""Environment variable by which a launcher that kills sooner says so; a number of seconds."""

_AGAIN_S = 0.05
"""After an interruption was lost in a library, it is tried again this much later [s]."""


def signal_name(number: int) -> str:
    """Name of a signal for people; most of the real-time signals have none."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def last_resort_s_of(environment: Mapping[str, str]) -> float:
    """The time of the last resort [s]; a variable that holds no such time is as good as none."""
    try:
        given_s = float(environment.get(LAST_RESORT_VARIABLE, LAST_RESORT_S))
    except ValueError:
        return LAST_RESORT_S
    return given_s if 0.0 < given_s < LAST_RESORT_S else LAST_RESORT_S


class StopSignals:
    """Takes the stop signals of this process, from its making on. For the main thread.

    A SIGHUP that is ignored from the start of the process, as under nohup, stays so.

    Parameters
    ----------
    last_resort_s : float or None
        See `LAST_RESORT_S`; None: as `LAST_RESORT_VARIABLE` says, or that.
    """

    def __init__(self, last_resort_s: float | None = None) -> None:
        self._last_resort_s = last_resort_s_of(os.environ) if last_resort_s is None else last_resort_s
        self._lock = threading.Lock()
        self._is_set = False
        # Seen by the handler already: the thread that calls back may be late on a busy machine.
        self._came = False
        self._first: signal.Signals | None = None
        self._called = False
        self._interrupts = False
        self._interrupted = False
        self._on_stop: Callable[[], None] | None = None
        # The interpreter writes to it from its handler in C, whatever the main thread is busy with.
        read_end, self._write_end = os.pipe2(os.O_CLOEXEC)
        os.set_blocking(self._write_end, False)
        signal.set_wakeup_fd(self._write_end, warn_on_full_buffer=False)
        for number in STOP_SIGNALS:
            if number is signal.SIGHUP and _NOHUP:
                continue
            signal.signal(number, self._handle)
            # Libraries whose system calls would fail with EINTR are not to notice.
            signal.siginterrupt(number, False)
        # The first line of a program may have them blocked (scripts/bootstrap.py): those that came meanwhile come now.
        signal.pthread_sigmask(signal.SIG_UNBLOCK, STOP_SIGNALS)
        threading.Thread(target=self._watch, args=(read_end,), name="acts_signals", daemon=True).start()

    @property
    def is_set(self) -> bool:
        """Whether a signal has come."""
        return self._is_set or self._came

    @property
    def first(self) -> signal.Signals | None:
        """The first signal; None before it. A terminal sends SIGINT and SIGHUP to all its processes."""
        return self._first

    def on_stop(self, callback: Callable[[], None]) -> None:
        """Call this once when a signal comes, from another thread; at once where one has come already."""
        with self._lock:
            self._on_stop = callback
            if not self.is_set:
                return
            self._called = True
        callback()

    @contextmanager
    def interrupting(self) -> Iterator[None]:
        """While entered, the first signal raises KeyboardInterrupt in the main thread.

        For the start of a program: there is nothing to end in order yet, and what takes long is to be broken off. A
        library that is written in C and calls back, as numba's compiler does, swallows the exception, which is then
        raised again until it gets through. Whatever comes of that, the block ends with it.
        """
        self._interrupts = True
        report_lost = sys.unraisablehook

        def raise_again(lost: sys.UnraisableHookArgs) -> None:
            if self._interrupted and issubclass(lost.exc_type, KeyboardInterrupt):
                self._interrupted = False
                threading.Timer(_AGAIN_S, _thread.interrupt_main).start()
            else:
                report_lost(lost)

        sys.unraisablehook = raise_again
        try:
            if self.is_set:
                raise KeyboardInterrupt
            yield
        except Exception:
            if self._came:
                raise KeyboardInterrupt from None
            raise
        finally:
            self._interrupts = False
            sys.unraisablehook = report_lost
        if self._came:
            raise KeyboardInterrupt

    def ended(self) -> None:
        """Tell that the program has ended in order, and its process is about to: signals are ignored from now on.

        The last resort stays: the interpreter may still wait for a thread, or a library hang while it is unloaded.
        """
        # The interpreter, when it goes, gives signals back to the system, which would kill; ignored ones it leaves.
        for number in STOP_SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        # It also keeps in mind that an interruption came out of code run from text, as where a dataclass is made, and
        # would end by SIGINT, whatever the exit code, though it was caught. The next text that is run clears that.
        exec("")

    def _handle(self, number: int, _frame: FrameType | None) -> None:
        self._first = self._first or signal.Signals(number)
        self._came = True
        if self._interrupts and not self._interrupted:
            self._interrupted = True
            raise KeyboardInterrupt

    def _watch(self, read_end: int) -> None:
        while True:
            number = os.read(read_end, 1)
            if number and number[0] in STOP_SIGNALS:
                break
        self._first = self._first or signal.Signals(number[0])
        # By a thread in C, which also works where the interpreter hangs.
        faulthandler.dump_traceback_later(self._last_resort_s, exit=True)
        with self._lock:
            self._is_set = True
            callback = None if self._called else self._on_stop
        if callback is not None:
            callback()
