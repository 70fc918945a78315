# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Run a launch file for the length of a block."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from acts_tools.running.child import child

START_TIMEOUT_S = 180.0
"""Longest wait until a launch works: on a busy machine that compiles the kernels first, a minute was not enough [s]."""

_STOP_TIMEOUT_S = 20.0


@contextmanager
def launched(launch_file: str, arguments: list[str], log_path: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Run a launch file of acts_bringup as a `child`.

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
    with (
        log_path.open("wb") as log,
        child(
            command,
            stop_timeout_s=_STOP_TIMEOUT_S,
            stop_signal=signal.SIGINT,
            stdout=log,
            stderr=subprocess.STDOUT,
        ) as process,
    ):
        yield process
