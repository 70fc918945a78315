# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures of a ball-balancing run, and whether it meets the limits."""

from __future__ import annotations

from typing import Any

import numpy as np

from acts_core.words import counted
from acts_tools.demo.ball.recording import Recording
from acts_tools.percentiles import percentiles

HOLD_SETTLE_S = 2.0
"""Time at the start of holding that is not scored [s], because the ball starts off the centre."""

LIMITS = {
    "contact_rate_hz": 995.0,
    "frames_lost": 0,
    "rms_mm.hold": 3.0,
    "rms_mm.N": 5.0,
    "rms_mm.B": 5.0,
    "rms_mm.I": 5.0,
}
"""Smallest rate, largest losses and errors of a good run."""

LETTERS = ("N", "B", "I")

MAX_GAP_S = 0.2
"""Longest time without a true position or a reference that a judgement may bridge by interpolation [s]."""


def rms_error_mm(recording: Recording, segment: str, *, skip_s: float = 0.0) -> float | None:
    """Root mean square distance of the true ball from the reference in one segment [mm].

    Parameters
    ----------
    recording : Recording
        The run.
    segment : str
        Name of the segment; all its occurrences are included.
    skip_s : float
        Time at the beginning of the run that is excluded [s].

    Returns
    -------
    float or None
        None when the segment does not occur.
    """
    if not recording.reference.time_s or len(recording.truth.time_s) < 2:
        return None
    time_s = np.array(recording.reference.time_s)
    wanted = np.column_stack([recording.reference.x_m, recording.reference.y_m])
    chosen = np.array([name == segment for name in recording.segments]) & (time_s >= time_s[0] + skip_s)
    # After the last known truth there is nothing to compare with.
    chosen &= time_s <= recording.truth.time_s[-1]
    if not chosen.any():
        return None
    distance_m = np.linalg.norm(recording.truth.at(time_s[chosen]) - wanted[chosen], axis=1)
    return float(np.sqrt(np.mean(distance_m**2)) * 1000)


def largest_gap_s(recording: Recording) -> float:
    """Longest time without a reference, or without a true position, while the control loop was closed [s].

    After a ball has fallen off the plate, neither counts.
    """
    reference_s = np.array(recording.reference.time_s)
    if recording.has_fallen:
        reference_s = reference_s[reference_s <= max(recording.truth.time_s, default=-np.inf)]
    if not reference_s.size:
        return 0.0
    truth_s = np.clip(recording.truth.time_s, reference_s[0], reference_s[-1])
    covered_s = np.concatenate([reference_s[:1], truth_s, reference_s[-1:]])
    return float(max(np.diff(reference_s).max(initial=0.0), np.diff(covered_s).max()))


def score(recording: Recording) -> dict[str, Any]:
    """The results of a run, in the layout of ``out/ball_balancing.json``."""
    latencies_ms = np.concatenate(recording.latencies_s) * 1000 if recording.latencies_s else np.empty(0)
    rms_mm = {"hold": rms_error_mm(recording, "hold", skip_s=HOLD_SETTLE_S)}
    rms_mm.update({letter: rms_error_mm(recording, letter) for letter in LETTERS})
    results: dict[str, Any] = {
        "ok": False,
        "contact_rate_hz": round(recording.contact_rate_hz, 2),
        "contacts_received": recording.contacts_received,
        "contacts_lost": recording.contacts_lost,
        "frames_lost": recording.frames_lost,
        "crc_errors": recording.crc_errors,
        "latency_ms": percentiles(latencies_ms),
        "touch_age_ms": percentiles(np.array(recording.touch_age_s) * 1000),
        "rms_mm": {name: None if value is None else round(value, 3) for name, value in rms_mm.items()},
        "cpu_percent": {name: round(value, 1) for name, value in sorted(recording.cpu_percent.items())},
    }
    results["failures"] = failures(recording, results)
    results["ok"] = not results["failures"]
    return results


def failures(recording: Recording, results: dict[str, Any]) -> list[str]:
    """Failures as sentences; empty for a good run."""
    found = []
    if recording.stop_reason:
        found.append(f"the controller stopped: {recording.stop_reason}")
    if recording.has_fallen:
        found.append("the ball fell off the plate")
    if not recording.finished:
        found.append("the trajectory did not come to its end")
    gap_s = largest_gap_s(recording)
    if gap_s > MAX_GAP_S:
        found.append(
            f"the demo itself received nothing for {gap_s:.1f} s, so its errors of position say nothing: "
            "other programs took its CPU (acts doctor tells)"
        )
    if results["contact_rate_hz"] < LIMITS["contact_rate_hz"]:
        found.append(
            f"{results['contact_rate_hz']} contacts/s received, at least {LIMITS['contact_rate_hz']:g} are wanted: "
            "this machine was too slow for 1 kHz, or other programs took its CPU (acts doctor tells)"
        )
    if results["frames_lost"] > LIMITS["frames_lost"]:
        found.append(f"{counted(results['frames_lost'], 'frame')} lost between board and driver")
    if all(value is None for value in results["rms_mm"].values()):
        found.append("no segment was traced")
    for name, value in results["rms_mm"].items():
        limit = LIMITS[f"rms_mm.{name}"]
        if value is not None and not value <= limit:
            found.append(f"{name}: {value} mm rms, at most {limit:g} are wanted")
    return found


def table(results: dict[str, Any]) -> str:
    """The results as a table for a person."""
    rows: list[tuple[str, str, str]] = []

    def row(name: str, value: Any, unit: str, wanted: str = "") -> None:
        rows.append((name, "-" if value is None else f"{value} {unit}".strip(), wanted))

    row("contacts received by the control node", results["contact_rate_hz"], "Hz", f">= {LIMITS['contact_rate_hz']:g}")
    row("frames lost, board to driver", results["frames_lost"], "", f"{LIMITS['frames_lost']:g}")
    row("contacts lost, driver to control node", results["contacts_lost"], "")
    latency = results["latency_ms"]
    row("latency, last measurement to the control node's process, median", latency["median"], "ms")
    row("    99 % of all within", latency["p99"], "ms")
    row("    99.9 % within", latency["p999"], "ms")
    age = results["touch_age_ms"]
    row("newest touch when a control step used it, median", age["median"], "ms")
    row("    99 % of all within", age["p99"], "ms")
    for name, value in results["rms_mm"].items():
        what = "ball held at the centre" if name == "hold" else f"{name} traced"
        row(f"{what}, rms error", value, "mm", f"<= {LIMITS[f'rms_mm.{name}']:g}")
    for name, value in results["cpu_percent"].items():
        row(f"CPU, {name}", value, "% of one core")
    width = max(len(name) for name, _, _ in rows)
    lines = [f"  {name:<{width}}  {value:>22}  {wanted}".rstrip() for name, value, wanted in rows]
    lines.append("")
    lines.append("  result: " + ("good" if results["ok"] else "; ".join(results["failures"])))
    return "\n".join(lines)
