# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The baseline of a driver that runs, kept for the one that its launch starts when it has died.

A tare is in no file, and a calibration in none where no file is given. Without this, what was tared would be felt as
touch by a robot that goes on moving.
"""

from __future__ import annotations

import hashlib
import os
import time
from contextlib import closing, suppress
from pathlib import Path

from acts_core.errors import ActsError
from acts_core.files import FileClaim
from acts_driver.baseline.baseline import Baseline

# A process of a launch is started anew after some seconds; later, the skin may have been changed.
LONGEST_GAP_S = 60.0

_HINT = "a driver that takes over from this one begins without its baseline"


def kept_folder() -> Path:
    """Where the baselines of this user's drivers are kept, in memory."""
    return Path(f"/dev/shm/acts-baseline-{os.geteuid()}")


class KeptBaseline:
    """A file that is removed when the driver ends in order, and stays when it dies.

    It is taken over by a driver of the same name that the same process has started, no longer than `LONGEST_GAP_S`
    after the other one died.

    Parameters
    ----------
    name : str
        What tells the driver from others that the same process has started.
    folder : Path or None
        Where; None: `kept_folder`.

    Raises
    ------
    ActsError
        There is no such place, or another process has it.
    """

    def __init__(self, name: str, folder: Path | None = None) -> None:
        folder = kept_folder() if folder is None else folder
        key = hashlib.sha256("\0".join([_parent(), name]).encode(errors="surrogateescape")).hexdigest()[:16]
        self._path = folder / f"{key}.npz"
        self._claim = FileClaim(self._path, _HINT)
        _remove_forgotten(folder)

    def take_over(self, rows: int, cols: int, file: Path | None = None) -> Baseline | None:
        """What a driver of this name that has died left; None where there is nothing, or it is too old.

        Parameters
        ----------
        rows, cols : int
            Size of the array.
        file : Path or None
            That of a calibration, which goes before where it is newer: somebody has replaced it since.

        Raises
        ------
        SettingsError
            The file is damaged, or of another array.
        """
        if time.time() - _written_s(self._path) > LONGEST_GAP_S or _written_s(file) > _written_s(self._path):
            self.forget()
            return None
        return Baseline.load(self._path, rows, cols, keeps_source=True)

    def keep(self, baseline: Baseline) -> None:
        """Keep this one from now on.

        Raises
        ------
        SettingsError
            It cannot be written.
        """
        baseline.write(self._path, _HINT)

    def refresh(self) -> None:
        """Tell that the driver runs; to be called more often than every `LONGEST_GAP_S`."""
        with suppress(OSError):
            os.utime(self._path)

    def forget(self) -> None:
        """Keep none."""
        with suppress(OSError):
            self._path.unlink()

    def close(self) -> None:
        """Give up the file, which stays if there is one; may be called again."""
        self._claim.close()


def _parent() -> str:
    """The process that started this one, by what no other has: its number, when it began, and the container's."""
    try:
        number = os.getppid()
        # After the name, in brackets, which may contain anything; the first field there is the third (proc(5)).
        began = Path(f"/proc/{number}/stat").read_text(errors="replace").rpartition(")")[2].split()[19]
        return f"{Path('/proc/self/ns/pid').readlink()} {number} {began}"
    except (OSError, IndexError) as error:
        raise ActsError(f"/proc does not tell which process has started this one; {_HINT}") from error


def _written_s(path: Path | None) -> float:
    """When a file was written last, by the system's clock [s]; that of one that is not there is long ago."""
    try:
        return 0.0 if path is None else path.stat().st_mtime
    except (OSError, ValueError):
        return 0.0


def _remove_forgotten(folder: Path) -> None:
    """Remove what drivers left that died with their launch, or that an error has ended for good."""
    for path in {*folder.glob("*.npz"), *(lock.with_suffix("") for lock in folder.glob("*.npz.lock"))}:
        if time.time() - _written_s(path) <= LONGEST_GAP_S:
            continue
        # That of a driver that runs is not to be had, as this one's own.
        with suppress(ActsError, OSError), closing(FileClaim(path, _HINT, wait_s=0.0)):
            for old in (path, *folder.glob(f".{path.name}.*.new")):
                old.unlink(missing_ok=True)
