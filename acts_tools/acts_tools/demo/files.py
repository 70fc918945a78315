# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The files that a demonstration writes: its results, their picture, and the log of its launches."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from acts_core.errors import LaunchError
from acts_tools.output_file import make_folder, require_writable, write_json

_SHOWN_LINES = 30


@dataclass(frozen=True)
class DemoFiles:
    """Files of one demonstration.

    Attributes
    ----------
    results, picture, log : Path
    """

    results: Path
    picture: Path
    log: Path

    @staticmethod
    def made(out: Path, name: str) -> DemoFiles:
        """Make the folder, and check that files of this name can be written there.

        Raises
        ------
        RecordingError
            When one of them cannot.
        """
        make_folder(out, "--out")
        files = DemoFiles(*(out / f"{name}.{kind}" for kind in ("json", "png", "log")))
        for path in (files.results, files.picture, files.log):
            require_writable(path)
        return files

    def write(self, results: dict[str, Any]) -> None:
        """Write the results."""
        write_json(self.results, results)

    @contextmanager
    def log_shown(self) -> Iterator[None]:
        """Print the end of the log where a launch fails in the block, and say so in the `LaunchError`."""
        try:
            yield
        except LaunchError as error:
            print()
            print("\n".join(self.log.read_text(errors="replace").splitlines()[-_SHOWN_LINES:]), file=sys.stderr)
            raise LaunchError(f"{error}; the end of {self.log} is above") from error

    def __str__(self) -> str:
        """The paths in words."""
        return f"{self.results}, {self.picture}, {self.log}"
