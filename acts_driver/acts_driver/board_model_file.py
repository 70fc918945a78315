"""Model files for a board: what `acts train` and acts_recon write, made ready for the upload."""

from __future__ import annotations

from pathlib import Path

from acts_core.board_models import BoardModel, object_library, patch_dictionary
from acts_core.errors import ArrayError, BoardError
from acts_core.npz_file import read_npz

MODEL_BYTES_MAX = 1 << 24
"""The arrays of a model file take at most so much, far more than a board holds: it is read while a service waits."""


def load_model(path: Path) -> BoardModel:
    """Read a dictionary (`atoms`) or an object library (`columns`, `classes`) for a board.

    Raises
    ------
    BoardError
        The file is missing, is neither, or a board cannot hold it.
    """
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
