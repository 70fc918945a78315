# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading arrays of npz files that may be damaged, hostile or of another kind."""

from __future__ import annotations

import lzma
import os
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError
from acts_core.files.regular_file import require_regular

# What zipfile, its decompressors and NumPy raise for damaged files; a length that was hit may also ask for more than
# there is.
_DAMAGED = (
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
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

UNPACKED_BYTES_MAX = 1 << 30
"""Arrays that a node reads take at most so much, and few seconds; what a command reads see `half_of_memory_bytes`."""


def half_of_memory_bytes() -> int:
    """Half of the memory of this machine [bytes]."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2


def read_npz(
    path: Path,
    names: Collection[str] | None = None,
    *,
    error: type[ActsError],
    hint: str = "",
    limit_bytes: int = UNPACKED_BYTES_MAX,
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
    limit_bytes : int
        How much the arrays may take unpacked; a small file may hold very large ones.

    Raises
    ------
    error
        The file is missing, is no npz file, is damaged, or holds more than is allowed.
    """
    tail = f"; {hint}" if hint else ""
    require_regular(path, error=error, hint=hint)
    try:
        with path.open("rb") as file:
            is_npz = zipfile.is_zipfile(file)
        # NumPy would take anything else for a pickle, and say so.
        if not is_npz:
            raise error(f"{path}: not an npz file, or a part of one{tail}")
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
            wanted = [one for one in entries if names is None or one.filename.removesuffix(".npy") in names]
        unpacked = sum(entry.file_size for entry in wanted)
        if unpacked > limit_bytes:
            raise error(f"{path}: unpacks to {unpacked / 1e6:.0f} MB; allowed are {limit_bytes / 1e6:.0f} MB{tail}")
        with np.load(path, allow_pickle=False) as arrays:
            content = {}
            for name in arrays.files:
                if names is None or name in names:
                    with _objects_refused(path, name, error):
                        content[name] = arrays[name]
                    # NumPy passes on the bytes of what is none.
                    if not isinstance(content[name], np.ndarray):
                        raise error(f"{path}: {name} is no array{tail}")
            return content
    except OSError as failure:
        raise error(f"{path}: cannot be read ({failure.strerror or failure}){tail}") from failure
    except _DAMAGED as failure:
        raise error(f"{path}: a damaged npz file ({failure}){tail}") from failure


@contextmanager
def _objects_refused(path: Path, name: str, error: type[ActsError]) -> Iterator[None]:
    """Refuse an array of Python objects by its name: as texts of a table are often saved; nothing is damaged."""
    try:
        yield
    except ValueError as failure:
        if "allow_pickle" not in str(failure):
            raise
        raise error(
            f"{path}: {name} is an array of Python objects, which are not read; save it as numbers or text, such as "
            f"{name}.astype(str)"
        ) from failure


def npz_names(path: Path) -> frozenset[str]:
    """Names of the arrays of an npz file; none where it cannot be read, of which `read_npz` tells."""
    try:
        require_regular(path, error=ActsError)
        with zipfile.ZipFile(path) as archive:
            return frozenset(name.removesuffix(".npy") for name in archive.namelist())
    except (OSError, ActsError, *_DAMAGED):
        return frozenset()


def unpacked_bytes(path: Path) -> int:
    """How much all arrays of an npz file take unpacked; 0 where it cannot be read, of which `read_npz` tells."""
    try:
        require_regular(path, error=ActsError)
        with zipfile.ZipFile(path) as archive:
            return sum(entry.file_size for entry in archive.infolist())
    except (OSError, ActsError, *_DAMAGED):
        return 0
