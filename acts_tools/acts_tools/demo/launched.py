"""A launch file that runs as long as somebody watches it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from acts_ros.processes.launcher import leave_with_parent

_STOP_TIMEOUT_S = 20.0

NICENESS = 10
"""Of the process that watches: what it shows may come late, what it watches may not."""


@contextmanager
def launched(
    launch_file: str, arguments: list[str], log_path: Path, niceness: int = NICENESS
) -> Iterator[subprocess.Popen[bytes]]:
    """Run a launch file of acts_bringup in a session of its own, and make this process yield the CPU to it.

    At the end, or should this process be killed, the launch is stopped.

    Parameters
    ----------
    launch_file : str
        Its name.
    arguments : list of str
        ``name:=value``.
    log_path : Path
        Takes what the launch prints.
    niceness : int
        That this process gets, for good: what it starts later would have it as well, so 0 where it starts more.
    """
    command = [sys.executable, "-m", "acts_tools", "launch", "--own", "acts_bringup", launch_file, *arguments]
    with log_path.open("wb") as log:
        process = subprocess.Popen(
            command,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=leave_with_parent(os.getpid()),
        )
        # After the start: children inherit it.
        os.nice(niceness)
        try:
            yield process
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            try:
                process.wait(_STOP_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
