# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings of two insoles of 33 x 15 cells: github.com/JunjianChi/ISCAS_2025_Insole.

A file is CSV; the columns `Matrix_0` and `Matrix_1` contain the cells of the feet, row by row, separated by commas.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError

ROWS, COLS = 33, 15
RATE_HZ = 8.0

RECORDINGS = (
    "standing/plotting.csv",
    "standing/stand_1_cjj_1.csv",
    "standing/stand_1_cjj_3.csv",
    "standing/stand_2_cjj_1.csv",
    "standing/stand_2_cjj_2.csv",
    "walking_cjj_neiba.csv",
    "walking_wu_2.csv",
)
"""Files of `Experiment_Dataset` that the tables of docs/recovery.md use."""

_FEET = ("Matrix_0", "Matrix_1")


def read(path: Path) -> NDArray[np.uint16]:
    """Frames of one recording.

    Returns
    -------
    np.ndarray [shape=(2, n, 33, 15), dtype=uint16]
        Frames of one foot and of the other; counts of 10 bits.

    Raises
    ------
    RecordingError
        When the file cannot be read, or has other content.
    """
    feet: tuple[list[NDArray[np.int64]], ...] = ([], [])
    try:
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                for cells, name in zip(feet, _FEET, strict=True):
                    cells.append(np.array(row[name].split(","), dtype=np.int64))
        counts = np.array(feet)
    except (OSError, KeyError, ValueError, OverflowError, AttributeError, csv.Error) as error:
        raise RecordingError(f"{path}: cannot be read as a recording of the insoles ({error!r})") from error
    if counts.ndim != 3 or counts.shape[2] != ROWS * COLS or not 0 <= counts.min() <= counts.max() <= 4095:
        raise RecordingError(f"{path}: needed are frames of {ROWS} x {COLS} cells of 12 bits in {' and '.join(_FEET)}")
    return (counts // 4).astype(np.uint16).reshape(2, -1, ROWS, COLS)
