# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the system does with processes that a launcher has started: signals, and the end of their parent."""

from __future__ import annotations

import ctypes
import os
import signal
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

_PR_SET_PDEATHSIG = 1


def signal_group(group: int, number: int) -> int:
    """Send a signal to the processes of a group; errno where none got it, otherwise 0."""
    try:
        os.killpg(group, number)
    except OSError as error:
        return error.errno or 0
    return 0


def catches_sigterm(pid: int) -> bool:
    """Whether a process handles SIGTERM or ignores it; False where it has ended."""
    with suppress(OSError):
        masks = dict(line.split(":", 1) for line in Path(f"/proc/{pid}/status").read_text().splitlines())
        return bool((int(masks["SigCgt"], 16) | int(masks["SigIgn"], 16)) >> (signal.SIGTERM - 1) & 1)
    return False


def leave_with_parent(parent_pid: int) -> Callable[[], None]:
    """Return a function for a child to call before its program, so that it gets SIGTERM if its parent is killed."""
    libc = ctypes.CDLL(None, use_errno=True)

    def prepare() -> None:
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != parent_pid:
            os._exit(1)  # the parent was killed before the line above

    return prepare
