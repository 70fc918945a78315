# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Model files for a board: what `acts train` and acts_recon write, made ready for the upload."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

from acts_core.errors import ArrayError, BoardError
from acts_core.files import path_of, read_npz
from acts_core.runtime import background
from acts_core.wire import BoardModel, object_library, patch_dictionary

MODEL_BYTES_MAX = 1 << 24
"""The arrays of a model file take at most so much, far more than a board holds."""

# Reading that takes longer than this is reported.
_LONG_S = 1.0


def load_model(path: Path) -> BoardModel:
    """Read a dictionary (`atoms`) or an object library (`columns`, `classes`) for a board.

    Raises
    ------
    BoardError
        The file is missing, is neither, or a board cannot hold it.
    """
    path = path_of(str(path), error=BoardError)
    needed = "needed is a dictionary (atoms), as of `acts train`, or an object library (columns, classes)"
    content = read_npz(
        path, ("atoms", "columns", "classes"), error=BoardError, hint=needed, limit_bytes=MODEL_BYTES_MAX
    )
    try:
        if "atoms" in content:
            return patch_dictionary(content["atoms"])
        if "columns" in content and "classes" in content:
            return object_library(content["columns"], content["classes"])
    except ArrayError as error:
        raise BoardError(f"{path}: {error}") from error
    raise BoardError(f"{path}: no model for a board; {needed}")


class BoardModelFile:
    """A model's file, read on a thread of its own when it is first needed: a disk or network may block for ever.

    Parameters
    ----------
    path : Path
        The file.
    on_read : callable
        Called, on that thread, when it has been read or could not be.
    """

    def __init__(self, path: Path, on_read: Callable[[], None]) -> None:
        self.path = path
        self._on_read = on_read
        self._reading: Future[BoardModel] | None = None
        self._began_s = 0.0
        self._mark: tuple[int, int, int] | None = None

    def is_read_as(self, crc32: int) -> bool:
        """Whether it has been read, and is a model with this checksum."""
        reading = self._reading
        if reading is None or not reading.done() or reading.exception() is not None:
            return False
        return reading.result().crc32 == crc32

    @property
    def problem(self) -> str:
        """A message for a person while reading takes long; empty otherwise."""
        if self._reading is None or self._reading.done():
            return ""
        lasted_s = time.monotonic() - self._began_s
        return f"the model {self.path} is still being read, for {lasted_s:.0f} s" if lasted_s > _LONG_S else ""

    def has_changed(self) -> bool:
        """Whether the file is another one than was read, or was rewritten; looks for `background.PATIENCE_S` at most.

        False while it is being read, and where it cannot be told, as of a file that is gone.
        """
        reading = self._reading
        if reading is None or not reading.done():
            return False
        looking = background.begin(lambda: _mark_of(self.path))
        return background.is_done(looking) and looking.result() not in (None, self._mark)

    def wait(self) -> None:
        """Give it `background.PATIENCE_S` to be read."""
        background.is_done(self._begun())

    def model(self) -> BoardModel | None:
        """The model; None while it is being read.

        Raises
        ------
        BoardError
            As `load_model`; the next call reads it again.
        """
        reading = self._begun()
        if not reading.done():
            return None
        if reading.exception() is not None:
            self._reading = None
        return reading.result()

    def _begun(self) -> Future[BoardModel]:
        if self._reading is None:
            self._began_s = time.monotonic()
            self._reading = background.begin(self._read)
            self._reading.add_done_callback(lambda _reading: self._on_read())
        return self._reading

    def _read(self) -> BoardModel:
        # Before it is read: what is written meanwhile counts as a change.
        self._mark = _mark_of(self.path)
        return load_model(self.path)


def _mark_of(path: Path) -> tuple[int, int, int] | None:
    """What tells a file from one that was there before; None where it cannot be looked at."""
    try:
        found = path_of(str(path), error=BoardError).stat()
    except (BoardError, OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
