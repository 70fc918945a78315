# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Format a report of `acts bench` as plain text or Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from acts_tools.bench.result import Figure

Report = Mapping[str, Any]


def table(report: Report) -> str:
    """The report as plain text."""
    sections = [(f"{name}: {one['summary']}", list(_figures(one))) for name, one in report["measurements"].items()]
    width = max((len(figure.label) for _, figures in sections for figure in figures), default=0)
    lines: list[str] = []
    for title, figures in sections:
        lines.append(title)
        lines += [f"  {figure.label:<{width}}  {figure.text:>16}" for figure in figures]
        lines.append("")
    lines.append(conditions(report))
    lines += [f"warning: {warning}" for warning in report["warnings"]]
    lines += [f"problem: {problem}" for problem in report["problems"]]
    return "\n".join(lines)


def markdown(report: Report) -> str:
    """The report as a Markdown table; ratios are bold."""
    lines = ["| | |", "|---|---|"]
    for name, one in report["measurements"].items():
        lines.append(f"| *{one['summary']}* (`{name}`) | |")
        for figure in _figures(one):
            text = f"**{figure.text}**" if figure.is_ratio else figure.text
            # Markdown drops the indentation of details of the line above.
            label = figure.label.replace("    ", "&nbsp;&nbsp;")
            lines.append(f"| {label} | {text} |")
    lines += ["", conditions(report)]
    lines += ["", *(f"Warning: {warning}." for warning in report["warnings"])] if report["warnings"] else []
    lines += ["", *(f"Problem: {problem}." for problem in report["problems"])] if report["problems"] else []
    return "\n".join(lines)


def conditions(report: Report) -> str:
    """Date, machine and load, in one line."""
    others = ", ".join(f"{name} {one['others_cpu_percent']:.0f}" for name, one in report["measurements"].items())
    return f"{surroundings(report)}; CPU used by others meanwhile [% of one core]: {others}"


def surroundings(report: Report) -> str:
    """Date and machine, and load average before and after."""
    where = report["machine"]
    before, after = report["load_average_before"], report["load_average_after"]
    return (
        f"{report['date']}, {where['cores']} {where['architecture']} cores, Python {where['python']}, "
        f"ROS {where['ros']}; load average {before[0]:.2f} before, {after[0]:.2f} after"
    )


def _figures(measured: Mapping[str, Any]) -> Iterator[Figure]:
    return (Figure(**figure) for figure in measured["figures"])
