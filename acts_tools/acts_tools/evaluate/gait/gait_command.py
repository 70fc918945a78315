# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate gait`: steps on recorded insoles against the force curve's own, and on simulated ones.

What the numbers mean is told in docs/gait.md.
"""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_recon.gait import FEET, GaitConfig
from acts_tools.arguments import real, refuse_unused
from acts_tools.evaluate import report
from acts_tools.evaluate.gait import force_curve, walks
from acts_tools.evaluate.gait.insoles import FoundSteps, InsoleRecording, find_steps, read_insoles
from acts_tools.evaluate.options import add_seeds
from acts_tools.large_files import tell_if_large
from acts_tools.progress import Progress

_RATES_HZ = (8.0, 30.0, 100.0, 1000.0)
_COMPARED = ("stance_s", "swing_s", "peak_force", "progress_m")
_RECORDED_TITLE = (
    f"{'recording':14} {'foot':5} {'steps':>5} {'curve':>5} {'steps/min':>9} {'curve':>6} {'stance s':>8} "
    f"{'swing s':>8} {'CoP mm':>7} {'peak':>9}"
)
_WALKS_TITLE = (
    f"{'rate Hz':>7} {'walks':>5} {'steps':>5} {'found':>5} {'wrong':>5} {'cadence':>8} {'strike ms':>9} {'sd':>5} "
    f"{'toe off':>7} {'sd':>5} {'within 1':>8} {'CoP mm':>7} {'double':>7} {'standing':>8}"
)


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate gait``."""
    parser = commands.add_parser(
        "gait",
        help="detect steps on recorded or simulated insoles",
        description="Find the steps of both feet, and compare their number and cadence with what the force curve of "
        "the whole recording shows; without --frames on simulated insoles, where the truth is known. docs/gait.md "
        "explains the numbers.",
    )
    parser.add_argument(
        "--frames",
        type=Path,
        metavar="NPZ",
        help="`frames` (n, 2, rows, cols), the left foot first, or (n, rows, cols) of one; the toes at the first row; "
        "with `t_s` or `rate_hz`; optionally `start` and `length` of each recording",
    )
    parser.add_argument(
        "--length-m",
        type=real(0.01, 10.0),
        default=0.28,
        metavar="X",
        help="of a recorded insole (default: %(default)s)",
    )
    parser.add_argument(
        "--width-m",
        type=real(0.01, 10.0),
        default=0.085,
        metavar="X",
        help="of a recorded insole (default: %(default)s)",
    )
    parser.add_argument(
        "--rate",
        type=real(1.0, 10_000.0),
        nargs="+",
        default=list(_RATES_HZ),
        metavar="HZ",
        help=f"frames per second of simulated insoles (default: {' '.join(f'{rate:g}' for rate in _RATES_HZ)})",
    )
    add_seeds(parser, 20, "simulated walks at each rate")
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    if arguments.frames is not None:
        refuse_unused(arguments, "on recorded insoles", "rate", "seeds", "seed")
        return _run_recorded(arguments)
    refuse_unused(arguments, "without --frames: simulated insoles have sizes of their own", "length_m", "width_m")
    results = report.Results(arguments.json, {"seed": arguments.seed, "seeds": arguments.seeds})
    print(_WALKS_TITLE, flush=True)
    with Progress("gait", len(arguments.rate) * arguments.seeds) as progress:
        for number, rate_hz in enumerate(arguments.rate):
            scores = walks.WalkScores(rate_hz)
            for seed in range(arguments.seeds):
                scores.add([arguments.seed, seed])
                progress.show(number * arguments.seeds + seed + 1)
            entry = scores.result()
            results.add(entry, _walks_line(entry))
    return 0


