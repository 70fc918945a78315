# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The true state of the hand's world, for evaluation only: no controller of the hand may read it.

`hand_world` writes it as rows of numbers into a ring in shared memory, 500 times a second. This module defines the
columns of a row, and reads rows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_sim.shared import TimedRingReader

JOINTS = 16

# Quantities of a row: name, and how many numbers.
_HEAD = (
    ("time_s", 1),
    ("object_position_m", 3),
    ("object_velocity_m_s", 3),
    ("object_turn_rad_s", 3),
    ("object_quaternion", 4),
    ("object_held", 1),
    ("object_lost", 1),
    ("load_n", 3),
    ("gravity_m_s2", 3),
    ("tip_depth_m", 1),
    ("tip_patch", 1),
    ("q_rad", JOINTS),
)
PATCHES_FROM = sum(width for _, width in _HEAD)
"""First column of the patches, which have `PATCH_COLUMNS` each."""

PATCH_COLUMNS = ("force_n", "sliding_share", "sliding_m_s", "tip_force_n")

COLUMN = {
    name: slice(start, start + width)
    for (name, width), start in zip(_HEAD, np.cumsum([0, *(width for _, width in _HEAD)]).tolist(), strict=False)
}
"""Columns of each quantity, by its name."""


def row_width(patches: int) -> int:
    """Number of columns of a row."""
    return PATCHES_FROM + len(PATCH_COLUMNS) * patches


@dataclass(frozen=True)
class PatchTruth:
    """True contact of one patch.

    Attributes
    ----------
    force_n : float
        Normal force, the sum over its taxels [N].
    sliding_share : float
        Share of that force at sliding points; between 0 and 1 while only the rim slides.
    sliding_m_s : float
        Mean speed of sliding, weighted by force [m/s].
    tip_force_n : float
        Part of `force_n` that the tip exerts [N].
    """

    force_n: float = 0.0
    sliding_share: float = 0.0
    sliding_m_s: float = 0.0
    tip_force_n: float = 0.0


@dataclass(frozen=True)
class HandTruth:
    """True state of the world at one time; vectors are in the palm's frame.

    Attributes
    ----------
    time_s : float
        Time since the start [s].
    object_position_m, object_velocity_m_s, object_turn_rad_s : tuple of float
        Of the object's centre [m, m/s, rad/s]; 0 without an object.
    object_quaternion : tuple of float
        Its orientation: w, x, y, z.
    object_held : bool
        Whether the holder holds it.
    object_lost : bool
        Whether it has fallen out of the hand.
    load_n : tuple of float
        Force on it besides gravity [N].
    gravity_m_s2 : tuple of float
        Gravity minus the acceleration of a shaken hand [m/s^2].
    tip_depth_m : float
        Depth of the tip below the untouched surface of the patch [m]; negative above it, NaN without a tip.
    tip_patch : str
        Patch that the tip is pushed into; empty without a tip.
    q_rad : tuple of float
        Angles of the joints in the order of the motors.
    patches : dict of PatchTruth
        By the patch's name.
    """

    time_s: float
    object_position_m: tuple[float, ...]
    object_velocity_m_s: tuple[float, ...]
    object_turn_rad_s: tuple[float, ...]
    object_quaternion: tuple[float, ...]
    object_held: bool
    object_lost: bool
    load_n: tuple[float, ...]
    gravity_m_s2: tuple[float, ...]
    tip_depth_m: float
    tip_patch: str
    q_rad: tuple[float, ...]
    patches: dict[str, PatchTruth]

    @classmethod
    def from_row(cls, row: NDArray[np.float64], patches: Sequence[str]) -> HandTruth:
        """Make the truth from a row.

        Parameters
        ----------
        row : np.ndarray [shape=(row_width(len(patches)),), dtype=float64]
        patches : sequence of str
            Names of the layout's patches, in order.
        """
        of = {name: tuple(row[where].tolist()) for name, where in COLUMN.items()}
        rest = row[PATCHES_FROM:].reshape(len(patches), len(PATCH_COLUMNS)).tolist()
        touched = int(of["tip_patch"][0])
        return cls(
            time_s=of["time_s"][0],
            object_position_m=of["object_position_m"],
            object_velocity_m_s=of["object_velocity_m_s"],
            object_turn_rad_s=of["object_turn_rad_s"],
            object_quaternion=of["object_quaternion"],
            object_held=bool(of["object_held"][0]),
            object_lost=bool(of["object_lost"][0]),
            load_n=of["load_n"],
            gravity_m_s2=of["gravity_m_s2"],
            tip_depth_m=of["tip_depth_m"][0],
            tip_patch=patches[touched] if touched >= 0 else "",
            q_rad=of["q_rad"],
            patches={name: PatchTruth(*numbers) for name, numbers in zip(patches, rest, strict=True)},
        )

    def as_dict(self) -> dict[str, Any]:
        """As a dictionary for JSON; NaN becomes None."""
        values = asdict(self)
        if math.isnan(self.tip_depth_m):
            values["tip_depth_m"] = None
        return values


class TruthFollower:
    """Reads rows from the ring that `hand_world` writes.

    Parameters
    ----------
    path : Path
        The ring.
    patches : int
        Number of patches of the layout.

    Raises
    ------
    ActsError
        When there is no such ring.
    """

    def __init__(self, path: Path, patches: int = 13) -> None:
        self._ring = TimedRingReader(path, row_width(patches))
        self._newest_ns = 0

    def new(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Rows that were written since the last call, oldest first; at most those in the ring.

        Returns
        -------
        times_ns : np.ndarray [shape=(n,), dtype=int64]
            Time of each row, CLOCK_MONOTONIC [ns].
        rows : np.ndarray [shape=(n, width), dtype=float64]
            Columns as in `COLUMN` and from `PATCHES_FROM` on; `HandTruth.from_row` converts one row.
        """
        times_ns, rows = self._ring.since(self._newest_ns)
        if len(times_ns):
            self._newest_ns = int(times_ns[-1])
        return times_ns, rows
