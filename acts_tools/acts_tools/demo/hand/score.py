# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures of a run of the hand, whether each act worked, and whether it met the limits that are asked of it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes import HandToHandConfig
from acts_tools.demo.hand.act import Act
from acts_tools.evaluate.hand.scenario import Outcome
from acts_tools.percentiles import percentiles

_LARGEST_N = HandToHandConfig().hand_to_hand_max_force_n

# An act has worked within these; what is asked of it, by its scenario, is stricter.
_OPENED_MS = 100.0
_MOVED_MM = 3.0

# Up to here an object may move before its slip has to be noticed.
_NOTICEABLE_MM = 0.2


class Row(NamedTuple):
    """A figure of an act.

    Attributes
    ----------
    name : str
    value : Any
        None: unknown.
    unit : str
    limit : str
        What is asked of it, empty for nothing.
    is_met : bool
        Whether the value before it was rounded is within the limit.
    """

    name: str
    value: Any
    unit: str = ""
    limit: str = ""
    is_met: bool = True


def rows(act: Act) -> list[Row]:
    """The figures of an act."""
    outcome, details = act.outcome, act.outcome.details
    failed = details.get("failed")
    if failed:
        return [Row("not played", failed)]
    if act.name == "slip":
        noticed = _at_most(15, "slip noticed after 0.2 mm of motion", outcome.noticed_ms, "ms")
        if outcome.offset_mm is not None and outcome.offset_mm <= _NOTICEABLE_MM:
            noticed = noticed._replace(is_met=True)
        return [
            Row("load within 50 ms", details.get("load"), "x weight"),
            noticed,
            Row("stopped after that", _rounded(outcome.stopped_ms), "ms"),
            _below(_MOVED_MM, "moved along the load", outcome.offset_mm, "mm", 2),
            _kept("kept", outcome),
        ]
    if act.name == "sharp":
        return [
            _at_most(20, "finger opens after contact with the tip", _opened_ms(outcome), "ms"),
            _below(2, "tip in the skin", outcome.penetration_mm, "mm", 2),
            _kept("other contacts kept", outcome),
        ]
    if act.name == "sphere":
        tips = len(details.get("tips", ()))
        return [
            Row("off the palm's centre at the begin", _rounded(details.get("begin_mm")), "mm"),
            _at_most(5, "and at the end", outcome.offset_mm, "mm"),
            Row("fingertips on it", tips, "", ">= 2", tips >= 2),
            _kept("kept", outcome),
        ]
    return [
        Row("phalanges in contact, fewest", details.get("fewest")),
        _below(100, "fewer than 3 of them, longest", details.get("longest_fewer_ms"), "ms"),
        _below(_LARGEST_N, "largest force of a region", details.get("largest_n"), "N"),
    ]


def _at_most(limit: float, name: str, value: float | None, unit: str) -> Row:
    return Row(name, _rounded(value), unit, f"<= {limit:g}", value is not None and value <= limit)


def _below(limit: float, name: str, value: float | None, unit: str, decimals: int = 1) -> Row:
    return Row(name, _rounded(value, decimals), unit, f"< {limit:g}", value is not None and value < limit)


def _kept(name: str, outcome: Outcome) -> Row:
    return Row(name, outcome.kept, "", "True", bool(outcome.kept))


def works(act: Act) -> bool:
    """Whether the reflex of an act did what it is for: `Outcome.ok` is that all figures are as good as asked as well.

    slip: the object is kept and moved by less than 3 mm. sharp: the finger opens within 100 ms of the contact and the
    other contacts persist. sphere: two fingertips touch it, and it is nearer to the palm's centre than before.
    hand_to_hand: as asked.
    """
    outcome, details = act.outcome, act.outcome.details
    if outcome.ok:
        return True
    if act.name == "slip":
        return bool(outcome.kept) and outcome.offset_mm is not None and outcome.offset_mm < _MOVED_MM
    if act.name == "sharp":
        opened_ms = _opened_ms(outcome)
        return bool(outcome.kept) and opened_ms is not None and opened_ms <= _OPENED_MS
    if act.name == "sphere":
        begin_mm, end_mm = details.get("begin_mm"), outcome.offset_mm
        is_nearer = begin_mm is not None and end_mm is not None and end_mm < begin_mm
        return is_nearer and len(details.get("tips", ())) >= 2
    return False


def score(acts: list[Act]) -> dict[str, Any]:
    """The results of a run, in the layout of ``out/hand.json``.

    ``ok``: every act met what is asked of it. ``works``: every act worked; `failures` has those that did not, `missed`
    those that worked and missed a figure.
    """
    results: dict[str, Any] = {
        "ok": all(act.outcome.ok for act in acts),
        "works": all(works(act) for act in acts),
        "acts": {
            act.name: {
                "title": act.title,
                "ok": act.outcome.ok,
                "works": works(act),
                **{row.name: row.value for row in rows(act)},
            }
            for act in acts
        },
        "regions_rate_hz": _rounded(float(np.median([_regions_rate_hz(act) for act in acts])), 1),
        "cycle_ms": percentiles(_joined([act.recording.durations_s for act in acts]) * 1e3),
        "latency_ms": percentiles(_joined([act.recording.latencies_s for act in acts]) * 1e3),
        "cpu_percent": _cpu(acts),
    }
    results["failures"] = [_told(act) for act in acts if not works(act)]
    results["missed"] = [_told_missed(act) for act in acts if works(act) and not act.outcome.ok]
    return results


def _told(act: Act) -> str:
    """An act and its figures in a line."""
    told = ", ".join(f"{row.name}: {_shown(row.value, row.unit)}" for row in rows(act))
    return f"{act.title} ({told})"


def _told_missed(act: Act) -> str:
    """An act and the figures that are not as good as asked in a line, with what is asked."""
    missed = [f"{row.name}: {_shown(row.value, row.unit)}, asked {row.limit}" for row in rows(act) if not row.is_met]
    return f"{act.title} ({'; '.join(missed)})"


def _opened_ms(outcome: Outcome) -> float | None:
    """From the contact with the tip until the finger opens [ms]; None where it does not."""
    if outcome.noticed_ms is None or outcome.stopped_ms is None:
        return None
    return outcome.noticed_ms + outcome.stopped_ms


def table(results: dict[str, Any], acts: list[Act]) -> str:
    """The results as a table for a person."""
    lines: list[tuple[str, str, str]] = []
    for act in acts:
        lines.append((act.title, "", ""))
        lines += [(f"    {row.name}", _shown(row.value, row.unit), row.limit) for row in rows(act)]
    lines.append(("regions of the skin", _shown(results["regions_rate_hz"], "Hz"), ""))
    for name, key in (("last measurement to the motors' goals", "latency_ms"), ("cycle of the hand", "cycle_ms")):
        lines.append((f"{name}, median", _shown(results[key]["median"], "ms"), ""))
        lines.append(("    99 % of all within", _shown(results[key]["p99"], "ms"), ""))
    lines += [(f"CPU, {name}", _shown(value, "% of one core"), "") for name, value in results["cpu_percent"].items()]
    width = max(len(name) for name, _, _ in lines)
    shown = [f"  {name:<{width}}  {value:>22}  {wanted}".rstrip() for name, value, wanted in lines]
    return "\n".join([*shown, "", *_verdict(results)])


def _verdict(results: dict[str, Any]) -> list[str]:
    if results["ok"]:
        return ["  result: good"]
    told = [f"  did not work: {failure}" for failure in results["failures"]]
    told += [f"  worked, not as well as asked: {missed}" for missed in results["missed"]]
    return [f"  result: {'works' if results['works'] else 'not good'}", *told]


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
