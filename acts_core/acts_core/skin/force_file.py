# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Measured force responses in files: pairs of newtons and counts, checked."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import SettingsError
from acts_core.files import read_npz, read_text

_NAMES = ("newtons", "counts")


def read_force_points(path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read a force response: a csv file with the columns `newtons` and `counts`, or an npz file with such arrays.

    Parameters
    ----------
    path : Path
        Ends in ``.csv`` or ``.npz``. Other columns or arrays, and lines of a csv that begin with ``#``, are left alone.

    Returns
    -------
    newtons, counts : np.ndarray [shape=(n,), dtype=float64]
        Force on one taxel [N], growing from point to point; its reading, 0 to `COUNT_MAX`, growing but for zeros at the
        beginning. At least two points.

    Raises
    ------
    SettingsError
        When the file cannot be read, or its points are no response.
    """
    try:
        if path.suffix == ".csv":
            newtons, counts = _from_csv(path)
        elif path.suffix == ".npz":
            content = read_npz(path, _NAMES, error=SettingsError, hint="give a file of newtons and counts")
            missing = [name for name in _NAMES if name not in content]
            if missing:
                raise SettingsError(f"{path}: no array {missing[0]!r}; needed are `newtons` and `counts`")
            newtons, counts = (_numbers(path, name, content[name]) for name in _NAMES)
        else:
            raise SettingsError(f"{path}: a force response is a .csv or .npz file of newtons and counts")
    except (ValueError, TypeError, csv.Error) as error:
        raise SettingsError(f"{path}: damaged, or not what its name says ({error})") from error
    _check(path, newtons, counts)
    return newtons, counts


def _numbers(path: Path, name: str, given: NDArray[Any]) -> NDArray[np.float64]:
    if given.dtype.kind not in "iuf":
        raise SettingsError(f"{path}: {name} of {given.dtype}: needed are numbers")
    with np.errstate(over="ignore"):  # what is too large for float64 is told as not finite
        return given.astype(np.float64)


def _from_csv(path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    # Spreadsheets begin what they save as UTF-8 with a mark of it.
    content = read_text(path, error=SettingsError, hint="give an existing file").removeprefix("\ufeff")
    lines = content.splitlines(keepends=True)
    rows = list(csv.DictReader((line for line in lines if not line.startswith("#")), skipinitialspace=True))
    values: list[list[float]] = [[], []]
    for number, row in enumerate(rows, start=1):
        for name, column in zip(_NAMES, values, strict=True):
            text = row.get(name)
            try:
                column.append(float(text or ""))
            except ValueError:
                raise SettingsError(
                    f"{path}: point {number}, {name}: {text!r}; needed is a first line `newtons,counts` and two "
                    "numbers in each line after it"
                ) from None
    return np.array(values[0]), np.array(values[1])


def _check(path: Path, newtons: NDArray[np.float64], counts: NDArray[np.float64]) -> None:
    if newtons.ndim != 1 or newtons.shape != counts.shape or newtons.size < 2:
        raise SettingsError(f"{path}: newtons {newtons.shape}, counts {counts.shape}: needed are as many, two or more")
    if not (np.isfinite(newtons).all() and np.isfinite(counts).all()):
        raise SettingsError(f"{path}: a point is not finite")
    # The first point is compared with what lies just below 0.
    not_above = np.diff(newtons, prepend=-np.finfo(np.float64).tiny) <= 0
    if not_above.any():
        at = int(np.argmax(not_above))
        raise SettingsError(
            f"{path}: point {at + 1}, {newtons[at]:g} N: newtons must begin at 0 or above and grow from point to point"
        )
    if counts[0] < 0 or counts[-1] > COUNT_MAX:
        raise SettingsError(f"{path}: counts {counts[0]:g} to {counts[-1]:g}: allowed are 0 to {COUNT_MAX}")
    flat = (np.diff(counts) <= 0) & ~((counts[1:] == 0) & (counts[:-1] == 0))
    if flat.any():
        at = int(np.argmax(flat)) + 1
        raise SettingsError(
            f"{path}: point {at + 1}: counts fall or stay at {counts[at]:g} ({newtons[at]:g} N): they must grow from "
            "point to point, but for zeros at the beginning"
        )
    if counts[-1] == 0:
        raise SettingsError(f"{path}: all counts are 0")
