# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Output of the evaluations: lines of a table, and JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_tools.output_file import require_writable

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
        f"{number(result['relative_error'], 8, 4)} {number(result['support_accuracy'], 8, 4)} "
        f"{number(cop['mean'], 9, 4)} {number(cop['p95'], 7, 3)} "
        f"{number(touch['mean'], 10, 4)} {number(touch['p95'], 7, 3)} "
        f"{number(result['missed'], 7, 4)} {number(result['invented_rate'], 9, 6)} "
        f"{number(notice['p50'], 10, 1)} {number(notice['p99'], 7, 1)} "
        f"{number(result['frame_us']['median'], 7, 1)} {number(result['onset']['relative_error'], 9, 4)} "
        f"{number(result['onset']['touch_cop_error_taxels']['mean'], 6, 2)} "
        f"{number(touched['ratio'], 9, 2)} {number(touched['within_2'], 7, 3)}"
    )


def number(value: float | None, width: int, digits: int) -> str:
    """A number in a table, or a dash for None."""
    return f"{'-':>{width}}" if value is None else f"{value:{width}.{digits}f}"


def write_json(path: Path | None, report: dict[str, Any]) -> None:
    """Write a report, unless `path` is None.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    if path is None:
        return
    try:
        path.write_text(json.dumps(report, indent=2) + "\n")
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written ({error.strerror}); its folder must exist") from error


class Results:
    """The entries of a report. Each is written to the JSON file at once, so that an interrupted run keeps them.

    Parameters
    ----------
    path : Path or None
        The JSON file; None for none.
    about : dict
        Further fields of the report.

    Raises
    ------
    RecordingError
        When the file cannot be written.
    """

    def __init__(self, path: Path | None, about: dict[str, Any]) -> None:
        require_writable(path)
        self.entries: list[dict[str, Any]] = []
        self._path = path
        self._about = about

    def add(self, entry: dict[str, Any]) -> None:
        """Add an entry."""
        self.entries.append(entry)
        write_json(self._path, {**self._about, "results": self.entries})
