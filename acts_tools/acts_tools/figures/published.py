# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The published curves, from a folder that the user has; none of them is part of this project."""

from __future__ import annotations

import csv
import os
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import path_of, read_npz
from acts_tools.figures.sheet import PUBLISHED, Curve

VARIABLE = "ACTS_PAPER_DATA"
"""Environment variable that names the folder."""

_CURVES, _INDEX = "curves.csv", "curves_index.csv"


class PublishedData:
    """The paper's curves as numbers (docs/paper.md says how the folder is made).

    Parameters
    ----------
    folder : Path
        Contains `curves_index.csv` (curve_id, figure, axes, label) and `curves.csv` (curve_id, x, y).

    Raises
    ------
    RecordingError
        When they cannot be read.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._numbers: dict[tuple[str, int, str], int] = {}
        self._points: dict[int, list[tuple[float, float]]] = defaultdict(list)
        _read(folder / _INDEX, self._add_curve)
        _read(folder / _CURVES, self._add_point)

    def _add_curve(self, row: dict[str, str]) -> None:
        self._numbers.setdefault((row["figure"], int(row["axes"]), row["label"]), int(row["curve_id"]))

    def _add_point(self, row: dict[str, str]) -> None:
        self._points[int(row["curve_id"])].append((float(row["x"]), float(row["y"])))

    def files(self) -> list[Path]:
        """What of the folder is published data."""
        return [path for path in self.folder.iterdir() if path.suffix in (".csv", ".npz")]

    def points(self, figure: str, label: str, axes: int = 0) -> NDArray[np.float64]:
        """Points of a curve by its file, label and axes; np.ndarray [shape=(n, 2), dtype=float64].

        Raises
        ------
        RecordingError
            When there is none, or it has no points.
        """
        number = self._numbers.get((figure, axes, label))
        if number is None:
            known = sorted(label for file, at, label in self._numbers if (file, at) == (figure, axes))
            raise RecordingError(f"{self.folder / _INDEX}: no curve {label!r} of {figure}, axes {axes}; it has {known}")
        if number not in self._points:
            raise RecordingError(
                f"{self.folder / _CURVES}: no points of curve {number}, {label!r} of {figure}; is its end missing?"
            )
        return np.array(self._points[number], dtype=np.float64)

    def curve(
        self,
        figure: str,
        label: str,
        *,
        named: str,
        beside: str = "",
        scheme: str = "",
        scale: float = 1.0,
    ) -> Curve:
        """A curve to be drawn as `named`, its values multiplied by a scale."""
        points = self.points(figure, label)
        return Curve(
            named,
            points[:, 0].tolist(),
            (points[:, 1] * scale).tolist(),
            PUBLISHED,
            scheme,
            beside=beside,
        )

    def array(self, file: str, name: str) -> NDArray:
        """An array of one of the folder's npz files.

        Raises
        ------
        RecordingError
            When it cannot be read.
        """
        found = read_npz(self.folder / file, (name,), error=RecordingError).get(name)
        if found is None:
            raise RecordingError(f"{self.folder / file}: no array {name!r}")
        return found


def published_data(folder: Path | None) -> PublishedData | None:
    """The data of a folder, or of that named by the environment; None where neither is given.

    Raises
    ------
    RecordingError
        When the folder has none.
    """
    if folder is None:
        named = os.environ.get(VARIABLE)
        if not named:
            return None
        folder = path_of(named, error=RecordingError)
    return PublishedData(folder)


def _read(path: Path, add: Callable[[dict[str, str]], None]) -> None:
    """Give each row of a table to `add`; errors name the file and the line."""
    try:
        with path.open(newline="") as file:
            rows = csv.DictReader(file)
            try:
                for row in rows:
                    add(row)
            # What a line that was cut off lacks is None.
            except (KeyError, TypeError, ValueError, csv.Error) as error:
                raise RecordingError(
                    f"{path}: line {rows.line_num} is damaged or lacks a column; docs/paper.md says which columns are "
                    "needed"
                ) from error
    except OSError as error:
        raise RecordingError(
            f"{path}: no published curves ({error.strerror}); needed are {_INDEX} and {_CURVES}, see docs/paper.md"
        ) from error
