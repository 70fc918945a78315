# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`python3 -m acts_tools` runs the acts command."""

from __future__ import annotations

import signal
import sys
from types import FrameType

from acts_tools import INTERRUPTED


def run() -> int:
    """Run the acts command, and return its exit code; `INTERRUPTED` after Ctrl-C, however early."""
    came = False

    def interrupt(number: int, frame: FrameType | None) -> None:
        nonlocal came
        came = True
        signal.default_int_handler(number, frame)

    try:
        # Where it is ignored, as in the background of a script, it stays so.
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, interrupt)
        # Who started this may have kept it back until now, as acts_tools/bin/acts does.
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})
        from acts_tools.cli import main

        return main()
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception:
        # Modules written in C make an error of their own of it while they are imported, numpy an essay.
        if came:
            return INTERRUPTED
        raise


if __name__ == "__main__":
    sys.exit(run())
