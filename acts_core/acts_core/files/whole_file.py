# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Writing a file as a whole or not at all, so that an interruption or a full disk leaves no half of it."""

from __future__ import annotations

import os
import re
import stat
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError

_LEFT_S = 86_400.0
"""A file that has not been written to for so long is of a process that was killed [s]."""


@contextmanager
def write_whole(
    path: Path, *, error: type[ActsError], hint: str = "", makes_folder: bool = False
) -> Iterator[BinaryIO]:
    """Write a file, open while the context is; what was there stays until the new one is on the disk.

    A process that is killed meanwhile leaves a hidden file beside it, which who writes it a day later removes.

    Parameters
    ----------
    path : Path
        The file; a link stays one, and a file that was there keeps its permissions.
    error : type
        What to raise.
    hint : str
        What to do where it cannot be written, for the message.
    makes_folder : bool
        Whether to make its folder.

    Raises
    ------
    error
        It cannot be written, or there is something that is not a regular file.
    """
    target = Path(os.path.realpath(path))
    # Of this thread alone: another one may write the same file meanwhile.
    fresh = target.with_name(f".{target.name}.{os.getpid()}.{threading.get_native_id()}.new")
    try:
        if target.exists() and not target.is_file():
            raise error(f"{path}: not a regular file, so nothing is written to it; give another name")
        if makes_folder:
            target.parent.mkdir(parents=True, exist_ok=True)
        _remove_left(target)
        with fresh.open("wb") as file:
            if target.exists():
                os.fchmod(file.fileno(), stat.S_IMODE(target.stat().st_mode))
            yield file
            # Before the rename, as a power failure could otherwise lose both files.
            file.flush()
            os.fsync(file.fileno())
        fresh.replace(target)
    except BaseException as failure:
        # What could not be made cannot be looked for either: a name too long, a folder that is a file.
        with suppress(OSError):
            fresh.unlink()
        if isinstance(failure, OSError):
            tail = f"; {hint}" if hint else ""
            raise error(f"{path}: cannot be written ({failure.strerror}){tail}") from failure
        raise


def write_array(file: BinaryIO, array: NDArray[Any]) -> None:
    """Write an array as ``np.save`` does, which does not say why it fails, as where the disk is full."""
    whole = np.ascontiguousarray(array)
    np.lib.format.write_array_header_1_0(file, np.lib.format.header_data_from_array_1_0(whole))
    file.write(whole.data)


def _remove_left(target: Path) -> None:
    """Remove what processes that were killed have left while they wrote a file.

    Its age tells, not whether there is such a process: other machines may write in the same folder.
    """
    name = re.compile(rf"\.{re.escape(target.name)}\.\d+\.\d+\.new")
    # Who may not do that, or comes too late for it, leaves them.
    with suppress(OSError), os.scandir(target.parent) as entries:
        for entry in entries:
            if not name.fullmatch(entry.name) or not entry.is_file(follow_symlinks=False):
                continue
            if time.time() - entry.stat(follow_symlinks=False).st_mtime > _LEFT_S:
                Path(entry.path).unlink()
