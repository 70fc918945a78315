# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A ring of timestamped arrays in a memory-mapped file, which simulated processes share, 500 times a second.

One process writes, any number read, and none ever waits (a seqlock per slot). The world writes fields of counts that
the virtual board (C++) reads; the simulated robot writes joint angles that the world reads.

Layout of the file, little-endian, natural alignment::

    offset  type        what
    0       char[8]     "ACTSRING"
    8       uint32      version, 1
    12      uint32      slots, the number of slots
    16      uint32      width, the number of values in a slot
    20      uint32      0
    24      uint64      written, the number of slots written so far; the newest is slot (written - 1) % slots
    32      ...         0
    64      slot[slots]

    slot:
    0       uint64      lock: even when the slot is complete, odd while it is being written; read before and after
    8       int64       time [ns], CLOCK_MONOTONIC of the host
    16      float64[width]

Times increase from slot to slot. A reader interpolates linearly between the two slots around a time, and uses the
oldest or newest slot outside of them. A writer that runs ahead of the clock, as the world does, writes future times.
"""

from __future__ import annotations

import mmap
import os
import stat
import struct
import time
from contextlib import suppress
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError, SettingsError

JOINT_RING_WIDTH = 12
"""Values in a slot of the ring of a UR5e's joints: six angles [rad], then six velocities [rad/s], base to wrist 3."""

_MAGIC = b"ACTSRING"
_VERSION = 1
_HEADER = struct.Struct("<8sIIII")
_HEADER_BYTES = 64
_WRITTEN_OFFSET = 24
_ONE = np.uint64(1)
# A write takes about a microsecond; if a slot is being written at a hundred reads in a row, the writer is stuck.
_ATTEMPTS = 100


def _slot_dtype(width: int) -> np.dtype:
    return np.dtype([("lock", "<u8"), ("time_ns", "<i8"), ("values", "<f8", (width,))])


