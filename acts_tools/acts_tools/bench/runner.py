# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Run measurements one after another and assemble the report."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from acts_core.errors import ActsError
from acts_tools.bench import machine
from acts_tools.bench.registry import MEASUREMENTS, Entry
from acts_tools.bench.result import Result
from acts_tools.bench.workbench import Workbench
from acts_tools.run_folder import run_folder
from acts_tools.running.stopping import StopFlag

OTHERS_WARNING_PERCENT = 10.0
"""Load by others above which the report warns [% of one core]."""


def choose(names: Sequence[str], entries: Mapping[str, Entry] = MEASUREMENTS) -> list[str]:
    """Choose the measurements to run.

    Parameters
    ----------
    names : sequence of str
        Names from the command line; empty for all short ones.
    entries : mapping of str to Entry
        The available measurements.

    Raises
    ------
    ActsError
        For an unknown name, with those that are known.
    """
    for name in names:
        if name not in entries:
            raise ActsError(f"there is no measurement '{name}'; there are: {', '.join(entries)}; and skins, by itself")
    return list(dict.fromkeys(names)) or [name for name, entry in entries.items() if not entry.only_by_name]


def run(
    names: Sequence[str], seconds: float | None, stop: StopFlag, write: Callable[[dict[str, Any]], None]
) -> dict[str, Any]:
    """Measure, and print the current measurement on standard error.

    A measurement that cannot be made is a problem in the report, and the next one follows.

    Parameters
    ----------
    names : sequence of str
        Measurements, in order.
    seconds : float or None
        Duration of each [s]; None for its default.
    stop : StopFlag
        When it is set, the run ends with KeyboardInterrupt.
    write : callable
        ``write(report)``: called after each measurement with the report of all so far.

    Returns
    -------
    dict
        The report, in the layout of ``out/bench.json``.
    """
    report: dict[str, Any] = {**begin_report(), "measurements": {}}
    for name in names:
        entry = MEASUREMENTS[name]
        print(f"[bench] {name}: {entry.summary}", file=sys.stderr, flush=True)
        report["measurements"][name] = _measure(entry, entry.seconds if seconds is None else seconds, stop)
        report["load_average_after"] = load_average()
        report["problems"] = [
            f"{known}: {problem}"
            for known, measured in report["measurements"].items()
            for problem in measured["problems"]
        ]
        report["warnings"] = _warnings(report["measurements"])
        write(report)
    return report


def begin_report() -> dict[str, Any]:
    """First fields of every report: date, machine and load average."""
    return {
        "date": datetime.now(timezone.utc).date().isoformat(),
        "machine": machine.describe(),
        "load_average_before": load_average(),
    }


def load_average() -> list[float]:
    """Load average of the last 1, 5 and 15 minutes."""
    return [round(load, 2) for load in os.getloadavg()]


def _measure(entry: Entry, seconds: float, stop: StopFlag) -> dict[str, Any]:
    others = machine.OthersMeter()
    with run_folder("acts_bench_") as folder:
        try:
            result = entry.load().measure(Workbench(seconds, Path(folder), stop))
        except ActsError as error:
            result = Result([], [str(error)])
    return {
        "summary": entry.summary,
        "seconds": seconds,
        "others_cpu_percent": round(others.percent(), 1),
        "figures": [asdict(figure) for figure in result.figures],
        "problems": result.problems,
    }


def _warnings(measured: Mapping[str, Mapping[str, Any]]) -> list[str]:
    busy = {
        name: one["others_cpu_percent"]
        for name, one in measured.items()
        if one["others_cpu_percent"] > OTHERS_WARNING_PERCENT
    }
    if not busy:
        return []
    loads = ", ".join(f"{name} {percent:.0f} %" for name, percent in busy.items())
    return [f"others used the CPU meanwhile ({loads} of one core): figures are worse than on a quiet machine"]
