# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Wait for a condition with a deadline."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def pause() -> None:
    """Leave the processor to what is awaited."""
    time.sleep(0.005)


def wait_for(
    condition: Callable[[], T | None],
    what: str | Callable[[], object],
    timeout_s: float = 30.0,
    meanwhile: Callable[[], object] = pause,
) -> T:
    """Look at a condition until it holds.

    Parameters
    ----------
    condition : callable
        Holds when it is true; what it then returns is returned.
    what : str or callable
        What is awaited; a callable tells it at the end, where it does not come.
    timeout_s : float
        How long at most [s].
    meanwhile : callable
        Done between two looks, such as a turn of an executor.

    Raises
    ------
    AssertionError
        When the time is over.
    """
    deadline_s = time.monotonic() + timeout_s
    while not (found := condition()):
        if time.monotonic() > deadline_s:
            raise AssertionError(f"waited {timeout_s:g} s in vain for: {what if isinstance(what, str) else what()}")
        meanwhile()
    return found
