# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts library`: write a library of known objects, from labelled recordings or from simulated presses."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import RecordingError
from acts_core.files import FramesFile, load_frames, without_contact
from acts_core.words import counted
from acts_recon.objects import ImageClassifierConfig, build_object_library, save_object_library
from acts_sim.pressing import OBJECTS, PressingArm, object_named
from acts_tools.arguments import at_least_one, random_seed, refuse_unused, whole
from acts_tools.large_files import tell_if_large
from acts_tools.output_file import require_writable
from acts_tools.training.frames import digest_of, each_once

_EPILOG = """\
examples:
  acts library -o objects.npz                           of 30 simulated objects
  acts library --objects circle spoon -o objects.npz    of two of them
  acts library --files cup.npz pen_1.npz pen_2.npz -o objects.npz

docs/reconstruction.md says how to use it.
"""


def add_parser(subparsers: Any) -> None:
    """Add ``acts library`` to the acts command."""
    parser = subparsers.add_parser(
        "library",
        help="write a library of known objects for the classification",
        description="Write the file by which the node reconstruction classifies objects (its parameter "
        "object_library). It uses the strongest frame of every recording with a touch; without --frames and "
        "--files it presses simulated objects.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="library file to write")
    source = parser.add_mutually_exclusive_group()
    source.add_argument(
        "--frames", type=Path, metavar="NPZ", help="`frames`, `start`, `length` and a `label` for each recording"
    )
    source.add_argument(
        "--files",
        type=Path,
        nargs="+",
        metavar="NPZ",
        help="files of one object each, such as acts export writes, named after it: cup.npz, or cup_1.npz, cup_2.npz",
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
    paths = each_once(arguments.files or ([] if arguments.frames is None else [arguments.frames]))
    require_writable(arguments.output, takes_stream=False, reads=paths)
    if paths:
        refuse_unused(arguments, f"with --{'files' if arguments.files else 'frames'}", "presses", "seed")
        frames, labels, source = _recorded(paths, arguments)
    else:
        # An object that is named twice is one object.
        objects = [object_named(name) for name in dict.fromkeys(arguments.objects or OBJECTS)]
        frames, labels = PressingArm(objects, seed=arguments.seed).held_frames(arguments.presses)
        presses = counted(arguments.presses, "press", "presses")
        source = f"{presses} of {counted(len(objects), 'object')} into the ACTS contact model"
    library = build_object_library(
        frames, labels, touch_counts=arguments.touch_counts, provenance=f"Made by acts library from {source}."
    )
    save_object_library(library, arguments.output)
    size = f"{counted(library.n_classes, 'object')}, {counted(library.n_columns, 'frame')}"
    print(f"{arguments.output}: {size}, sha256 {library.sha256}")
    return 0


def _recorded(paths: Sequence[Path], arguments: argparse.Namespace) -> tuple[NDArray[np.uint16], list[str], str]:
    """The strongest frame of each recording that is wanted and has a touch, its label, and where they are from."""
    files = [_labelled(path, is_named=arguments.files is not None) for path in paths]
    named = ", ".join(map(str, paths))
    labels = [label for file in files for label in file.label]
    unknown = sorted(set(arguments.objects or ()) - set(labels))
    if unknown:
        raise RecordingError(
            f"{named}: no recording shows {', '.join(unknown)}; labels are {', '.join(sorted(set(labels)))}"
        )
    sizes = {path: file.frames.shape[1:] for path, file in zip(paths, files, strict=True)}
    if len(set(sizes.values())) > 1:
        told = ", ".join(f"{path} {rows} x {cols}" for path, (rows, cols) in sizes.items())
        raise RecordingError(f"the recordings are of arrays of several sizes ({told}): a library is for one")
    peaks = np.concatenate([file.peak_frames() * file.live for file in files])
    chosen = [n for n, label in enumerate(labels) if not arguments.objects or label in arguments.objects]
    touched = [n for n in chosen if peaks[n].max() > arguments.touch_counts]
    if not touched:
        largest = max((int(peaks[n].max()) for n in chosen), default=0)
        words = without_contact(largest, arguments.touch_counts)
        raise RecordingError(f"{named}: {words}, or a lower --touch-counts")
    if len(touched) < len(chosen):
        lacking = sorted({labels[n] for n in chosen} - {labels[n] for n in touched})
        told = f"; the library lacks {', '.join(lacking)}, of which no recording has one" if lacking else ""
        print(f"left out: {counted(len(chosen) - len(touched), 'recording')} without a touch{told}")
    digests = ", ".join(f"{path.name} (sha256 {digest_of(path)})" for path in paths)
    source = f"{counted(len(touched), 'recording')} of {digests}"
    return peaks[touched], [labels[n] for n in touched], source


def _labelled(path: Path, *, is_named: bool) -> FramesFile:
    """The frames of a file with their labels, or, where it is named after an object, with that name for all."""
    tell_if_large(path)
    recorded = load_frames(path, labels=not is_named)
    if is_named:
        name = re.sub(r"_\d+$", "", path.stem)
        if not name:
            raise RecordingError(f"{path}: its name has no object before the number; allowed are cup.npz, cup_1.npz")
        return replace(recorded, label=(name,) * recorded.start.size)
    if not recorded.label:
        raise RecordingError(
            f"{path}: has no label; needed is what each recording shows. A file of one object that is named after it "
            "is for --files"
        )
    return recorded
