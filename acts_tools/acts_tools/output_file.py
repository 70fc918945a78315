# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Check of output files."""

from __future__ import annotations

from pathlib import Path

from acts_core.errors import RecordingError


def require_writable(path: Path | None) -> None:
    """Raise an error, before any work, if a file for results cannot be written; None is allowed.

    An existing file is not changed.

    Raises
    ------
    RecordingError
        When `path` cannot be written.
    """
    if path is None:
        return
    is_new = not path.exists()
    try:
        path.open("ab").close()
        if is_new:
            path.unlink()
    except OSError as error:
        raise RecordingError(
            f"{path}: cannot be written ({error.strerror}); needed is a file's name in a folder that exists"
        ) from error
