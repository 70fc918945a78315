# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Output of the evaluations: numbers in a table, and JSON."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from acts_tools.output_file import require_writable, write_json
from acts_tools.progress import tell


def number(value: float | None, width: int, digits: int) -> str:
    """A number in a table, or a dash for None."""
    return f"{'-':>{width}}" if value is None else f"{value:{width}.{digits}f}"


class Results:
    """The entries of a report. Each is written to the JSON file at once, so that an interrupted run keeps them.

    Parameters
    ----------
    path : Path or None
        The JSON file; None for none.
    about : dict
        Further fields of the report.
    reads : sequence of Path
        Files that the evaluation reads.

    Raises
    ------
    RecordingError
        When the file cannot be written, or is one of those that are read.
    """

    def __init__(self, path: Path | None, about: dict[str, Any], *, reads: Sequence[Path] = ()) -> None:
        require_writable(path, reads=reads)
        self.entries: list[dict[str, Any]] = []
        self._path = path
        self._about = about

    def add(self, entry: dict[str, Any], line: str = "") -> None:
        """Add an entry, and print its line of the table where it has one."""
        self.entries.append(entry)
        write_json(self._path, {**self._about, "results": self.entries})
        if line:
            tell(line)
