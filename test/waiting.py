# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Wait for a condition with a deadline."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def pause() -> None:
    """Leave the processor to what is awaited."""
    time.sleep(0.005)


def wait_for(
    condition: Callable[[], T | None],
    what: str | Callable[[], str] = "",
    timeout_s: float = 30.0,
    meanwhile: Callable[[], object] = pause,
    state: Callable[[], object] = lambda: "",
) -> T:
    """Look at a condition until it holds.

    Parameters
    ----------
    condition : callable
        Holds when it is true; what it then returns is returned.
    what : str or callable
        What is awaited, or what tells it at the end; by default the condition as it stands in the test.
    timeout_s : float
        How long at most [s].
    meanwhile : callable
        Done between two looks, such as a turn of an executor.
    state : callable
        Tells at the end how things stand instead.

    Raises
    ------
    AssertionError
        When the time is over; it says what was awaited.
    """
    deadline_s = time.monotonic() + timeout_s
    while not (found := condition()):
        if time.monotonic() > deadline_s:
            awaited = what() if callable(what) else what or text_of(condition)
            raise AssertionError(f"waited {timeout_s:g} s in vain for: {awaited}; {state()}".rstrip("; "))
        meanwhile()
    return found


def text_of(condition: Callable[..., object]) -> str:
    """A condition as it stands in the test."""
    try:
        return " ".join(inspect.getsource(condition).split())
    except (TypeError, OSError):  # not written in Python, or made of such by functools.partial
        return repr(condition)
