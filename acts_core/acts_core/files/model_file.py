# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading and writing npz files of one kind with named fields: dictionaries and object libraries."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError
from acts_core.files.npz_file import read_npz
from acts_core.files.whole_file import write_whole


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
        # An open file: numpy would append .npz to any other name.
        with write_whole(path, error=self.error) as file:
            np.savez_compressed(file, format=self.format, **fields)

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

    def settings(self, path: Path, content: Mapping[str, NDArray]) -> dict[str, Any]:
        """The field ``settings`` of a file's content, by `settings_field`; raises `error` when it is damaged."""
        try:
            settings = json.loads(str(content["settings"]))
        except (ValueError, RecursionError) as error:
            raise self.error(f"{path}: a field has the wrong type (settings: {error}); {self.remedy}") from error
        if not isinstance(settings, dict):
            found = type(settings).__name__
            raise self.error(f"{path}: a field has the wrong type (settings: {found}, not names); {self.remedy}")
        return settings


def settings_field(settings: Mapping[str, Any]) -> str:
    """Plain values by name, such as what a model was made with, as the field ``settings`` of its file."""
    return json.dumps(dict(settings), sort_keys=True)
