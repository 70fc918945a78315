# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A program that runs for the length of a block."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from acts_ros.processes.children import leave_with_parent


@contextmanager
def child(
    command: Sequence[str], *, stop_timeout_s: float, stop_signal: int = signal.SIGTERM, **options: Any
) -> Iterator[subprocess.Popen[Any]]:
    """Run a program in a session of its own: Ctrl-C reaches this process alone, which ends it in order.

    It also ends where this process is killed.

    Parameters
    ----------
    command : sequence of str
    stop_timeout_s : float
        From the signal at the end of the block until the session is killed [s].
    stop_signal : int
        What asks the program to end.
    **options
        Of `subprocess.Popen`; its pipes are closed at the end.
    """
    leave = leave_with_parent(os.getpid())
    with subprocess.Popen(command, start_new_session=True, preexec_fn=leave, **options) as process:
        try:
            yield process
        finally:
            process.send_signal(stop_signal)
            try:
                process.wait(stop_timeout_s)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
