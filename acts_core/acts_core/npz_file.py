"""Arrays out of npz files, whatever is in them."""

from __future__ import annotations

import struct
import tokenize
import zipfile
import zlib
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError

# What zipfile, zlib and NumPy raise for damaged files; a length that was hit may also ask for more than there is.
_DAMAGED = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    tokenize.TokenError,
    SyntaxError,
    ValueError,
    TypeError,
    KeyError,
    IndexError,
    AttributeError,
    EOFError,
    OverflowError,
    MemoryError,
    RuntimeError,
)


def read_npz(
    path: Path, names: Collection[str] | None = None, *, error: type[ActsError], hint: str = ""
) -> dict[str, NDArray[Any]]:
    """Read arrays of an npz file; pickled ones are refused.

    Parameters
    ----------
    path : Path
        The file.
    names : collection of str or None
        Which arrays to read where they are there; None for all.
    error : type
        What to raise.
    hint : str
        What to do, for the message.

    Raises
    ------
    error
        The file is missing, is no npz file, or is damaged.
    """
    tail = f"; {hint}" if hint else ""
    try:
        with path.open("rb") as file:
            is_npz = zipfile.is_zipfile(file)
        # NumPy would take anything else for a pickle, and say so.
        if not is_npz:
            raise error(f"{path}: not an npz file, or a part of one{tail}")
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files if names is None or name in names}
    except OSError as failure:
        raise error(f"{path}: cannot be read ({failure.strerror or failure}){tail}") from failure
    except _DAMAGED as failure:
        raise error(f"{path}: a damaged npz file ({failure}){tail}") from failure
