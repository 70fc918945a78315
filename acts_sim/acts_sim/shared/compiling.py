# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Says that a simulated world is being compiled, where that takes so long that somebody waits for it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

COMPILING = "compiling: this takes long the first time on a machine"

_AFTER_S = 1.0


@contextmanager
def telling_of_compiling(tell: Callable[[str], None]) -> Iterator[None]:
    """Tell it, from a thread of its own, unless the block is over before.

    Parameters
    ----------
    tell : callable
        Gets the sentence.
    """
    timer = threading.Timer(_AFTER_S, tell, [COMPILING])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
