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
    return "\n".join([*lines, conditions(report), *complaints(report)])


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
    return "\n".join([*lines, "", conditions(report), *complaints(report, in_markdown=True)])


def conditions(report: Report) -> str:
    """Date, machine and load, in one line."""
    others = ", ".join(f"{name} {one['others_cpu_percent']:.0f}" for name, one in report["measurements"].items())
    return f"{surroundings(report)}; CPU used by others meanwhile [% of one core]: {others}"


def complaints(report: Report, *, in_markdown: bool = False) -> list[str]:
    """Lines of its warnings and problems; in Markdown a paragraph of each."""
    lines: list[str] = []
    for kind in ("warning", "problem"):
        told = report[f"{kind}s"]
        if not in_markdown:
            lines += [f"{kind}: {words}" for words in told]
        elif told:
            lines += ["", *(f"{kind.capitalize()}: {words}." for words in told)]
    return lines


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
