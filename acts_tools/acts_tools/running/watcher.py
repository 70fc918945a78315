# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Wait for events of what was launched with a status line, and notice when its launch ends."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable

from acts_core.errors import LaunchError
from acts_tools.running.stopping import StopFlag

_STEP_S = 0.1
_REFRESH_S = 0.2
_PLAIN_REFRESH_S = 5.0


class Watcher:
    """Processes messages ten times a second, and prints a status line.

    On a terminal the line is updated in place; elsewhere one is printed every five seconds. None that is empty.

    Parameters
    ----------
    take_in : callable
        Processes the messages since the last call.
    launch : subprocess.Popen
        Process of the launch.
    stop : StopFlag
        Set when the user wants to stop.
    line : callable
        Returns the status line.
    """

    def __init__(
        self, take_in: Callable[[], None], launch: subprocess.Popen[bytes], stop: StopFlag, line: Callable[[], str]
    ) -> None:
        self._take_in = take_in
        self._launch = launch
        self._stop = stop
        self._line = line
        self._live = sys.stdout.isatty()
        self._shown_s = 0.0
        self._has_shown = False

    def until(self, condition: Callable[[], bool], timeout_s: float) -> bool:
        """Wait for a condition; return whether it became true in time.

        Raises
        ------
        LaunchError
            When the launch has ended.
        KeyboardInterrupt
            When the user wants to stop.
        """
        deadline_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > deadline_s:
                return False
            self._step()
        return True

    def end(self) -> None:
        """End the status line."""
        if self._live and self._has_shown:
            print()

    def _step(self) -> None:
        time.sleep(_STEP_S)
        self._take_in()
        if self._stop.is_set:
            self.end()
            raise KeyboardInterrupt
        if self._launch.poll() is not None:
            raise LaunchError(f"the launch ended early with code {self._launch.returncode}")
        now_s = time.monotonic()
        if now_s - self._shown_s >= (_REFRESH_S if self._live else _PLAIN_REFRESH_S):
            self._shown_s = now_s
            line = self._line()
            if not line:
                return
            self._has_shown = True
            print(f"\r\x1b[K{line}" if self._live else line, end="" if self._live else "\n", flush=True)
