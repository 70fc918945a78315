# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading and writing npz files of one kind with named fields: dictionaries and object libraries."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError
from acts_core.files.npz_file import read_npz


@dataclass(frozen=True)
class ModelFile:
    """What the files of one kind have in common.

    Attributes
    ----------
    kind : str
        For messages, as in "no ... file".
    format : str
        Content of the field ``format``.
    fields : sequence of str
        Needed besides ``format``.
    remedy : str
        How to make such a file.
    error : type
        What is raised.
    """

    kind: str
    format: str
    fields: Sequence[str]
    remedy: str
    error: type[ActsError]

    def write(self, path: Path, fields: dict[str, Any]) -> None:
        """Write a file as a whole or not at all, whatever its name ends in; raises `error` when it cannot be written.

        What was there stays until the new file is on the disk.
        """
        try:
            target = path.resolve()  # a link stays one
            if target.exists() and not target.is_file():
                raise self.error(f"{path}: not a regular file, so nothing is written to it; give another name")
            fresh = target.with_name(target.name + ".new")
            try:
                # An open file: numpy would append .npz to any other name.
                with fresh.open("wb") as file:
                    np.savez_compressed(file, format=self.format, **fields)
                    # Before the rename, as a power failure could otherwise lose both files.
                    file.flush()
                    os.fsync(file.fileno())
                fresh.replace(target)
            except BaseException:
                fresh.unlink(missing_ok=True)
                raise
        except OSError as error:
            raise self.error(f"{path}: cannot be written ({error.strerror})") from error

    def read(self, path: Path) -> dict[str, NDArray]:
        """The fields of a file; raises `error` when it is missing, damaged, or of another kind or format."""
        needed = ["format", *self.fields]
        content = read_npz(path, needed, error=self.error, hint=self.remedy)
        missing = [name for name in needed if name not in content]
        if missing:
            raise self.error(f"{path}: lacks {', '.join(missing)}, so it is not {self.kind}; {self.remedy}")
        found = str(content.pop("format"))
        if found != self.format:
            raise self.error(f"{path}: format {found!r}; readable is {self.format!r}")
        return content