class TimedRingWriter:
    """Creates the file, replacing an old ring, and writes to it.

    Parameters
    ----------
    path : Path
        The file, in a folder that exists; a memory file system such as ``/dev/shm`` avoids disk writes.
    width : int
        Number of values in a slot.
    slots : int
        Number of slots, at least 2; at 500 Hz, 256 slots hold half a second.

    Raises
    ------
    SettingsError
        When something else than a ring is there, which would be lost.
    ActsError
        When the file cannot be created, or `width` or `slots` is too small.
    """

    def __init__(self, path: Path, width: int, slots: int = 256) -> None:
        if width < 1 or slots < 2:
            raise ActsError(
                f"{path}: a ring of {slots} slots of {width} values; allowed are 2 slots and 1 value or more"
            )
        _require_replaceable(path)
        self.path = path
        self.width = width
        dtype = _slot_dtype(width)
        total = _HEADER_BYTES + slots * dtype.itemsize
        # A new file under the old name: readers of the old file keep an intact, if ageing, ring.
        temporary = path.with_name(f"{path.name}.{os.getpid()}.new")
        try:
            with temporary.open("w+b") as file:
                # Allocate the space now: on a memory file system that is full later, a write causes a bus error.
                os.posix_fallocate(file.fileno(), 0, total)
                self._map = mmap.mmap(file.fileno(), total)
                self._identity = _identity_of(os.fstat(file.fileno()))
            self._map[: _HEADER.size] = _HEADER.pack(_MAGIC, _VERSION, slots, width, 0)
            temporary.replace(path)
        except OSError as error:
            with suppress(OSError):
                temporary.unlink()
            raise ActsError(
                f"{path}: the shared ring cannot be created ({error.strerror}); its folder must exist and have room "
                f"for {total} bytes; where it is full: run_dir:=/tmp/NAME"
            ) from error
        self._written = np.frombuffer(self._map, dtype="<u8", count=1, offset=_WRITTEN_OFFSET)
        self._slots = np.frombuffer(self._map, dtype=dtype, count=slots, offset=_HEADER_BYTES)
        self._lock = self._slots["lock"]
        self._time_ns = self._slots["time_ns"]
        self._values = self._slots["values"]
        self._count = 0
        self._newest_ns: int | None = None

    def write(self, time_ns: int, values: NDArray[np.float64]) -> None:
        """Append one slot.

        Parameters
        ----------
        time_ns : int
            CLOCK_MONOTONIC [ns], greater than in the slot before.
        values : np.ndarray [shape=(width,), dtype=float64]
            Values at that time.

        Raises
        ------
        ActsError
            For another shape, or a time that does not increase.
        """
        if values.shape != (self.width,):
            raise ActsError(f"{self.path}: values of shape {values.shape}; a slot holds ({self.width},)")
        if self._newest_ns is not None and time_ns <= self._newest_ns:
            raise ActsError(f"{self.path}: slot of {time_ns} ns after one of {self._newest_ns} ns; times must grow")
        self._newest_ns = time_ns
        index = self._count % len(self._slots)
        # x86 keeps the order of stores. On other processors a torn slot is possible, but affects simulated touch only.
        self._lock[index] += _ONE
        self._time_ns[index] = time_ns
        self._values[index] = values
        self._lock[index] += _ONE
        self._count += 1
        self._written[0] = self._count

    def close(self) -> None:
        """Remove the file, unless another writer has replaced it."""
        if _identity(self.path) == self._identity:
            self.path.unlink(missing_ok=True)

    def __enter__(self) -> TimedRingWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class TimedRingReader:
    """Reads a ring that another process writes.

    A writer that restarts replaces the file. The reader checks for that whenever nothing was written since its last
    read, and opens the new file; while there is none, it keeps the old one.

    Parameters
    ----------
    path : Path
        The file.
    width : int
        Number of values in a slot that the caller expects.

    Raises
    ------
    ActsError
        When the file is missing, is no ring, or has another width than `width`; every read raises it as well, for a new
        file.
    """

    def __init__(self, path: Path, width: int) -> None:
        self.path = path
        self.width = width
        self._open()

    def _open(self) -> None:
        path = self.path
        try:
            if not stat.S_ISREG(path.stat().st_mode):
                raise ValueError("not a regular file")
            with path.open("rb") as file:
                identity = _identity_of(os.fstat(file.fileno()))
                mapped = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        except (OSError, ValueError) as error:
            raise ActsError(
                f"{path}: no shared ring there ({error}); start the process that writes it first"
            ) from error
        if len(mapped) < _HEADER_BYTES:
            raise ActsError(f"{path}: too short to be a shared ring")
        magic, version, slots, width, _ = _HEADER.unpack_from(mapped)
        if magic != _MAGIC or version != _VERSION:
            raise ActsError(f"{path}: not a shared ring of version {_VERSION}")
        if width != self.width:
            raise ActsError(f"{path}: holds {width} values a slot, {self.width} are expected")
        dtype = _slot_dtype(width)
        if slots < 2 or len(mapped) < _HEADER_BYTES + slots * dtype.itemsize:
            raise ActsError(f"{path}: shorter than its header says ({slots} slots of {width} values)")
        self._identity = identity
        self._written = np.frombuffer(mapped, dtype="<u8", count=1, offset=_WRITTEN_OFFSET)
        self._slots = np.frombuffer(mapped, dtype=dtype, count=slots, offset=_HEADER_BYTES)
        self._lock = self._slots["lock"]
        self._time_ns = self._slots["time_ns"]
        self._values = self._slots["values"]
        self._seen = 0

    @property
    def written(self) -> int:
        """Number of slots written so far to the present file."""
        return int(self._written[0])

    def newest(self) -> tuple[int, NDArray[np.float64]] | None:
        """Time [ns] and a copy of the values, shape (width,), of the newest slot; None before the first."""
        for _ in range(_ATTEMPTS):
            count = self._follow()
            if count == 0:
                return None
            slot = self._read((count - 1) % len(self._slots))
            # A reader that was overtaken may get a slot that is not counted yet; a later call could return an older one
            # than that.
            if slot is not None and self.written < count + len(self._slots) - 1:
                return slot
        raise self._stuck()

    def sample(self, time_ns: int) -> NDArray[np.float64] | None:
        """Values at a time: linear between the slots around it, the oldest or newest slot outside of them.

        Parameters
        ----------
        time_ns : int
            CLOCK_MONOTONIC [ns].

        Returns
        -------
        np.ndarray [shape=(width,), dtype=float64] or None
            None before the first slot.
        """
        for attempt in range(_ATTEMPTS):
            count = self._follow()
            if count == 0:
                return None
            slots = len(self._slots)
            # The oldest slot is the next to be written; a reader that was overtaken skips more of them.
            first = min(max(count - slots + 1 + attempt, 0), count - 1)
            order = np.arange(first, count) % slots
            times_ns = self._time_ns[order]
            overtaken = max(self.written - slots + 1 - first, 0)
            order, times_ns = order[overtaken:], times_ns[overtaken:]
            if not len(order):
                continue
            after = int(np.searchsorted(times_ns, time_ns))
            low, high = max(after - 1, 0), min(after, len(order) - 1)
            early, late = self._read(int(order[low])), self._read(int(order[high]))
            # Both are complete, and were not overwritten since their times were read.
            if early is None or late is None or early[0] != times_ns[low] or late[0] != times_ns[high]:
                continue
            if low == high:
                return late[1]
            share = (time_ns - early[0]) / (late[0] - early[0])
            return early[1] + share * (late[1] - early[1])
        raise self._stuck()

    def since(self, time_ns: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """All slots later than a time that are still in the ring, oldest first.

        Parameters
        ----------
        time_ns : int
            CLOCK_MONOTONIC [ns].

        Returns
        -------
        times_ns : np.ndarray [shape=(n,), dtype=int64]
        values : np.ndarray [shape=(n, width), dtype=float64]
        """
        count, slots = self._follow(), len(self._slots)
        # The oldest slot is the next to be written.
        numbers = np.arange(max(count - slots + 1, 0), count)
        later = numbers[np.searchsorted(self._time_ns[numbers % slots], time_ns, side="right") :]
        times_ns, values = self._time_ns[later % slots], self._values[later % slots]
        whole = later > self.written - slots
        return times_ns[whole], values[whole]

    def age_s(self) -> float:
        """Age of the newest slot [s], negative for one in the future; infinite before the first."""
        newest = self.newest()
        return float("inf") if newest is None else (time.monotonic_ns() - newest[0]) / 1e9

    def _follow(self) -> int:
        """Number of slots written, after a new file was opened if there is one."""
        count = self.written
        if count == self._seen:
            identity = _identity(self.path)
            if identity is not None and identity != self._identity:
                self._open()
                count = self.written
        self._seen = count
        return count

    def _read(self, index: int) -> tuple[int, NDArray[np.float64]] | None:
        before = int(self._lock[index])
        time_ns, values = int(self._time_ns[index]), self._values[index].copy()
        whole = before % 2 == 0 and int(self._lock[index]) == before
        return (time_ns, values) if whole else None

    def _stuck(self) -> ActsError:
        return ActsError(f"{self.path}: a slot never came to rest; is its writer stuck?")


def _require_replaceable(path: Path) -> None:
    """Refuse what a ring would take the place of: a file with something else in it, a folder, a device, a link."""
    try:
        mode = path.lstat().st_mode
        # Only a file is opened: opening a pipe would wait for its writer.
        if stat.S_ISREG(mode):
            with path.open("rb") as file:
                if file.read(len(_MAGIC)) == _MAGIC:
                    return
    except FileNotFoundError:
        return
    except OSError as error:
        raise SettingsError(f"{path} cannot be looked at ({error.strerror}); name another file for the ring") from error
    kind = "a directory" if stat.S_ISDIR(mode) else "there"
    raise SettingsError(f"{path} is {kind} and is no ring, and would be lost; name another file for the ring")


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        return _identity_of(path.stat())
    except OSError:
        return None


def _identity_of(status: os.stat_result) -> tuple[int, int]:
    return status.st_dev, status.st_ino
