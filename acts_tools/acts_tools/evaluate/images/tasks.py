# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluate several tasks, with progress on a terminal, a line per task on stdout, and all in the JSON file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from acts_core.errors import RecordingError
from acts_recon.sparse import Dictionary
from acts_tools.evaluate import report
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate, images, method_of
from acts_tools.progress import Progress

HEADER = (
    f"{'scheme':9} {'M':>4} {'method':6} {'frames':>7} {'rel.err':>8} {'support':>8} {'CoP mean':>9} {'p95':>7} "
    f"{'touch mean':>10} {'p95':>7} {'missed':>7} {'invented':>9} {'notice p50':>10} {'p99 ms':>7} {'us':>7} "
    f"{'onset err':>9} {'touch':>6} {'err/sigma':>9} {'<2sigma':>7}"
)


def line(result: dict[str, Any]) -> str:
    """One entry of `results` as a line of the table; `touch` is of pressed taxels, sigma of touched taxels."""
    cop, touch, notice = (result[name] for name in ("cop_error_taxels", "touch_cop_error_taxels", "notice_ms"))
    touched = (result["sigma"] or {"touched": {"ratio": None, "within_2": None}})["touched"]
    return (
        f"{result['scheme']:9} {result['m']:4} {result['method']:6} {result['frames']:7} "
        f"{report.number(result['relative_error'], 8, 4)} {report.number(result['support_accuracy'], 8, 4)} "
        f"{report.number(cop['mean'], 9, 4)} {report.number(cop['p95'], 7, 3)} "
        f"{report.number(touch['mean'], 10, 4)} {report.number(touch['p95'], 7, 3)} "
        f"{report.number(result['missed'], 7, 4)} {report.number(result['invented_rate'], 9, 6)} "
        f"{report.number(notice['p50'], 10, 1)} {report.number(notice['p99'], 7, 1)} "
        f"{report.number(result['frame_us']['median'], 7, 1)} {report.number(result['onset']['relative_error'], 9, 4)} "
        f"{report.number(result['onset']['touch_cop_error_taxels']['mean'], 6, 2)} "
        f"{report.number(touched['ratio'], 9, 2)} {report.number(touched['within_2'], 7, 3)}"
    )


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
    print(HEADER, flush=True)
    for task in tasks:
        scored = evaluate_shown(recordings, task, dictionary)
        results.add(scored, line(scored))


def require_scored(entries: Sequence[dict[str, Any]], source: str, touch_counts: float) -> None:
    """Check that some of the entries, of recordings with taxels above `touch_counts`, have a frame that is scored.

    Raises
    ------
    RecordingError
        None has.
    """
    if not any(entry["frames"] or entry["onset"]["frames"] for entry in entries):
        raise RecordingError(
            f"{source}: nothing was scored, since no frame ends in a contact; needed are recordings with taxels above "
            f"--touch-counts {touch_counts}"
        )
