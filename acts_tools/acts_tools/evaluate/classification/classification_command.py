# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate classification`: accuracy of the paper's SRC and of ours on the same presses."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError, SettingsError
from acts_core.files import load_frames
from acts_core.words import counted
from acts_sim.pressing import OBJECTS, PressingConfig, object_named
from acts_tools.arguments import add_settings, at_least_one, refuse_unused, taxels
from acts_tools.evaluate.classification.contenders import SCHEMES
from acts_tools.evaluate.classification.recorded import run_recorded
from acts_tools.evaluate.classification.tables import draw, table, times
from acts_tools.evaluate.classification.trials import M_OVER_TIME, MS, Trials, run_trials
from acts_tools.evaluate.images.options import require_frames
from acts_tools.evaluate.options import add_seed_and_json
from acts_tools.large_files import tell_if_large
from acts_tools.output_file import require_picture, require_writable, write_json
from acts_tools.progress import Progress

_OF_PRESSES = ("arms", "presses", "columns", "objects", "miss_taxels", "miss_deg", "seed")
"""Options of simulated presses."""


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate classification``."""
    parser = commands.add_parser(
        "classification",
        help="score the classification of objects, over M and over time since contact",
        description="Press 30 simulated objects repeatedly, or read labelled recordings (--frames), and classify the "
        "object by the paper's method (adaptive sampling, SRC on each frame alone) and by ours (tracking, fused "
        "image), on the same frames and with the same library.",
    )
    parser.add_argument(
        "--frames",
        type=Path,
        metavar="NPZ",
        help="`frames`, `rate_hz`, `start`, `length` and a `label` for each recording; the first half of each label's "
        "recordings becomes the library, the rest is classified",
    )
    parser.add_argument(
        "--m",
        nargs="+",
        type=taxels,
        metavar="M",
        help=f"taxels per frame (default: {' '.join(map(str, MS))}; of --frames: 55)",
    )
    for name, text in (
        ("arms", "simulated arms, each with a skin, spots and a library of its own"),
        ("presses", "presses of every object on every arm"),
        ("columns", "presses of every object in the library of an arm"),
    ):
        parser.add_argument(
            f"--{name}", type=at_least_one, default=getattr(Trials(), name), help=f"{text} (default: %(default)s)"
        )
    parser.add_argument("--objects", nargs="+", default=list(OBJECTS), metavar="NAME", help="default: all 30")
    add_settings(parser, PressingConfig, "miss_taxels", "miss_deg")
    add_seed_and_json(parser)
    parser.add_argument("--picture", type=Path, metavar="PNG", help="draw both curves (not with --frames)")
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    require_writable(arguments.json, reads=[arguments.frames] if arguments.frames else [])
    require_picture(arguments.picture, report=arguments.json)
    # What is named twice is one: its presses would count twice.
    ms = list(dict.fromkeys(arguments.m or ([55] if arguments.frames else MS)))
    write = partial(write_json, arguments.json)
    if arguments.frames:
        if arguments.picture:
            raise SettingsError(f"--picture {arguments.picture}: shows simulated presses and does not go with --frames")
        refuse_unused(arguments, "on recordings", *_OF_PRESSES)
        tell_if_large(arguments.frames)
        recorded = load_frames(arguments.frames, labels=True)
        with Progress("recordings", 1) as progress:
            try:
                results = run_recorded(recorded, ms, progress.show, write)
            except RecordingError as error:
                raise RecordingError(f"{arguments.frames}: {error}") from None
        print(
            f"{counted(results['library'], 'recording')} in the library, {results['presses']} classified, "
            f"{counted(results['classes'], 'object')}"
        )
        print(table(results["over_m"], "m", "accuracy at M ="))
    else:
        names = dict.fromkeys(arguments.objects)
        if len(names) < 2:
            raise SettingsError(f"--objects {' '.join(names)}: of one object every answer is right; name two or more")
        trials = Trials(
            arms=arguments.arms,
            presses=arguments.presses,
            columns=arguments.columns,
            seed=arguments.seed,
            pressing=PressingConfig(miss_taxels=arguments.miss_taxels, miss_deg=arguments.miss_deg),
            objects=tuple(object_named(name) for name in names),
        )
        require_frames((scheme, m) for m in ms for scheme in SCHEMES)
        with Progress("presses", 1) as progress:
            results = run_trials(trials, ms, show=progress.show, write=write)
        print(table(results["over_m"], "m", "accuracy, held, at M ="))
        print()
        print(table(results["over_time"], "time_ms", f"accuracy at M = {M_OVER_TIME}, ms since contact"))
        print()
        print(times(results["frame_us"]))
        if arguments.picture:
            draw(arguments.picture, results, M_OVER_TIME)
    return 0
