# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate convert`: convert public recordings to the format of the other commands."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import write_whole
from acts_core.words import counted
from acts_tools.evaluate.public import insole, weiss
from acts_tools.output_file import require_writable

_SUFFIXES = (".csv", ".dsa")
_GRASPS = "python/classification/training_grasp_profiles_thesis"


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate convert``."""
    parser = commands.add_parser(
        "convert",
        help="convert public recordings to files that can be evaluated",
        description="Read the recordings of a public repository, and write them as `frames` with `rate_hz`, `live`, "
        "`start`, `length` and `label`. docs/recovery.md says where to get them.",
    )
    parser.add_argument("which", choices=tuple(_SETS), metavar="SET", help=f"recordings: {', '.join(_SETS)}")
    parser.add_argument("source", type=Path, metavar="FOLDER", help="clone of their repository")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="npz file to write")
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    reads = [path for suffix in _SUFFIXES for path in arguments.source.rglob(f"*{suffix}")]
    require_writable(arguments.output, takes_stream=False, reads=reads)
    recordings, live, rate_hz = _SETS[arguments.which](arguments.source)
    length = np.array([len(frames) for _, frames in recordings])
    # An open file: numpy would append .npz to any other name.
    with write_whole(arguments.output, error=RecordingError) as file:
        np.savez_compressed(
            file,
            frames=np.concatenate([frames for _, frames in recordings]),
            rate_hz=rate_hz,
            live=live,
            start=np.cumsum(length) - length,
            length=length,
            label=np.array([label for label, _ in recordings]),
        )
    print(f"{arguments.output}: {counted(len(recordings), 'recording')}, {counted(length.sum(), 'frame')}")
    return 0


_Recordings = tuple[list[tuple[str, NDArray[np.uint16]]], NDArray[np.bool_], float]
"""Label and frames of each recording, mask of existing taxels, frames per second."""


def _grasps(source: Path) -> _Recordings:
    folder = source / _GRASPS
    found = [(name, path) for name in weiss.OBJECTS for path in sorted((folder / name).glob("*.dsa"))]
    missing = set(weiss.OBJECTS) - {name for name, _ in found}
    if missing:
        raise RecordingError(f"{folder}: no recordings of {', '.join(sorted(missing))}; is {source} the repository?")
    return [(name, weiss.read(path)) for name, path in found], weiss.live(), weiss.RATE_HZ


def _slips(source: Path) -> _Recordings:
    paths = _found(source, "pressure_profiles", weiss.SLIPS)
    return [(path.stem, weiss.read(path)) for path in paths], weiss.live(), weiss.RATE_HZ


def _insole(source: Path) -> _Recordings:
    paths = _found(source, "Experiment_Dataset", insole.RECORDINGS)
    pairs = [(path.stem, insole.read(path)) for path in paths]
    recordings = [(f"{name}_{foot}", both[foot]) for foot in (0, 1) for name, both in pairs]
    return recordings, np.ones((insole.ROWS, insole.COLS), dtype=bool), insole.RATE_HZ


def _found(source: Path, folder: str, names: Sequence[str]) -> list[Path]:
    """Paths of files in a folder of a repository; refused where one is not there."""
    missing = [name for name in names if not (source / folder / name).is_file()]
    if missing:
        raise RecordingError(f"{source / folder}: no recordings {', '.join(missing)}; is {source} the repository?")
    return [source / folder / name for name in names]


_SETS = {"grasps": _grasps, "slips": _slips, "insole": _insole}
