# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Says that a simulated world is being compiled, where that takes so long that somebody waits for it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

COMPILING = "compiling: this takes long the first time on a machine"


@contextmanager
def telling_of_compiling(tell: Callable[[str], None], *, after_s: float = 1.0) -> Iterator[None]:
    """Tell it, from a thread of its own, unless the block is over before.

    Parameters
    ----------
    tell : callable
        Gets the sentence.
    after_s : float
        From the beginning of the block until it is told [s].
    """
    timer = threading.Timer(after_s, tell, [COMPILING])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