def _run_recorded(arguments: argparse.Namespace) -> int:
    tell_if_large(arguments.frames)
    recordings = read_insoles(arguments.frames)
    about = {"frames_file": arguments.frames.name, "length_m": arguments.length_m, "width_m": arguments.width_m}
    results = report.Results(arguments.json, about, reads=[arguments.frames])
    print(_RECORDED_TITLE, flush=True)
    for recording in recordings:
        found = find_steps(recording, arguments.length_m, arguments.width_m)
        entry = _recorded(recording, found)
        results.add(entry, _recorded_lines(entry))
    feet = [foot for entry in results.entries for foot in entry["feet"].values()]
    if not any(foot["steps"] or foot["curve_steps"] for foot in feet):
        frames: list[Any] = [one.frames for one in recordings]
        least, most = min(float(one.min()) for one in frames), max(float(one.max()) for one in frames)
        raise RecordingError(
            f"{arguments.frames}: nothing could be compared, since neither a step is found nor does the force curve "
            f"show one; frames hold {least:g} to {most:g}; needed are recordings of somebody who walks, with larger "
            "numbers where the foot presses more"
        )
    return 0


def _recorded(recording: InsoleRecording, found: FoundSteps) -> dict[str, Any]:
    longest_s = GaitConfig().longest_stride_s
    feet = {}
    for foot, force in enumerate(found.force):
        rises_s = force_curve.rises_s(recording.time_s, force)
        of_foot = found.gait.feet[foot]
        feet[FEET[foot]] = {
            **asdict(of_foot),
            "steps": of_foot.steps + found.begun[foot],
            "whole_steps": of_foot.steps,
            "curve_steps": len(rises_s),
            "curve_cadence_per_min": force_curve.cadence_per_min(rises_s, longest_s),
        }
    return {
        "recording": recording.name,
        "duration_s": float(recording.time_s[-1] - recording.time_s[0]),
        "frames": len(recording.time_s),
        "feet": feet,
        "cadence_per_min": found.gait.cadence_per_min,
        "double_support": found.gait.double_support,
        "asymmetry": {name: found.gait.asymmetry(name) for name in _COMPARED},
    }


def _recorded_lines(entry: dict[str, Any]) -> str:
    lines = []
    for name, foot in entry["feet"].items():
        progress_mm = None if foot["progress_m"] is None else 1e3 * foot["progress_m"]
        lines.append(
            f"{entry['recording']:14} {name:5} {foot['steps']:5} {foot['curve_steps']:5} "
            f"{report.number(foot['cadence_per_min'], 9, 1)} {report.number(foot['curve_cadence_per_min'], 6, 1)} "
            f"{report.number(foot['stance_s'], 8, 2)} {report.number(foot['swing_s'], 8, 2)} "
            f"{report.number(progress_mm, 7, 0)} {report.number(foot['peak_force'], 9, 0)}"
        )
    if len(entry["feet"]) == len(FEET):
        compared = ", ".join(
            f"{name.rpartition('_')[0]} {report.number(value, 1, 2).strip()}"
            for name, value in entry["asymmetry"].items()
        )
        double = report.number(entry["double_support"], 1, 2).strip()
        lines.append(f"{'':14} both carry {double} of a stride; (left - right) / mean: {compared}")
    return "\n".join(lines)


def _walks_line(entry: dict[str, Any]) -> str:
    strike, toe_off = entry["strike_error_ms"], entry["toe_off_error_ms"]
    return (
        f"{entry['rate_hz']:7g} {entry['walks']:5} {entry['steps']:5} {entry['found']:5} {entry['wrong']:5} "
        f"{report.number(entry['cadence_error_per_min'], 8, 2)} "
        f"{report.number(strike['mean'], 9, 1)} {report.number(strike['sd'], 5, 1)} "
        f"{report.number(toe_off['mean'], 7, 1)} {report.number(toe_off['sd'], 5, 1)} "
        f"{report.number(entry['within_1_sigma'], 8, 2)} {report.number(entry['centre_error_mm'], 7, 1)} "
        f"{report.number(entry['double_support_error'], 7, 3)} {entry['steps_of_standing']:8}"
    )
