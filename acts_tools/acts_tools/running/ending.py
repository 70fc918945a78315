# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The end of a child process that was asked to end."""

from __future__ import annotations

import subprocess
from typing import Any


def wait_or_kill(process: subprocess.Popen[Any], timeout_s: float) -> None:
    """Wait until a process has ended, and kill it where it has not within the time [s]."""
    try:
        process.wait(timeout_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
