"""What is true in the hand's world, for those who judge; nothing that controls the hand may look at it.

`hand_world` writes it as rows of numbers into a ring in shared memory, 500 times a second. Here is what stands where
in a row, and who reads them.
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

# Of a row: name, how many numbers.
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
"""Where in a row the patches begin, `PATCH_COLUMNS` numbers each."""

PATCH_COLUMNS = ("force_n", "sliding_share", "sliding_m_s", "tip_force_n")

COLUMN = {
    name: slice(start, start + width)
    for (name, width), start in zip(_HEAD, np.cumsum([0, *(width for _, width in _HEAD)]).tolist(), strict=False)
}
"""Where in a row a quantity stands, by its name."""


def row_width(patches: int) -> int:
    """How many numbers a row has."""
    return PATCHES_FROM + len(PATCH_COLUMNS) * patches


@dataclass(frozen=True)
class PatchTruth:
    """What touches one patch.

    Attributes
    ----------
    force_n : float
        Normal force, the sum of its taxels' [N].
    sliding_share : float
        Share of that force at points that slide: between 0 and 1 while only the rim does.
    sliding_m_s : float
        Mean speed of sliding, weighted by force [m/s].
    tip_force_n : float
        Of `force_n`, what a tip presses [N].
    """

    force_n: float = 0.0
    sliding_share: float = 0.0
    sliding_m_s: float = 0.0
    tip_force_n: float = 0.0


@dataclass(frozen=True)
class HandTruth:
    """The world at an instant; vectors are in the palm's frame.

    Attributes
    ----------
    time_s : float
        Since the start.
    object_position_m, object_velocity_m_s, object_turn_rad_s : tuple of float
        Of the object's middle; 0 without an object.
    object_quaternion : tuple of float
        Its orientation: w, x, y, z.
    object_held : bool
        Something else than the hand holds it.
    object_lost : bool
        It has fallen out of the hand.
    load_n : tuple of float
        What pulls at it besides gravity [N].
    gravity_m_s2 : tuple of float
        What hand and object feel of gravity and of being shaken.
    tip_depth_m : float
        How far the tip is below the untouched surface of the skin it is pushed into; negative above it, NaN without.
    tip_patch : str
        Patch that the tip is pushed into; empty without.
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
        """The truth out of a row.

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
        """For JSON; what is NaN is None."""
        values = asdict(self)
        if math.isnan(self.tip_depth_m):
            values["tip_depth_m"] = None
        return values


class TruthFollower:
    """Takes the rows out of the ring that `hand_world` writes.

    Parameters
    ----------
    path : Path
        The ring.
    patches : int
        How many patches the layout has.

    Raises
    ------
    ActsError
        When there is no such ring.
    """

    def __init__(self, path: Path, patches: int = 13) -> None:
        self._ring = TimedRingReader(path, row_width(patches))
        self._newest_ns = 0

    def new(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """What has come since the last call, oldest first; at most what the ring holds.

        Returns
        -------
        times_ns : np.ndarray [shape=(n,), dtype=int64]
            CLOCK_MONOTONIC that each row is true at [ns].
        rows : np.ndarray [shape=(n, width), dtype=float64]
            Columns as `COLUMN` and `PATCHES_FROM` say, or `HandTruth.from_row` for one of them.
        """
        times_ns, rows = self._ring.since(self._newest_ns)
        if len(times_ns):
            self._newest_ns = int(times_ns[-1])
        return times_ns, rows
