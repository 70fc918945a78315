"""Where the files of a run live that processes share and that go with it."""

from __future__ import annotations

import os
from pathlib import Path

# A run takes some 2 MB for each skin.
_NEEDED_BYTES = 1 << 24


def shared_memory(shared: Path = Path("/dev/shm")) -> Path | None:
    """The folder in memory, where there is one with room that may be written to; None lets `tempfile` choose."""
    if not (shared.is_dir() and os.access(shared, os.W_OK)):
        return None
    status = os.statvfs(shared)
    return shared if status.f_bavail * status.f_frsize >= _NEEDED_BYTES else None
