# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Simulated scenes as recordings for the virtual board: the same touch through board, wire, driver and nodes."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import write_array, write_whole
from acts_tools.evaluate import report
from acts_tools.output_file import make_folder, require_apart
from acts_tools.progress import tell

_SHORTEST_S = 1.0
_SUFFIX = ".npy"


def add_recordings_argument(parser: argparse.ArgumentParser, which: str) -> None:
    """Add ``--recordings`` to a command that shows scenes.

    Parameters
    ----------
    parser : argparse.ArgumentParser
    which : str
        The scenes that are written, for the help text.
    """
    parser.add_argument(
        "--recordings",
        type=Path,
        metavar="FOLDER",
        help=f"write {which} here, for a virtual board to play (docs/simulation.md)",
    )


def scene_results(arguments: argparse.Namespace, about: dict[str, Any]) -> report.Results:
    """The report of a command with ``--recordings``, which begins with `about`.

    Raises
    ------
    RecordingError
        When its file cannot be written, or has the name of a recording, or there can be no folder of these.
    """
    require_apart(arguments.json, arguments.recordings, _SUFFIX)
    results = report.Results(arguments.json, about)
    if arguments.recordings is not None:
        make_folder(arguments.recordings, "--recordings")
    return results


def write_recording(folder: Path, name: str, frames: NDArray[np.uint16], rate_hz: float) -> None:
    """Write the frames of a scene as ``FOLDER/NAME.npy``, and say how fast it is played.

    A board repeats it. A scene that ends as it begins is made a second long, for a pause between one and the next.

    Parameters
    ----------
    folder : Path
        Made where it does not exist.
    name : str
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
    rate_hz : float
        Frames per second.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    path = folder / f"{name}{_SUFFIX}"
    missing = round(_SHORTEST_S * rate_hz) - len(frames)
    if missing > 0 and np.array_equal(frames[-1], frames[0]):
        frames = np.concatenate((frames, np.repeat(frames[:1], missing, axis=0)))
    with write_whole(path, error=RecordingError, makes_folder=True) as file:
        write_array(file, frames)
    tell(f"{path}: {len(frames) / rate_hz:.2f} s, recording_rate_hz:={rate_hz:g}")
