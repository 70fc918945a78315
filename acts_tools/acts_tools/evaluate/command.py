"""`acts evaluate recovery`: score sampling schemes and recovery methods on recordings."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_core.frames_file import FramesFile, load_frames
from acts_core.sampling import SCHEMES, SamplingConfig
from acts_recon.shipped import shipped_dictionary_path
from acts_tools.evaluate.methods import METHODS
from acts_tools.evaluate.recovery import SAMPLE_US, Task, evaluate
from acts_tools.recovery_score import dictionary_named

TRACKED_COUNTS = 15
"""A taxel above it is followed by tracking: every taxel that can be told from noise, whatever counts as pressed."""


def add_parser(subparsers: Any) -> None:
    """Add ``acts evaluate`` to the acts command."""
    parser = subparsers.add_parser("evaluate", help="score the recovery of images on recordings")
    commands = parser.add_subparsers(title="what to evaluate", metavar="WHAT", required=True)
    recovery = commands.add_parser(
        "recovery",
        help="recovered images against full frames",
        description="Sample recordings taxel by taxel as the board would, recover every frame, compare with the truth. "
        "docs/recovery.md tells what the numbers mean.",
    )
    recovery.add_argument(
        "--frames",
        type=Path,
        required=True,
        metavar="NPZ",
        help="`frames` (n, rows, cols) of 0 to 1023 counts with `rate_hz`; optionally `live`, `start`, `length`",
    )
    recovery.add_argument("--rate-hz", type=float, default=1000.0, help="frames sampled per second (%(default)g)")
    recovery.add_argument("--scheme", nargs="+", default=["tracking"], choices=tuple(SCHEMES), help="default: tracking")
    recovery.add_argument("--m", nargs="+", type=int, default=[55], help="taxels per frame (default: 55)")
    recovery.add_argument("--method", nargs="+", default=["acts"], choices=tuple(METHODS), help="default: acts")
    recovery.add_argument("--dictionary", metavar="FILE", help="of the methods that use one (default: the shipped)")
    recovery.add_argument("--touch-counts", type=int, default=50, help="a taxel above is pressed (%(default)s)")
    recovery.add_argument(
        "--search-counts",
        type=int,
        help=f"counts above which the sampling follows a taxel (default: {TRACKED_COUNTS}, just above the noise, for "
        "tracking; as --touch-counts for the others)",
    )
    recovery.add_argument("--sample-us", type=float, default=SAMPLE_US, help="time of a measurement (%(default)s)")
    recovery.add_argument("--seed", type=int, default=1, help="of random sampling (%(default)s)")
    recovery.add_argument(
        "--recordings", type=int, metavar="N", help="only every so-manieth recording, for a quick look"
    )
    recovery.add_argument("--json", type=Path, metavar="OUT", help="write the results here, too")
    recovery.set_defaults(evaluate=_recovery)


def run(arguments: argparse.Namespace) -> int:
    """Run what was asked for; returns the exit code."""
    return int(arguments.evaluate(arguments))


def _recovery(arguments: argparse.Namespace) -> int:
    recorded = load_frames(arguments.frames)
    if recorded.rate_hz is None:
        raise RecordingError(f"{arguments.frames}: has no rate_hz; needed is how many frames were recorded per second")
    dictionary = dictionary_named(arguments.dictionary or str(shipped_dictionary_path()))
    tasks = _tasks(arguments, recorded)
    if arguments.recordings:
        recorded = FramesFile(
            recorded.frames,
            recorded.live,
            recorded.start[:: arguments.recordings],
            recorded.length[:: arguments.recordings],
            recorded.rate_hz,
        )
    results = []
    print(_HEADER)
    for task in tasks:
        results.append(evaluate(recorded, task, dictionary))
        print(_line(results[-1]), flush=True)
    if arguments.json:
        report = {"frames_file": arguments.frames.name, "touch_counts": arguments.touch_counts, "results": results}
        arguments.json.write_text(json.dumps(report, indent=2) + "\n")
    return 0


def _tasks(arguments: argparse.Namespace, recorded: FramesFile) -> Sequence[Task]:
    rows, cols = recorded.frames.shape[1:]

    def threshold(scheme: str) -> int:
        if arguments.search_counts is not None:
            return int(arguments.search_counts)
        return TRACKED_COUNTS if scheme == "tracking" else int(arguments.touch_counts)

    return [
        Task(
            SamplingConfig(
                scheme=scheme, rows=rows, cols=cols, m=m, threshold_counts=threshold(scheme), seed=arguments.seed
            ),
            method,
            rate_hz=arguments.rate_hz,
            touch_counts=arguments.touch_counts,
            sample_us=arguments.sample_us,
        )
        for scheme in arguments.scheme
        for m in arguments.m
        for method in arguments.method
    ]


_HEADER = (
    f"{'scheme':9} {'M':>4} {'method':8} {'frames':>8} {'rel.err':>8} {'support':>8} {'CoP mean':>9} {'p95':>7} "
    f"{'missed':>7} {'invented':>9} {'notice p50':>10} {'p99 ms':>7} {'us':>6} {'onset err':>9}"
)


def _line(result: dict[str, Any]) -> str:
    def number(value: float | None, width: int, digits: int) -> str:
        return f"{'-':>{width}}" if value is None else f"{value:{width}.{digits}f}"

    cop, notice = result["cop_error_taxels"], result["notice_ms"]
    return (
        f"{result['scheme']:9} {result['m']:4} {result['method']:8} {result['frames']:8} "
        f"{number(result['relative_error'], 8, 4)} {number(result['support_accuracy'], 8, 4)} "
        f"{number(cop['mean'], 9, 4)} {number(cop['p95'], 7, 3)} {number(result['missed'], 7, 4)} "
        f"{number(result['invented_rate'], 9, 5)} {number(notice['p50'], 10, 1)} {number(notice['p99'], 7, 1)} "
        f"{result['frame_us']['median']:6.1f} {number(result['onset']['relative_error'], 9, 4)}"
    )
