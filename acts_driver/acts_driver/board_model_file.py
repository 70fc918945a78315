"""Model files for a board: what `acts train` and acts_recon write, made ready for the upload."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from acts_core.board_models import BoardModel, object_library, patch_dictionary
from acts_core.errors import ArrayError, BoardError


def load_model(path: Path) -> BoardModel:
    """Read a dictionary (`atoms`) or an object library (`columns`, `classes`) for a board.

    Raises
    ------
    BoardError
        The file is missing, is neither, or a board cannot hold it.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            content = {name: archive[name] for name in ("atoms", "columns", "classes") if name in archive}
    except OSError as error:
        raise BoardError(f"model {path}: cannot be read ({error.strerror or error})") from error
    except (ValueError, EOFError, AttributeError, zipfile.BadZipFile) as error:
        raise BoardError(f"model {path}: not an npz file, or damaged ({error})") from error
    try:
        if "atoms" in content:
            return patch_dictionary(content["atoms"])
        if "columns" in content and "classes" in content:
            return object_library(content["columns"], content["classes"])
    except ArrayError as error:
        raise BoardError(f"model {path}: {error}") from error
    raise BoardError(
        f"model {path}: needed is a dictionary (atoms), as of `acts train`, or an object library (columns, classes)"
    )
