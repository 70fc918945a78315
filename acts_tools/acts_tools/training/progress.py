"""How far a long work is: a bar on a terminal, now and then a line elsewhere."""

from __future__ import annotations

import shutil
import sys
import time
from typing import TextIO

_BAR = 24
_LINES = 10
"""Lines at most where there is no terminal, and a last one."""

_REDRAW_S = 0.1


class ProgressBar:
    """Shows a work of `total` steps.

    Parameters
    ----------
    title : str
        What is being done.
    total : int
        Steps, at least 1.
    done : int
        Steps done before; the time that is left is estimated from the others.
    stream : TextIO or None
        Where to write; None for standard output.
    """

    def __init__(self, title: str, total: int, *, done: int = 0, stream: TextIO | None = None) -> None:
        self._title = title
        self._total = total
        self._first = done
        self._stream = sys.stdout if stream is None else stream
        self._terminal = self._stream.isatty()
        self._begin_s = time.monotonic()
        self._drawn_s = float("-inf")
        self._lines = done * _LINES // total

    def show(self, done: int, note: str = "") -> None:
        """Show that so many steps are done, and a note on the last of them."""
        now_s = time.monotonic()
        if not self._terminal:
            if done * _LINES // self._total > self._lines or done == self._total:
                self._lines = done * _LINES // self._total
                self._stream.write(f"{self._title} {done} of {self._total}{_after(note)}\n")
        elif done == self._total or now_s - self._drawn_s >= _REDRAW_S:
            self._drawn_s = now_s
            filled = _BAR * done // self._total
            line = f"{self._title} [{'#' * filled}{'.' * (_BAR - filled)}] {done}/{self._total}"
            line += f"{self._left(done, now_s - self._begin_s)}{_after(note)}"
            self._stream.write(f"\r\033[K{line[: shutil.get_terminal_size().columns - 1]}")
            self._stream.write("\n" if done == self._total else "")
        self._stream.flush()

    def _left(self, done: int, elapsed_s: float) -> str:
        if done == self._total or done <= self._first:
            return ""
        return f" {elapsed_s / (done - self._first) * (self._total - done):.0f} s left"


def _after(note: str) -> str:
    return f": {note}" if note else ""
