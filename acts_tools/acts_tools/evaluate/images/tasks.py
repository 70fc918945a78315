# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluate several tasks, with progress on a terminal, a line per task on stdout, and all in the JSON file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from acts_recon.sparse import Dictionary
from acts_tools.evaluate import report
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate, images, method_of
from acts_tools.progress import Progress


def evaluate_shown(
    recordings: Sequence[Recording], task: Task, dictionary: Dictionary, title: str = ""
) -> dict[str, Any]:
    """`evaluate` with a progress bar on a terminal."""
    name = f"{title}{task.sampling.scheme}, M = {task.sampling.m}, {task.method}"
    with Progress(name, images(recordings, task)) as progress:
        return evaluate(recordings, task, dictionary, progress.show)


def require_methods(tasks: Sequence[Task], dictionary: Dictionary) -> None:
    """Make every method once, so that one that does not fit the array fails before the first has run for minutes.

    Raises
    ------
    ArrayError
        When the patches of a method do not fit.
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
