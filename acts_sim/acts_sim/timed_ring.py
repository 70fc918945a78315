"""A ring of timestamped arrays in a memory-mapped file: how simulated processes share what changes a thousand times a second.

One process writes, any number read, none ever waits. The world writes pressure fields that the virtual board (C++)
reads, the simulated robot writes joint angles that the world reads.

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
    0       uint64      lock: even when the slot is whole, odd while it is being written; read before and after
    8       int64       time [ns], CLOCK_MONOTONIC of the host
    16      float64[width]

Times grow from slot to slot. A reader interpolates linearly between the two slots around the time it asks for, and holds
the oldest or newest outside of them. A writer that knows the near future (the world runs one step ahead) may write it.
"""

from __future__ import annotations

import mmap
import struct
import time
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError

_MAGIC = b"ACTSRING"
_VERSION = 1
_HEADER = struct.Struct("<8sIIII")
_HEADER_BYTES = 64
_WRITTEN_OFFSET = 24


def _slot_dtype(width: int) -> np.dtype:
    return np.dtype([("lock", "<u8"), ("time_ns", "<i8"), ("values", "<f8", (width,))])


class TimedRingWriter:
    """Creates the file, replacing an old one, and writes to it.

    Parameters
    ----------
    path : Path
        The file; a memory file system such as ``/dev/shm`` avoids disk writes.
    width : int
        Number of values in a slot.
    slots : int
        How many slots are kept; at 1 kHz, 128 hold an eighth of a second.
    """

    def __init__(self, path: Path, width: int, slots: int = 128) -> None:
        self.path = path
        dtype = _slot_dtype(width)
        total = _HEADER_BYTES + slots * dtype.itemsize
        # A new file under the old name: a reader of the old one keeps a whole, if ageing, ring.
        temporary = path.with_name(path.name + ".new")
        with temporary.open("w+b") as file:
            file.truncate(total)
            self._map = mmap.mmap(file.fileno(), total)
        self._map[: _HEADER.size] = _HEADER.pack(_MAGIC, _VERSION, slots, width, 0)
        self._written = np.frombuffer(self._map, dtype="<u8", count=1, offset=_WRITTEN_OFFSET)
        self._slots = np.frombuffer(self._map, dtype=dtype, count=slots, offset=_HEADER_BYTES)
        self._lock = self._slots["lock"]
        self._time_ns = self._slots["time_ns"]
        self._values = self._slots["values"]
        self._count = 0
        temporary.replace(path)

    def write(self, time_ns: int, values: NDArray[np.float64]) -> None:
        """Append one slot. `time_ns` must be greater than in the slot before; `values` has shape (width,)."""
        index = self._count % len(self._slots)
        # x86 keeps the order of stores; on other processors a torn slot is possible but is only simulated touch.
        self._lock[index] += np.uint64(1)
        self._time_ns[index] = time_ns
        self._values[index] = values
        self._lock[index] += np.uint64(1)
        self._count += 1
        self._written[0] = self._count

    def close(self) -> None:
        """Remove the file."""
        self.path.unlink(missing_ok=True)

    def __enter__(self) -> TimedRingWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class TimedRingReader:
    """Reads a ring that another process writes.

    Raises
    ------
    ActsError
        When the file is missing, is no ring, or has another width than asked for.
    """

    def __init__(self, path: Path, width: int) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                self._map = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        except (OSError, ValueError) as error:
            raise ActsError(
                f"{path}: no shared ring there ({error}); start the process that writes it first"
            ) from error
        if len(self._map) < _HEADER_BYTES:
            raise ActsError(f"{path}: too short to be a shared ring")
        magic, version, slots, given_width, _ = _HEADER.unpack_from(self._map)
        if magic != _MAGIC or version != _VERSION:
            raise ActsError(f"{path}: not a shared ring of version {_VERSION}")
        if given_width != width:
            raise ActsError(f"{path}: holds {given_width} values a slot, {width} are expected")
        dtype = _slot_dtype(width)
        if len(self._map) < _HEADER_BYTES + slots * dtype.itemsize:
            raise ActsError(f"{path}: shorter than its header says")
        self._written = np.frombuffer(self._map, dtype="<u8", count=1, offset=_WRITTEN_OFFSET)
        self._slots = np.frombuffer(self._map, dtype=dtype, count=slots, offset=_HEADER_BYTES)

    @property
    def written(self) -> int:
        """Number of slots written so far."""
        return int(self._written[0])

    def newest(self) -> tuple[int, NDArray[np.float64]] | None:
        """Time [ns] and a copy of the values of the newest slot; None before the first."""
        for _ in range(100):
            count = self.written
            if count == 0:
                return None
            slot = self._slots[(count - 1) % len(self._slots)]
            before = int(slot["lock"])
            time_ns, values = int(slot["time_ns"]), slot["values"].copy()
            if before % 2 == 0 and int(slot["lock"]) == before:
                return time_ns, values
        raise ActsError(f"{self.path}: the newest slot never came to rest; is its writer stuck?")

    def age_s(self) -> float:
        """Time since the newest slot [s]; infinite before the first."""
        newest = self.newest()
        return float("inf") if newest is None else (time.monotonic_ns() - newest[0]) / 1e9
