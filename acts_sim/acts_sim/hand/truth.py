"""What is true in the hand's world, for those who judge; nothing that controls the hand may look at it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


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
        What it feels of gravity and of the hand being shaken.
    tip_depth_m : float
        How far the tip is below the untouched surface of the skin it is pushed into; negative above it, NaN without.
    tip_patch : str
        Patch that the tip is pushed into; empty without.
    patches : dict of PatchTruth
        By the patch's name.
    q_rad : tuple of float
        Angles of the joints in the order of the motors.
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
    patches: dict[str, PatchTruth]
    q_rad: tuple[float, ...]

    def as_dict(self) -> dict[str, Any]:
        """For JSON; what is NaN is None."""
        values = asdict(self)
        if np.isnan(self.tip_depth_m):
            values["tip_depth_m"] = None
        return values


def row_names(patches: list[str]) -> list[str]:
    """Names of the numbers that `row` gives."""
    xyz = ("x", "y", "z")
    return [
        "time_s",
        *(f"object_position_m.{axis}" for axis in xyz),
        *(f"object_velocity_m_s.{axis}" for axis in xyz),
        *(f"object_turn_rad_s.{axis}" for axis in xyz),
        *(f"object_quaternion.{axis}" for axis in ("w", *xyz)),
        "object_held",
        "object_lost",
        *(f"load_n.{axis}" for axis in xyz),
        *(f"gravity_m_s2.{axis}" for axis in xyz),
        "tip_depth_m",
        "tip_patch",
        *(
            f"{patch}.{what}"
            for patch in patches
            for what in ("force_n", "sliding_share", "sliding_m_s", "tip_force_n")
        ),
        *(f"q_rad.{k}" for k in range(16)),
    ]


def row(truth: HandTruth) -> NDArray[np.float64]:
    """The truth as numbers, in the order of `row_names`; the patch of the tip by its place, -1 without."""
    names = list(truth.patches)
    return np.array(
        [
            truth.time_s,
            *truth.object_position_m,
            *truth.object_velocity_m_s,
            *truth.object_turn_rad_s,
            *truth.object_quaternion,
            truth.object_held,
            truth.object_lost,
            *truth.load_n,
            *truth.gravity_m_s2,
            truth.tip_depth_m,
            names.index(truth.tip_patch) if truth.tip_patch else -1,
            *(
                number
                for one in truth.patches.values()
                for number in (one.force_n, one.sliding_share, one.sliding_m_s, one.tip_force_n)
            ),
            *truth.q_rad,
        ]
    )
