# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Folders for output files, checks that these can be written, pictures, and reports as JSON."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_core.files import write_whole

_PICTURES = (".png", ".svg", ".pdf")


def make_folder(folder: Path, option: str) -> None:
    """Make the folder that an option of the command line names, unless it is there, before any work for it.

    Raises
    ------
    RecordingError
        When it cannot be made, or no file can be written in it.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise RecordingError(
            f"{option} {folder}: no files can be written there ({error.strerror}); needed is the name of a folder, or "
            "of one that can be made"
        ) from error


def require_writable(
    path: Path | None, *, makes_folder: bool = False, takes_stream: bool = True, reads: Sequence[Path] = ()
) -> None:
    """Raise an error, before any work, if a file for results cannot be written; None is allowed.

    An existing file is not changed.

    Parameters
    ----------
    path : Path or None
        The file.
    makes_folder : bool
        Whether to make its folder.
    takes_stream : bool
        Whether it may also be a pipe or a device, which `write_whole` does not write.
    reads : sequence of Path
        Files that the command reads.

    Raises
    ------
    RecordingError
        When `path` cannot be written, or is one of those that are read.
    """
    if path is None:
        return
    # What cannot be looked at is told of below, or by who reads it.
    with suppress(OSError):
        if any(path.exists() and other.exists() and path.samefile(other) for other in reads):
            raise RecordingError(
                f"{path}: is read, and would be lost if the result were written there; give another name"
            )
    try:
        if makes_folder:
            path.parent.mkdir(parents=True, exist_ok=True)
        is_new = not path.exists()
        if not (is_new or takes_stream or path.is_file() or path.is_dir()):
            raise RecordingError(f"{path}: not a regular file, so nothing is written to it; give another name")
        path.open("ab").close()
        if is_new:
            # A link to a file that does not exist yet stays.
            path.resolve().unlink()
        elif path.is_file():
            _require_new_files(path)
    except OSError as error:
        raise RecordingError(
            f"{path}: cannot be written ({error.strerror}); needed is a file's name in a folder that exists"
        ) from error


def _require_new_files(path: Path) -> None:
    """Refuse a file that a new one cannot replace, as `write_whole` does, though it may be written itself."""
    try:
        tempfile.TemporaryFile(dir=path.resolve().parent).close()
    except OSError as error:
        raise RecordingError(
            f"{path}: cannot be written: its folder takes no new files ({error.strerror}); name one in another folder"
        ) from error


def require_apart(path: Path | None, folder: Path | None, *suffixes: str) -> None:
    """Raise an error, before any work, if a file for results has the name of one that the command writes in a folder.

    Parameters
    ----------
    path, folder : Path or None
        The file, and the folder; None is allowed.
    *suffixes : str
        How the names end that are written there.

    Raises
    ------
    RecordingError
        When one would take the place of the other.
    """
    if path is None or folder is None:
        return
    place = Path(os.path.realpath(path))
    if place.parent == Path(os.path.realpath(folder)) and place.suffix in suffixes:
        raise RecordingError(
            f"{path}: has the name of a file that the command writes in {folder}; give one that does not end in "
            f"{' or '.join(suffixes)}"
        )


def require_picture(
    path: Path | None, *, makes_folder: bool = False, report: Path | None = None, reads: Sequence[Path] = ()
) -> None:
    """Raise an error, as `require_writable`, also for a name whose end is no kind of picture.

    Matplotlib would add an end to a name without one, and so write beside a folder of that name. `report` is the file
    that `write_json` writes, of which the picture would take the place.
    """
    require_writable(path, makes_folder=makes_folder, takes_stream=False, reads=reads)
    if path is not None and report is not None and path.resolve() == report.resolve():
        raise RecordingError(f"{path}: is to be both the picture and the JSON file; give one of them another name")
    if path is not None and path.suffix.lower() not in _PICTURES:
        raise RecordingError(f"{path}: no name of a picture; allowed are names that end in {', '.join(_PICTURES)}")


def save_picture(figure: Any, path: Path, **options: Any) -> None:
    """Write a figure of matplotlib as a whole or not at all; its folder is made, `options` are those of ``savefig``.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    with write_whole(path, error=RecordingError, makes_folder=True) as file:
        figure.savefig(file, format=path.suffix[1:].lower(), **options)


def write_json(path: Path | None, report: Mapping[str, Any]) -> None:
    """Write a report as a whole or not at all, unless `path` is None.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    if path is None:
        return
    try:
        # What is a pipe, or a device as /dev/stdout, cannot be replaced by a new file.
        is_stream = path.exists() and not path.is_file()
        with path.open("wb") if is_stream else write_whole(path, error=RecordingError) as file:
            file.write(f"{json.dumps(report, indent=2)}\n".encode())
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written ({error.strerror})") from error
