# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Lines on a screen that never hold up who writes them."""

from __future__ import annotations

import io
import os
import select
import stat
import time
from contextlib import suppress
from typing import TextIO

# What waits for a reader; some ten thousand lines.
_WAITING_BYTES_MAX = 1 << 20


class Screen:
    """Writes lines, and keeps those that nobody reads for the present.

    Somebody looks at the output with `less`, or has pressed Ctrl-S: a plain write would wait until that is over, and
    nothing could be stopped meanwhile.

    Parameters
    ----------
    stream : TextIO
        A pipe or terminal is opened once more, so that nobody else's writes to it change. What cannot be opened so is
        written as usual.

    Methods raise OSError as the writes to a file do.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        if isinstance(stream, io.TextIOWrapper):
            # Processes may write what the terminal has no characters for.
            stream.reconfigure(errors="backslashreplace")
        self._file = _opened_again(stream)
        self._waiting = bytearray()
        self._left_out = 0

    @property
    def is_behind(self) -> bool:
        """Whether lines wait for a reader."""
        return bool(self._waiting)

    def close(self) -> None:
        """Drop what waits, and close the file of its own; the stream stays open."""
        self._waiting.clear()
        if self._file is not None:
            number, self._file = self._file, None
            with suppress(OSError):
                os.close(number)

    def write(self, line: str) -> None:
        """Write a line, now or later; where too much waits already it is left out, which is told in its place."""
        if self._file is None:
            self._stream.write(f"{line}\n")
            self._stream.flush()
            return
        data = f"{line}\n".encode(self._stream.encoding or "utf-8", "backslashreplace")
        if len(self._waiting) + len(data) > _WAITING_BYTES_MAX:
            self._left_out += 1
        else:
            self._waiting += data
        self.catch_up()

    def catch_up(self, timeout_s: float = 0.0) -> None:
        """Write what waits, as far as there is room, or comes to be within a time [s]."""
        if self._file is None:
            return
        end_s = time.monotonic() + timeout_s
        while self._waiting:
            try:
                del self._waiting[: os.write(self._file, self._waiting)]
            except BlockingIOError:
                rest_s = end_s - time.monotonic()
                if rest_s <= 0.0:
                    return
                select.select([], [self._file], [], rest_s)
            if not self._waiting and self._left_out:
                told, self._left_out = f"[WARNING] [launch]: lines left out here: {self._left_out}\n", 0
                self._waiting += told.encode()


def _opened_again(stream: TextIO) -> int | None:
    """A pipe or terminal as a file of our own that is never waited for; None where that cannot be."""
    try:
        number = stream.fileno()
        if not (os.isatty(number) or stat.S_ISFIFO(os.fstat(number).st_mode)):
            return None
        stream.flush()
        return os.open(f"/proc/self/fd/{number}", os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    except (OSError, ValueError):
        # No file of the system, or a terminal of another user, as after `su`.
        return None
