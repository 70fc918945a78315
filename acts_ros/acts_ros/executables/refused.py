# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process that refuses its settings waits instead of ending, where it would be started again for ever.

`acts launch` never restarts such a process (`acts_core.errors.REFUSED_EXIT_CODE`). `ros2 launch` restarts it for ever,
whatever its exit code. To prevent that, the process stays, does nothing, and repeats a message until it is stopped.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import MutableSequence
from pathlib import Path

from acts_core.stop_signals import StopSignals

STAY_WORD = "--stay-if-refused"
"""Argument of processes that a launch file respawns."""

LAUNCHER_VARIABLE = "ACTS_LAUNCHER_KNOWS_REFUSAL"
"""Set in the environment by a launcher that does not restart such a process; it need not stay then."""

_SAID_EVERY_S = 30.0


def take_stay_word(words: MutableSequence[str]) -> bool:
    """Remove `STAY_WORD` from a command line; whether this process is to stay after a refusal."""
    if STAY_WORD not in words:
        return False
    words.remove(STAY_WORD)
    return LAUNCHER_VARIABLE not in os.environ


def stay() -> None:
    """Print an error every `_SAID_EVERY_S` until a signal comes."""
    told = threading.Event()
    signals = StopSignals()
    signals.on_stop(told.set)
    name = Path(sys.argv[0]).name
    while not told.is_set():
        print(
            f"error: {name} refuses what it was given (see its error above) and does nothing: a restart would fail the "
            "same way. End the launch (Ctrl-C), correct the error, and launch again.",
            file=sys.stderr,
            flush=True,
        )
        told.wait(_SAID_EVERY_S)
    signals.ended()
