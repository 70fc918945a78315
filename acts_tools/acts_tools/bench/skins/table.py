# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Format the report of `acts bench skins` as plain text or Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from acts_core.words import counted
from acts_tools.bench.report import Report, complaints, surroundings
from acts_tools.bench.result import shortened

Rows = Sequence[Sequence[str]]

_LATENCIES = {"median": "median [ms]", "p99": "99 %", "p999": "99.9 %", "max": "largest"}


def table(report: Report) -> str:
    """The report as plain text."""
    lines = [_title(report), ""]
    for rows in (_skins(report), _processes(report)):
        lines += [*_plain(rows), ""]
    lines += report["verdict"]
    return "\n".join([*lines, _conditions(report), *complaints(report)])


def markdown(report: Report) -> str:
    """The report as Markdown tables."""
    lines = [_title(report), ""]
    for rows in (_skins(report), _processes(report)):
        head, *body = ("| " + " | ".join(row) + " |" for row in rows)
        lines += [head, "|---|" + "---:|" * (len(rows[0]) - 1), *body, ""]
    lines += [f"- {words}" for words in report["verdict"]]
    return "\n".join([*lines, "", _conditions(report), *complaints(report, in_markdown=True)])


def _title(report: Report) -> str:
    count, load, rate_hz = len(report["skins"]), report["load"], report["settings"]["rate_hz"]
    skins = counted(count, "skin")
    beside = "nothing beside" if not load else f"{counted(load, 'busy loop')} beside"
    scheduled = "in real time" if report["realtime"] == "on" else "ordinary scheduling"
    conditions = f"{rate_hz:.0f} frames/s, M = {report['settings']['m']}, {report['seconds']:.0f} s"
    return f"{skins}, {conditions}, {beside}, {scheduled}"


def _skins(report: Report) -> Rows:
    rows = [["skin", "contacts/s", "lost", "before driver", "left out", *_LATENCIES.values()]]
    for skin in report["skins"]:
        latencies = [_number(skin["latency_ms"][key]) for key in _LATENCIES]
        counts = [str(skin["lost"]), str(skin["driver"]["lost"]), str(skin["reconstruction"]["not_published"])]
        rows.append([skin["name"], f"{skin['rate_hz']:.1f}", *counts, *latencies])
    return rows


def _processes(report: Report) -> Rows:
    rows = [["process", "CPU [% of a core]", "memory [MB]", "at the end"]]
    for name, percent in report["cpu_percent"].items():
        memory = report["rss_mb"][name]
        rows.append([name, f"{percent:.1f}", f"{memory['start']:.1f}", f"{memory['end']:.1f}"])
    rows.append(["all without load", f"{report['cpu_percent_total']:.1f}", "", ""])
    return rows


def _plain(rows: Rows) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for first, *others in rows:
        cells = (f"{cell:>{width}}" for cell, width in zip(others, widths[1:], strict=True))
        lines.append(f"  {first:<{widths[0]}}  {'  '.join(cells)}".rstrip())
    return lines


def _conditions(report: Report) -> str:
    return f"{surroundings(report)}; CPU used by others meanwhile [% of one core]: {report['others_cpu_percent']:.0f}"


def _number(value: float | None) -> str:
    return "-" if value is None else shortened(value)
