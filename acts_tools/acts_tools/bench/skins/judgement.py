# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluate the figures of several skins: failures, warnings, and whether the targets are met."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from acts_core.words import counted
from acts_tools.bench.report import Report
from acts_tools.bench.rigs.memory import GROWTH_MAX_MB_PER_H
from acts_tools.bench.runner import OTHERS_WARNING_PERCENT
from acts_tools.bench.skins.processes import BENCH, RATE_HZ

ONE_CPU_PERCENT = 20.0
ONE_MEDIAN_MS = 0.35
ONE_P99_MS = 1.0
"""Targets for one skin without load on one core: CPU of driver and reconstruction, latency."""

SEVERAL = 4
SEVERAL_P99_MS = 5.0
"""Target for up to `SEVERAL` skins on two cores: no loss, and this latency [ms]."""

_SILENT_S = 1.0
_RATE_SHARE = 0.98


def problems(report: Report) -> list[str]:
    """Failures; being slow is not one."""
    found = []
    for skin in report["skins"]:
        if not skin["received"]:
            found.append(f"{skin['name']}: nothing was received")
            continue
        if skin["silent_s"] >= _SILENT_S:
            found.append(f"{skin['name']}: nothing was received in the last {skin['silent_s']:.0f} s")
        if skin["lost"]:
            found.append(f"{skin['name']}: {counted(skin['lost'], 'frame')} lost{_where(skin)}")
        troubles = {name: count for name, count in skin["driver"].items() if count and name not in ("lost", "overruns")}
        if troubles:
            counts = ", ".join(f"{count} {name}" for name, count in troubles.items())
            found.append(f"{skin['name']}: the driver counted {counts} on an undisturbed line")
    return found


def warnings(report: Report) -> list[str]:
    """Conditions that affect the figures."""
    found = []
    others = report["others_cpu_percent"]
    if others > OTHERS_WARNING_PERCENT:
        found.append(
            f"others used the CPU meanwhile ({others:.0f} % of one core): figures are worse than on a quiet machine"
        )
    slow = [
        f"{skin['name']} {skin['rate_hz']:.0f}" for skin in report["skins"] if skin["rate_hz"] < _RATE_SHARE * RATE_HZ
    ]
    if slow:
        found.append(f"fewer contacts than frames are due, {RATE_HZ:.0f} a second: {', '.join(slow)}")
    if report["realtime"] == "on":
        refused = [name for name, priority in report["realtime_granted"].items() if not (priority or _is_load(name))]
        if refused:
            found.append(f"not in real time, as the kernel did not grant it or took it away: {', '.join(refused)}")
    for name, memory in report["rss_mb"].items():
        growth = memory["growth_mb_per_h"]
        # The memory of this process grows by a number for every contact.
        if name != BENCH and growth is not None and growth > GROWTH_MAX_MB_PER_H:
            found.append(f"the memory of {name} grows by {growth:.1f} MB an hour")
    return found


def verdict(report: Report) -> list[str]:
    """Comparison of the figures with the targets, as sentences; empty where there is no target."""
    skins = report["skins"]
    if report["load"] or len(skins) > SEVERAL or any(not skin["received"] for skin in skins):
        return []
    worst_p99_ms = max(skin["latency_ms"]["p99"] for skin in skins)
    if len(skins) > 1:
        lost = sum(skin["lost"] for skin in skins)
        return [
            f"frames lost: {lost}, wanted 0" + _mark(lost == 0),
            _against("largest 99 % within", worst_p99_ms, SEVERAL_P99_MS, "ms"),
        ]
    cpu_percent = report["cpu_percent"][f"tactile {skins[0]['name']}"]
    return [
        _against("driver and reconstruction", cpu_percent, ONE_CPU_PERCENT, "% of a core"),
        _against("latency, median", skins[0]["latency_ms"]["median"], ONE_MEDIAN_MS, "ms"),
        _against("latency, 99 % within", worst_p99_ms, ONE_P99_MS, "ms"),
    ]


def total_percent(report: Report) -> float:
    """CPU of all processes but the load [% of one core]."""
    return round(sum(percent for name, percent in report["cpu_percent"].items() if not _is_load(name)), 2)


def _is_load(name: str) -> bool:
    return name.startswith("load ")


def _where(skin: Mapping[str, Any]) -> str:
    """Where frames were lost; the nodes count for slightly longer than this process."""
    left = int(skin["lost"])
    parts = []
    for count, where in (
        (skin["driver"]["lost"], "before the driver"),
        (skin["reconstruction"]["not_published"], "late and left out by the reconstruction for newer ones"),
        (left, "between them and the subscriber"),
    ):
        stayed = min(left, count)
        left -= stayed
        if stayed:
            parts.append(f"{stayed} {where}")
    dropped = min(skin["lost"], skin["driver"]["lost"], skin["driver"]["overruns"])
    if dropped:
        parts[0] += f", {dropped} of them dropped by the board"
    return f" ({'; '.join(parts)})"


def _against(what: str, value: float, wanted: float, unit: str) -> str:
    return f"{what}: {value:.4g} {unit}, wanted at most {wanted:g}{_mark(value <= wanted)}"


def _mark(is_met: bool) -> str:
    return ": met" if is_met else ": not met"
