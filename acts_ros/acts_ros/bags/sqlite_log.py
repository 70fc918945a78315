# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a recorder that was killed has left beside a ``.db3`` file.

SQLite writes to another file first (``-wal``), or keeps there what it is about to overwrite (``-journal``). Whoever
opens the file next puts both together, which changes them. So that is done with a copy.
"""

from __future__ import annotations

import shutil
import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path

from acts_core.errors import RecordingError
from acts_core.files import require_regular

_KINDS = ("-wal", "-journal")


def has_log(path: Path) -> bool:
    """Whether messages of a ``.db3`` file may be in another file beside it.

    Raises
    ------
    RecordingError
        What is beside it is no regular file.
    """
    return bool(_logs(path))


def merged_copy(path: Path, folder: Path) -> Path:
    """Copy a ``.db3`` file into a folder, together with what is beside it, as one file.

    Raises
    ------
    RecordingError
        There is no room for it, or it is damaged.
    """
    parts = [path, *_logs(path)]
    # While they are put together, what was beside the file is there twice.
    needed = 2 * sum(part.stat().st_size for part in parts)
    free = shutil.disk_usage(folder).free
    if needed > free:
        raise RecordingError(
            f"some of its messages are still in {parts[1].name}. To read them, both are copied to "
            f"{tempfile.gettempdir()}, which needs {needed / 1e6:.0f} MB and has {free / 1e6:.0f} MB; set TMPDIR to a "
            "folder where there is more"
        )
    try:
        for part in parts:
            shutil.copyfile(part, folder / part.name)
        with closing(sqlite3.connect(folder / path.name)) as base:
            base.execute("PRAGMA journal_mode=DELETE").fetchall()
    except (OSError, sqlite3.Error) as error:
        raise RecordingError(f"it cannot be put together with {parts[1].name}: {error}") from error
    return folder / path.name


def _logs(path: Path) -> list[Path]:
    found = [path.with_name(path.name + kind) for kind in _KINDS]
    return [file for file in found if file.exists() and require_regular(file, error=RecordingError)]
