# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The folder for temporary files that the processes of a run share."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

# A run needs about 2 MB for each skin.
_NEEDED_BYTES = 1 << 24


def run_folder(prefix: str) -> tempfile.TemporaryDirectory[str]:
    """Make the folder of a run, in memory where that is possible; it is removed at the end of the block."""
    return tempfile.TemporaryDirectory(prefix=prefix, dir=shared_memory())


def shared_memory(shared: Path = Path("/dev/shm")) -> Path | None:
    """A folder in memory that is writable and has space; None, for which `tempfile` chooses, if there is none."""
    if not (shared.is_dir() and os.access(shared, os.W_OK)):
        return None
    status = os.statvfs(shared)
    return shared if status.f_bavail * status.f_frsize >= _NEEDED_BYTES else None
