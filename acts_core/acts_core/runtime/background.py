# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Work on a thread of its own that may take long or never end, such as reading a file from a lost network drive."""

from __future__ import annotations

import atexit
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, wait
from typing import TypeVar

from acts_core.errors import ActsError

T = TypeVar("T")

PATIENCE_S = 0.5
"""How long a thread that answers others waits for such work [s]."""

_running: dict[threading.Thread, float] = {}
"""Threads that work, and how long the end of the process waits for each [s]."""


def begin(work: Callable[[], T], *, ends_within_s: float = PATIENCE_S) -> Future[T]:
    """Begin the work now; what it returns or raises is in the future.

    At its end a process waits for it, and not for ever as for the threads of `concurrent.futures`.

    Parameters
    ----------
    work : callable
        Runs on the thread.
    ends_within_s : float
        How long the end of the process waits for it at most [s]: for work that computes, as long as that may take.
    """
    future: Future[T] = Future()

    def run() -> None:
        try:
            future.set_result(work())
        # For whoever asks for the result.
        except BaseException as error:  # noqa: BLE001
            future.set_exception(error)
        finally:
            _running.pop(threading.current_thread(), None)

    thread = threading.Thread(target=run, name="acts_background", daemon=True)
    _running[thread] = ends_within_s
    thread.start()
    return future


@atexit.register
def _wait_for_running() -> None:
    """Let work end: a thread that Python's end meets within compiled code of numpy's aborts the process."""
    begin_s = time.monotonic()
    for thread, ends_within_s in list(_running.items()):
        thread.join(max(0.0, begin_s + ends_within_s - time.monotonic()))


def is_done(future: Future[T]) -> bool:
    """Whether the work has ended, with or without success; waits for it up to `PATIENCE_S`."""
    return bool(wait([future], PATIENCE_S).done)


def within_patience(work: Callable[[], T], error: type[ActsError], what: str) -> T:
    """The result of the work; given up after `PATIENCE_S`.

    Parameters
    ----------
    work : callable
        What it raises is raised here.
    error : type
        What to raise where it takes longer; the work goes on, and its result is lost.
    what : str
        What takes long, for the message.
    """
    future = begin(work)
    if not is_done(future):
        raise error(f"{what} takes longer than {PATIENCE_S:g} s: is the disk or the server it lies on away?")
    return future.result()
