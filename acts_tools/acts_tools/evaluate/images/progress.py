"""Evaluating task after task: how far it is on a terminal, a line for each on stdout, all of them in the JSON file."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any, TextIO

from acts_recon.sparse import Dictionary
from acts_tools.evaluate import report
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate, images, method_of


class Progress:
    """While it is entered, a terminal shows how much of a work of `total` steps is done, and how long the rest takes.

    Parameters
    ----------
    title : str
        What is being done.
    total : int
        Steps, at least 1.
    stream : TextIO or None
        Where to write; None for standard error. Nothing is written where that is no terminal.
    """

    def __init__(self, title: str, total: int, stream: TextIO | None = None) -> None:
        self._title = title
        self._total = total
        self._stream = sys.stderr if stream is None else stream
        self._shown = self._stream.isatty()
        self._begin_s = time.monotonic()

    def show(self, done: float) -> None:
        """Show that so many steps are done."""
        if not self._shown:
            return
        share = min(done / self._total, 1.0)
        left = f", {(time.monotonic() - self._begin_s) * (1 / share - 1):.0f} s left" if share > 0 else ""
        self._stream.write(f"\r\033[K{self._title}: {share:.0%}{left}")
        self._stream.flush()

    def __enter__(self) -> Progress:
        self.show(0)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        if self._shown:
            self._stream.write("\r\033[K")
            self._stream.flush()


def evaluate_shown(
    recordings: Sequence[Recording], task: Task, dictionary: Dictionary, title: str = ""
) -> dict[str, Any]:
    """`evaluate`, showing on a terminal how far it is."""
    name = f"{title}{task.sampling.scheme}, M = {task.sampling.m}, {task.method}"
    with Progress(name, images(recordings, task)) as progress:
        return evaluate(recordings, task, dictionary, progress.show)


def require_methods(tasks: Sequence[Task], dictionary: Dictionary) -> None:
    """Make every method once: what does not fit the array is told before the first of them has worked for minutes.

    Raises
    ------
    ArrayError
        When the patches of one do not fit.
    """
    for task in {task.method: task for task in tasks}.values():
        method_of(task, dictionary)


def evaluate_all(
    recordings: Sequence[Recording], tasks: Sequence[Task], dictionary: Dictionary, results: report.Results
) -> None:
    """Print a table of all tasks on the same recordings, and collect it in `results`."""
    require_methods(tasks, dictionary)
    print(report.HEADER, flush=True)
    for task in tasks:
        results.add(evaluate_shown(recordings, task, dictionary))
        print(report.line(results.entries[-1]), flush=True)
