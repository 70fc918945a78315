# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Full shared memory, told in words before ROS meets it."""

from __future__ import annotations

import os
from pathlib import Path

from acts_core.errors import ActsError

_NEEDED_BYTES = 1 << 14


def check_shared_memory(folder: Path = Path("/dev/shm")) -> None:
    """Check that programs with ROS can start; to be called before rclpy is imported.

    ROS' tracing library (LTTng-UST) maps a page in shared memory. Where that is full, the system ends the program with
    a bus error and no word. Where another program has mapped that page before, nothing happens.

    Raises
    ------
    ActsError
        When less than 16 KiB are free.
    """
    try:
        status = os.statvfs(folder)
    except OSError:
        # Without such a folder the library does without.
        return
    if status.f_bavail * status.f_frsize < _NEEDED_BYTES and not any(folder.glob("lttng-ust-wait-*")):
        raise ActsError(
            f"the shared memory is full ({folder}), so ROS programs end with a bus error: remove what is not needed "
            f"there (ls -la {folder}), or enlarge it (sudo mount -o remount,size=1G {folder})"
        )
