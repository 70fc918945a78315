# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Processes by number and command line, for messages that say which one holds a file or port."""

from __future__ import annotations

from pathlib import Path

_LONGEST_COMMAND = 100


def process_name(pid: int) -> str:
    """A process by number and command line, as far as this user may see it.

    Parameters
    ----------
    pid : int
        Its number; 0 for one that is not known, as of another container.
    """
    if pid <= 0:
        return "another process"
    try:
        words = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
    except OSError:
        return f"process {pid}"
    command = b" ".join(words).decode(errors="replace").strip()
    if len(command) > _LONGEST_COMMAND:
        command = command[:_LONGEST_COMMAND] + "..."
    return f"process {pid} ({command})" if command else f"process {pid}"
