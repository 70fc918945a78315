# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files that a parameter or a service may name: regular ones only, and no larger than what is asked of them."""

from __future__ import annotations

import stat
from pathlib import Path

from acts_core.errors import ActsError

TEXT_BYTES_MAX = 1 << 20
"""Text that is read whole takes at most so much."""


def path_of(text: str, *, error: type[ActsError]) -> Path:
    """The path that a person names, ``~`` and ``~somebody`` resolved.

    Raises
    ------
    error
        There is no such somebody.
    """
    try:
        return Path(text).expanduser()
    except RuntimeError as failure:
        raise error(f"{text}: {failure}") from failure


def is_there(path: Path, *, error: type[ActsError]) -> bool:
    """Whether there is anything at a path; links are followed.

    Raises
    ------
    error
        It cannot be looked at: a name too long, a folder that may not be entered, links in a circle.
    """
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except (OSError, ValueError) as failure:
        raise error(f"{path}: cannot be read ({getattr(failure, 'strerror', None) or failure})") from failure
    return True


def require_regular(path: Path, *, error: type[ActsError], hint: str = "") -> int:
    """Refuse a device, which may have no end, a pipe, which may never begin, and a folder; without opening it.

    Parameters
    ----------
    path : Path
        The file; links are followed.
    error : type
        What to raise.
    hint : str
        What to do, for the message.

    Returns
    -------
    int
        Its size [bytes].

    Raises
    ------
    error
        It is not a regular file, or cannot be looked at.
    """
    tail = f"; {hint}" if hint else ""
    try:
        status = path.stat()
    except (OSError, ValueError) as failure:
        raise error(f"{path}: cannot be read ({getattr(failure, 'strerror', None) or failure}){tail}") from failure
    if not stat.S_ISREG(status.st_mode):
        raise error(f"{path}: not a regular file{tail}")
    return status.st_size


def read_text(path: Path, *, error: type[ActsError], hint: str = "", limit_bytes: int = TEXT_BYTES_MAX) -> str:
    """Read a text file.

    Parameters
    ----------
    path, error, hint
        As of `require_regular`.
    limit_bytes : int
        How large it may be.

    Raises
    ------
    error
        It is missing, no regular file, too large, or no UTF-8.
    """
    size = require_regular(path, error=error, hint=hint)
    if size > limit_bytes:
        raise error(f"{path}: {size / 1e6:.1f} MB; allowed are {limit_bytes / 1e6:.1f} MB{f'; {hint}' if hint else ''}")
    try:
        with path.open("rb") as file:
            # It may have grown, or tell no size at all, as the files of /proc do.
            return file.read(limit_bytes).decode()
    except OSError as failure:
        raise error(f"{path}: cannot be read ({failure.strerror or failure})") from failure
    except UnicodeDecodeError as failure:
        raise error(f"{path}: not text in UTF-8 ({failure})") from failure
