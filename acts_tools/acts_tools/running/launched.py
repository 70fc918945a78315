# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Run a launch file for the length of a block."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from acts_ros.processes.launcher import leave_with_parent

START_TIMEOUT_S = 180.0
"""Longest wait until a launch works: on a busy machine that compiles the kernels first, a minute was not enough [s]."""

_STOP_TIMEOUT_S = 20.0


@contextmanager
def launched(launch_file: str, arguments: list[str], log_path: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Run a launch file of acts_bringup in a session of its own.

    The launch is stopped at the end of the block, or if this process is killed.

    Parameters
    ----------
    launch_file : str
        Name of the launch file.
    arguments : list of str
        Launch arguments, as ``name:=value``.
    log_path : Path
        File for the output of the launch.
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
