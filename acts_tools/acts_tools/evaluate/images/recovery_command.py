# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate recovery`: score sampling schemes and recovery methods on recordings."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from acts_core.errors import RecordingError
from acts_core.files import load_frames, without_contact
from acts_recon.sparse import Dictionary
from acts_sim.pressing import OBJECTS
from acts_tools.arguments import at_least_one, refuse_unused
from acts_tools.evaluate.images import options
from acts_tools.evaluate.images.recovery import Recording
from acts_tools.evaluate.images.tasks import evaluate_all, require_scored
from acts_tools.large_files import tell_if_large
from acts_tools.training.frames import model_frames


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate recovery``."""
    parser = commands.add_parser(
        "recovery",
        help="score recovery on recordings, or on presses of the contact model",
        description="Sample full frames with each scheme and M as the board does, recover the image by each method, "
        "and compare it with the full frame. docs/recovery.md explains the numbers.",
    )
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "--frames",
        type=Path,
        metavar="NPZ",
        help="`frames` (n, rows, cols) of 0 to 1023 counts with `rate_hz`; optionally `live`, `start`, `length`",
    )
    source.add_argument(
        "--presses", type=at_least_one, metavar="N", help="N static presses of the contact model's objects"
    )
    options.add_arguments(parser)
    parser.add_argument(
        "--peaks", action="store_true", help="of each recording only one sampled frame, at its largest sum of counts"
    )
    parser.add_argument(
        "--every", type=at_least_one, default=1, metavar="N", help="only every Nth recording (default: 1)"
    )
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    if arguments.presses:
        refuse_unused(arguments, "with --presses, which are single frames", "peaks")
        tasks = options.tasks(arguments)
        recordings = _pressed(arguments)
    else:
        recordings = _recorded(arguments)
        tasks = options.tasks(arguments, recordings[0].frames.shape[1:])
    if arguments.frames:
        _tell_without_contact(arguments.frames, recordings, tasks[0].touch_counts)
    dictionary = options.dictionary(arguments)
    if arguments.presses and options.uses_dictionary([task.method for task in tasks]):
        _tell_if_learnt_from(dictionary, arguments.seed)
    source = arguments.frames.name if arguments.frames else f"{arguments.presses} presses"
    results = options.results(arguments, frames_file=source, peaks=arguments.peaks, every=arguments.every)
    evaluate_all(recordings, tasks, dictionary, results)
    require_scored(results.entries, source, tasks[0].touch_counts)
    return 0


def _pressed(arguments: argparse.Namespace) -> Sequence[Recording]:
    frames = model_frames(list(OBJECTS.values()), arguments.presses, seed=arguments.seed)
    live = np.ones(frames.shape[1:], dtype=bool)
    return [Recording(frame[None], 1.0, live) for frame in frames][:: arguments.every]


def _tell_if_learnt_from(dictionary: Dictionary, seed: int) -> None:
    """Warn if the presses are those that `acts train` has learnt the dictionary from, which flatters it."""
    learnt = dictionary.settings
    if "presses" in learnt and learnt.get("seed") == seed:
        print(
            f"warning: --seed {seed}: the dictionary is learnt from presses of this seed, so the method paper is "
            "better on them than on others; give another seed",
            file=sys.stderr,
        )


def _recorded(arguments: argparse.Namespace) -> Sequence[Recording]:
    tell_if_large(arguments.frames)
    recorded = load_frames(arguments.frames)
    if recorded.rate_hz is None:
        raise RecordingError(
            f"{arguments.frames}: has no rate_hz; needed is how many frames were recorded per second: add it to the "
            "file, or export the bag again with --rate 100"
        )
    rate_hz = recorded.rate_hz
    if arguments.peaks:
        return [Recording(frame[None], rate_hz, recorded.live) for frame in recorded.peak_frames()][:: arguments.every]
    parts = list(zip(recorded.start, recorded.length, strict=True))[:: arguments.every]
    return [Recording(recorded.frames[start : start + n], rate_hz, recorded.live) for start, n in parts]


def _tell_without_contact(path: Path, recordings: Sequence[Recording], touch_counts: int) -> None:
    """Warn if no taxel is ever pressed: only invented contacts are then scored, which is rarely intended."""
    largest = max(int(recording.frames.max(axis=0)[recording.live].max(initial=0)) for recording in recordings)
    if largest <= touch_counts:
        print(f"warning: {path}: {without_contact(largest, touch_counts)}, or a lower --touch-counts", file=sys.stderr)
