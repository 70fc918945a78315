# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of processes that run: a folder that belongs to one user, and in it files that each belong to one process.

The virtual board does the same in C++ (acts_firmware/virtual_board/link/claim.cpp).
"""

from __future__ import annotations

import errno
import fcntl
import os
import pwd
import stat
import time
from contextlib import suppress
from pathlib import Path

from acts_core.errors import ActsError, SettingsError
from acts_core.runtime import process_name

# Programs of a launch that was killed end shortly after it.
_WAIT_S = 1.0
# Of a lock [bytes]: a process id and a newline.
_LONGEST_LOCK = 24
# What an opening says of a path that will never do; a full disk may have room again.
_LASTING = (errno.EROFS, errno.EACCES, errno.ENOENT, errno.ENOTDIR)


def make_private(folder: Path, hint: str) -> None:
    """Make a folder that no other user may read, with its parents, or check an existing one.

    Parameters
    ----------
    folder : Path
        Its path.
    hint : str
        What to do where it does not do, for the message.

    Raises
    ------
    SettingsError
        It cannot be made, begins with ``~``, is a symbolic link, belongs to another user, or is writable for everybody.
        Folders with the sticky bit, like ``/tmp``, are allowed.
    """
    if str(folder).startswith("~"):
        # Who removed a folder of that name from a command line would remove his home.
        raise SettingsError(f"the folder {folder} begins with ~, which no shell replaces there; write $HOME, or {hint}")
    try:
        for path in (*reversed(folder.parents), folder):
            with suppress(FileExistsError):
                path.mkdir(mode=0o700)
        status = folder.lstat()
    except OSError as error:
        raise SettingsError(f"the folder {folder} cannot be made ({error.strerror}); {hint}") from error
    if stat.S_ISLNK(status.st_mode):
        raise SettingsError(f"the folder {folder} is a symbolic link; name what it leads to, or {hint}")
    if not stat.S_ISDIR(status.st_mode):
        raise SettingsError(f"{folder} is no folder; {hint}")
    if status.st_mode & stat.S_ISVTX:
        return
    if status.st_uid != os.geteuid():
        raise SettingsError(f"the folder {folder} belongs to {_user(status.st_uid)}; {hint}")
    if status.st_mode & stat.S_IWOTH:
        raise SettingsError(f"anybody may write to the folder {folder}; `chmod o-w {folder}`, or {hint}")


class FileClaim:
    """Exclusive use of a file in such a folder, until `close` or the end of the process, however it ends.

    Parameters
    ----------
    path : Path
        The file; the lock is on a file beside it, with the suffix ``.lock``, that contains our process id.
    hint : str
        What to do where it cannot be had, for the message.
    wait_s : float
        How long to wait for a process that is just ending [s].

    Raises
    ------
    SettingsError
        Another process uses it, and still after `wait_s` (the message names it); the folder is not allowed
        (`make_private`) or read-only; the path is empty; the file with the suffix is something else than such a lock.
    ActsError
        The lock cannot be made, as on a full disk.
    """

    def __init__(self, path: Path, hint: str, wait_s: float = _WAIT_S) -> None:
        if not path.name:
            raise SettingsError(f"the path '{path}' names no file; {hint}")
        make_private(path.parent, hint)
        self._path = path.with_name(f"{path.name}.lock")
        try:
            self._fd = self._lock(wait_s)
        except BlockingIOError as error:
            raise SettingsError(f"{path} is in use by {self._holder()}; end that program, or {hint}") from error
        except OSError as error:
            kind = SettingsError if error.errno in _LASTING else ActsError
            raise kind(f"{self._path} cannot be locked ({error.strerror}); {hint}") from error
        try:
            if not _is_lock(os.pread(self._fd, _LONGEST_LOCK + 1, 0)):
                os.close(self._fd)
                raise SettingsError(f"{self._path} is no lock of a file, and would be lost; {hint}")
            os.ftruncate(self._fd, 0)
            os.pwrite(self._fd, f"{os.getpid()}\n".encode(), 0)
        except OSError as error:
            self.close()
            raise ActsError(f"{self._path} cannot be written ({error.strerror}); {hint}") from error

    def close(self) -> None:
        """Release it. May be called again."""
        if self._fd >= 0:
            # Remove it while it is still locked: afterwards it may belong to another process. It does already where
            # somebody has cleared the folder meanwhile.
            with suppress(FileNotFoundError, NotADirectoryError):
                if os.path.samestat(os.fstat(self._fd), self._path.lstat()):
                    self._path.unlink()
            os.close(self._fd)
            self._fd = -1

    def _lock(self, wait_s: float) -> int:
        end_s = time.monotonic() + wait_s
        while True:
            fd = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600)
            try:
                fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if os.path.samestat(os.fstat(fd), self._path.lstat()):
                    return fd
            except FileNotFoundError:
                pass  # the previous owner has just removed it
            except BlockingIOError:
                if time.monotonic() > end_s:
                    os.close(fd)
                    raise
                time.sleep(0.01)
            except BaseException:
                os.close(fd)
                raise
            os.close(fd)

    def _holder(self) -> str:
        try:
            return process_name(int(self._path.read_text()))
        except (OSError, ValueError):
            return process_name(0)


def _is_lock(content: bytes) -> bool:
    """Whether it is what a process, perhaps one that was killed meanwhile, writes to its lock."""
    return len(content) <= _LONGEST_LOCK and (not content or content.strip().isdigit())


def _user(uid: int) -> str:
    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return f"user {uid}"
