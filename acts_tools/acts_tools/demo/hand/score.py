# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures of a run of the hand, and whether it meets the limits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes import HandToHandConfig
from acts_tools.demo.hand.act import Act
from acts_tools.percentiles import percentiles

# The scenario judges an act; this module only describes the result.
_LARGEST_N = HandToHandConfig().hand_to_hand_max_force_n

Row = tuple[str, Any, str, str]
"""Name, value (None: unknown), unit, limit."""


def rows(act: Act) -> list[Row]:
    """The figures of an act."""
    outcome, details = act.outcome, act.outcome.details
    failed = details.get("failed")
    if failed:
        return [("not played", failed, "", "")]
    if act.name == "slip":
        return [
            ("load within 50 ms", details.get("load"), "x weight", ""),
            ("slip noticed after 0.2 mm of motion", _rounded(outcome.noticed_ms), "ms", "<= 15"),
            ("stopped after that", _rounded(outcome.stopped_ms), "ms", ""),
            ("moved along the load", _rounded(outcome.offset_mm, 2), "mm", "< 3"),
            ("kept", outcome.kept, "", "True"),
        ]
    if act.name == "sharp":
        both = None
        if outcome.noticed_ms is not None and outcome.stopped_ms is not None:
            both = outcome.noticed_ms + outcome.stopped_ms
        return [
            ("finger opens after contact with the tip", _rounded(both), "ms", "<= 20"),
            ("tip in the skin", _rounded(outcome.penetration_mm, 2), "mm", "< 2"),
            ("other contacts kept", outcome.kept, "", "True"),
        ]
    if act.name == "sphere":
        return [
            ("off the palm's centre at the begin", _rounded(details.get("begin_mm"), 1), "mm", ""),
            ("and at the end", _rounded(outcome.offset_mm, 1), "mm", "<= 5"),
            ("fingertips on it", len(details.get("tips", ())), "", ">= 2"),
        ]
    return [
        ("phalanges in contact, fewest", details.get("fewest"), "", ""),
        ("fewer than 3 of them, longest", _rounded(details.get("longest_fewer_ms")), "ms", "< 100"),
        ("largest force of a region", _rounded(details.get("largest_n"), 1), "N", f"< {_LARGEST_N:g}"),
    ]


def score(acts: list[Act]) -> dict[str, Any]:
    """The results of a run, in the layout of ``out/hand.json``."""
    results: dict[str, Any] = {
        "ok": False,
        "acts": {
            act.name: {"title": act.title, "ok": act.outcome.ok, **{name: value for name, value, _, _ in rows(act)}}
            for act in acts
        },
        "regions_rate_hz": _rounded(float(np.median([_regions_rate_hz(act) for act in acts])), 1),
        "cycle_ms": percentiles(_joined([act.recording.durations_s for act in acts]) * 1e3),
        "latency_ms": percentiles(_joined([act.recording.latencies_s for act in acts]) * 1e3),
        "cpu_percent": _cpu(acts),
    }
    results["failures"] = [failure for act in acts for failure in failures(act)]
    results["ok"] = not results["failures"]
    return results


def failures(act: Act) -> list[str]:
    """Failures of an act as sentences; empty for a good one."""
    if act.outcome.ok:
        return []
    told = ", ".join(f"{name}: {_shown(value, unit)}" for name, value, unit, _ in rows(act))
    return [f"{act.title} ({told})"]


def table(results: dict[str, Any], acts: list[Act]) -> str:
    """The results as a table for a person."""
    lines: list[tuple[str, str, str]] = []
    for act in acts:
        lines.append((act.title, "", ""))
        lines += [(f"    {name}", _shown(value, unit), wanted) for name, value, unit, wanted in rows(act)]
    lines.append(("regions of the skin", _shown(results["regions_rate_hz"], "Hz"), ""))
    for name, key in (("last measurement to the motors' goals", "latency_ms"), ("cycle of the hand", "cycle_ms")):
        lines.append((f"{name}, median", _shown(results[key]["median"], "ms"), ""))
        lines.append(("    99 % of all within", _shown(results[key]["p99"], "ms"), ""))
    lines += [(f"CPU, {name}", _shown(value, "% of one core"), "") for name, value in results["cpu_percent"].items()]
    width = max(len(name) for name, _, _ in lines)
    shown = [f"  {name:<{width}}  {value:>22}  {wanted}".rstrip() for name, value, wanted in lines]
    return "\n".join([*shown, "", "  result: " + ("good" if results["ok"] else "; ".join(results["failures"]))])


def _regions_rate_hz(act: Act) -> float:
    times_s = [time_s for time_s, _ in act.recording.regions]
    if len(times_s) < 2:
        return 0.0
    every = act.recording.regions_received / len(times_s)
    return every * (len(times_s) - 1) / (times_s[-1] - times_s[0])


def _joined(pieces: list[list[NDArray[np.float32]]]) -> NDArray[np.float32]:
    flat = [one for some in pieces for one in some]
    return np.concatenate(flat) if flat else np.empty(0, dtype=np.float32)


def _cpu(acts: list[Act]) -> dict[str, float]:
    """Mean load over the acts, by process [% of one core]."""
    names = sorted({name for act in acts for name in act.recording.cpu_percent})
    return {
        name: round(float(np.mean([act.recording.cpu_percent.get(name, 0.0) for act in acts])), 1) for name in names
    }


def _rounded(value: float | None, decimals: int = 1) -> float | None:
    return None if value is None else round(float(value), decimals)


def _shown(value: Any, unit: str) -> str:
    return "-" if value is None else f"{value} {unit}".strip()
