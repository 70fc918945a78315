# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The folder that simulated processes share: it belongs to one user, and each file in it to one process."""

from __future__ import annotations

import os
from pathlib import Path

from acts_core import files
from acts_core.errors import SettingsError

_OTHER = (
    "give another folder: run_dir:=/dev/shm/NAME, or run_dir:=/tmp/NAME where that is full or read-only "
    "(to a program without a launch file: another path)"
)


def default_run_dir() -> Path:
    """Default folder of the launch files, one for each user."""
    return Path(f"/dev/shm/acts-{os.environ.get('USER', 'user')}")


class FileClaim(files.FileClaim):
    """Exclusive use of a file in such a folder; a refusal says how to name another folder.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    SettingsError, ActsError
        As of `acts_core.files.FileClaim`.
    """

    def __init__(self, path: Path) -> None:
        if not path.name:
            raise SettingsError(
                f"the path '{path}' names no file; needed is one such as {default_run_dir()}/field.ring"
            )
        super().__init__(path, _OTHER)
