# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Progress of a long task: a tqdm bar on a terminal, a few lines or nothing elsewhere; and results meanwhile."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import TextIO

from tqdm import tqdm

_LINES = 10
"""Largest number of lines without a terminal."""


def tell(line: str, stream: TextIO | None = None) -> None:
    """Print a line on standard output or another stream, above the bars that a terminal shows."""
    stream = sys.stdout if stream is None else stream
    with tqdm.external_write_mode(stream):
        print(line, file=stream, flush=True)


class Progress:
    """Context that shows the progress of a task.

    Parameters
    ----------
    title : str
        Name of the task.
    total : int
        Number of steps, at least 1.
    done : int
        Steps that were done before; they are excluded from the estimate of the remaining time.
    keep : bool
        True: leave the bar on the terminal, and print at most ten lines without a terminal. False: clear the bar at the
        end, and print nothing without a terminal.
    stream : TextIO or None
        Output; None for standard error.
    """

    def __init__(
        self, title: str, total: int, *, done: int = 0, keep: bool = False, stream: TextIO | None = None
    ) -> None:
        self._title = title
        self._total = total
        self._stream = sys.stderr if stream is None else stream
        self._print_lines = keep and not self._stream.isatty()
        self._lines = done * _LINES // total
        steps = " {n_fmt}/{total_fmt}" if keep else ""
        self._bar = tqdm(
            desc=title,
            total=total,
            initial=done,
            leave=keep,
            file=self._stream,
            disable=None,  # without a terminal
            dynamic_ncols=True,
            bar_format="{desc}: {percentage:.0f}%|{bar}|" + steps + " [{elapsed}<{remaining}{postfix}]",
        )

    def show(self, done: float, note: str = "") -> None:
        """Show the number of steps that are done, and a note on the last one."""
        done = min(done, self._total)
        if self._print_lines:
            lines = int(done * _LINES // self._total)
            if lines > self._lines:
                self._lines = lines
                after = f": {note}" if note else ""
                print(f"{self._title} {done} of {self._total}{after}", file=self._stream, flush=True)
        self._bar.set_postfix_str(note, refresh=False)
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._bar.close()
