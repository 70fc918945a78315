"""What becomes of a process that refuses what it was given, where its launch file lets it be started again.

`acts launch` never starts it again (`acts_core.errors.REFUSED_EXIT_CODE`). `ros2 launch` starts it again whatever its
exit code, for ever; so that it does not, the process stays, does nothing, and says so until it is told to end.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import MutableSequence
from pathlib import Path

from acts_core.stop_signals import StopSignals

STAY_WORD = "--stay-if-refused"
"""On the command line of what a launch file lets be started again."""

LAUNCHER_VARIABLE = "ACTS_LAUNCHER_KNOWS_REFUSAL"
"""In the environment of what a launcher started that does not start such a process again; it need not stay there."""

_SAID_EVERY_S = 30.0


def take_stay_word(words: MutableSequence[str]) -> bool:
    """Take the word out of a command line; whether this process is to stay."""
    if STAY_WORD not in words:
        return False
    words.remove(STAY_WORD)
    return LAUNCHER_VARIABLE not in os.environ


def stay() -> None:
    """Say what is the matter, again and again, until a signal comes."""
    told = threading.Event()
    signals = StopSignals()
    signals.on_stop(told.set)
    name = Path(sys.argv[0]).name
    while not told.is_set():
        print(
            f"error: {name} refuses what it was given, see its error before, and does nothing: started again it would "
            "refuse it again. End the launch (Ctrl-C), mend that, and launch again.",
            file=sys.stderr,
            flush=True,
        )
        told.wait(_SAID_EVERY_S)
    signals.ended()
