# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Checkpoint of an interrupted training, from which the same command continues."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from acts_core.errors import RecordingError
from acts_core.files import ModelFile, settings_field
from acts_recon.learning import KsvdState


@dataclass(frozen=True)
class Checkpoint:
    """A file beside the output with the last finished iteration.

    Attributes
    ----------
    path : Path
        Path of the output with the suffix ``.partial``.
    settings : mapping
        Plain values of everything that the result depends on, with a hash of the data.
    """

    path: Path
    settings: Mapping[str, Any]

    @property
    def _file(self) -> ModelFile:
        return ModelFile(
            kind="a checkpoint of `acts train`",
            format="acts-training-1",
            fields=("iteration", "atoms", "settings"),
            remedy=f"delete {self.path} to begin anew",
            error=RecordingError,
        )

    def save(self, state: KsvdState) -> None:
        """Replace the file atomically: after a power failure there is either the old file or the new one.

        Raises
        ------
        RecordingError
            It cannot be written.
        """
        self._file.write(
            self.path,
            {
                "iteration": state.iteration,
                "atoms": state.atoms,
                "settings": settings_field(self.settings),
            },
        )

    def load(self) -> KsvdState | None:
        """Load the state; None if there is no file.

        Raises
        ------
        RecordingError
            The file is damaged, or is of a training with other settings or data.
        """
        if not self.path.exists():
            return None
        content = self._file.read(self.path)
        iteration, atoms = content["iteration"], content["atoms"]
        is_whole = iteration.ndim == 0 and iteration.dtype.kind in "iu"
        if not (is_whole and atoms.dtype.kind == "f" and np.isfinite(atoms).all()):
            raise RecordingError(
                f"{self.path}: damaged (iteration {iteration.shape}, {iteration.dtype}, atoms {atoms.shape}, "
                f"{atoms.dtype}: needed are a whole number, and finite ones); {self._file.remedy}"
            )
        found = self._file.settings(self.path, content)
        # Convert to JSON and back like the settings in the file: tuples become lists.
        here = json.loads(settings_field(self.settings))
        others = [
            f"{name} {found.get(name)} there, {here.get(name)} here"
            for name in sorted({*found, *here})
            if found.get(name) != here.get(name)
        ]
        if others:
            raise RecordingError(
                f"{self.path}: left by a training with other settings or data ({'; '.join(others)}). Repeat that "
                f"command to finish it, delete the file to begin anew, or choose another -o"
            )
        return KsvdState(int(iteration), atoms.astype(np.float32))

    def remove(self) -> None:
        """Remove the file after the output was written."""
        self.path.unlink(missing_ok=True)
