# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`python3 -m acts_tools` runs the acts command."""

from __future__ import annotations

import signal
import sys
from types import FrameType

from acts_tools import INTERRUPTED

_USUAL = {
    signal.SIGINT: signal.default_int_handler,
    signal.SIGTERM: signal.SIG_DFL,
    signal.SIGHUP: signal.SIG_DFL,
}
"""What the signals do where nobody has chosen otherwise."""


def run() -> int:
    """Run the acts command, and return its exit code.

    `INTERRUPTED` after Ctrl-C, SIGTERM or SIGHUP, however early: all of them end what is under way, and remove what is
    half made.
    """
    came = False

    def interrupt(number: int, frame: FrameType | None) -> None:
        nonlocal came
        came = True
        raise KeyboardInterrupt

    try:
        for number, usual in _USUAL.items():
            # Where it is ignored, as Ctrl-C in the background of a script or SIGHUP under nohup, it stays so.
            if signal.getsignal(number) is usual:
                signal.signal(number, interrupt)
        # Who started this may have kept it back until now, as acts_tools/bin/acts does.
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _USUAL)
        from acts_ros.executables.streams import open_streams

        # That nobody reads what is told is no error.
        open_streams()
        from acts_tools.cli import main

        return main()
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception:
        # Modules written in C make an error of their own of it while they are imported, numpy an essay.
        if came:
            return INTERRUPTED
        raise
    finally:
        # The interpreter keeps in mind that an interruption came out of code run from text, as where a dataclass is
        # made, and would end by SIGINT, whatever the exit code. The next text that is run clears that.
        exec("")


if __name__ == "__main__":
    sys.exit(run())
