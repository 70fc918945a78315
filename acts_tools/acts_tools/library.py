# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts library`: write a library of known objects, from labelled recordings or from simulated presses."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from acts_core.array import COUNT_MAX
from acts_core.errors import RecordingError
from acts_core.files import load_frames, without_contact
from acts_core.words import counted
from acts_recon.objects import ImageClassifierConfig, build_object_library, save_object_library
from acts_sim.pressing import OBJECTS, PressingArm, object_named
from acts_tools.arguments import at_least_one, random_seed, refuse_unused, whole
from acts_tools.large_files import tell_if_large
from acts_tools.output_file import require_writable
from acts_tools.training.frames import digest_of


def add_parser(subparsers: Any) -> None:
    """Add ``acts library`` to the acts command."""
    parser = subparsers.add_parser(
        "library",
        help="write a library of known objects for the classification",
        description="Write the file by which the node reconstruction classifies objects (its parameter "
        "object_library). It uses the strongest frame of every labelled recording of an npz file with a touch; "
        "without --frames it presses simulated objects.",
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="library file to write")
    parser.add_argument(
        "--frames", type=Path, metavar="NPZ", help="`frames`, `start`, `length` and a `label` for each recording"
    )
    parser.add_argument(
        "--objects", nargs="+", action="extend", metavar="NAME", help="only these objects or labels (default: all)"
    )
    parser.add_argument(
        "--presses", type=at_least_one, default=5, metavar="N", help="per simulated object (default: %(default)s)"
    )
    parser.add_argument(
        "--seed", type=random_seed, default=0, metavar="X", help="seed of the presses (default: %(default)s)"
    )
    parser.add_argument(
        "--touch-counts",
        type=whole(0, COUNT_MAX - 1),
        default=ImageClassifierConfig().touch_counts,
        metavar="X",
        help="lower or equal counts are set to 0 (default: %(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write a library and return the exit code.

    Raises
    ------
    ActsError
        When the frames cannot be read, have no labels, or the file cannot be written.
    """
    require_writable(arguments.output, reads=[] if arguments.frames is None else [arguments.frames])
    if arguments.frames is not None:
        refuse_unused(arguments, "with --frames", "presses", "seed")
    if arguments.frames is None:
        # An object that is named twice is one object.
        objects = [object_named(name) for name in dict.fromkeys(arguments.objects or OBJECTS)]
        frames, labels = PressingArm(objects, seed=arguments.seed).held_frames(arguments.presses)
        presses = counted(arguments.presses, "press", "presses")
        source = f"{presses} of {counted(len(objects), 'object')} into the ACTS contact model"
    else:
        tell_if_large(arguments.frames)
        recorded = load_frames(arguments.frames, labels=True)
        if not recorded.label:
            raise RecordingError(f"{arguments.frames}: has no label; needed is what each recording shows")
        unknown = sorted(set(arguments.objects or ()) - set(recorded.label))
        if unknown:
            raise RecordingError(
                f"{arguments.frames}: no recording shows {', '.join(unknown)}; labels are "
                f"{', '.join(sorted(set(recorded.label)))}"
            )
        chosen = [n for n, label in enumerate(recorded.label) if not arguments.objects or label in arguments.objects]
        peaks = recorded.peak_frames() * recorded.live
        touched = [n for n in chosen if peaks[n].max() > arguments.touch_counts]
        if not touched:
            largest = max((int(peaks[n].max()) for n in chosen), default=0)
            words = without_contact(largest, arguments.touch_counts)
            raise RecordingError(f"{arguments.frames}: {words}, or a lower --touch-counts")
        if len(touched) < len(chosen):
            print(f"left out: {counted(len(chosen) - len(touched), 'recording')} without a touch")
        frames = peaks[touched]
        labels = [recorded.label[n] for n in touched]
        recordings = counted(len(labels), "recording")
        source = f"{recordings} of {arguments.frames.name} (sha256 {digest_of(arguments.frames)})"
    library = build_object_library(
        frames, labels, touch_counts=arguments.touch_counts, provenance=f"Made by acts library from {source}."
    )
    save_object_library(library, arguments.output)
    size = f"{counted(library.n_classes, 'object')}, {counted(library.n_columns, 'frame')}"
    print(f"{arguments.output}: {size}, sha256 {library.sha256}")
    return 0
