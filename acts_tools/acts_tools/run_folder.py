"""Where the files of a run live that processes share and that go with it."""

from __future__ import annotations

from pathlib import Path


def shared_memory() -> Path | None:
    """The folder in memory, where the system has one; None lets `tempfile` choose."""
    shared = Path("/dev/shm")
    return shared if shared.is_dir() else None
