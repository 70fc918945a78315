"""What the hand is given to hold: each thing is made of a few solids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_sim.hand.kinematics import PALM_SURFACE_Z_M
from acts_sim.hand.skin_kernels import BOX, CAPSULE, CYLINDER, SPHERE

# Turns that bring the z axis to y and to x: quaternions w, x, y, z.
_Z_TO_Y = (0.5**0.5, -(0.5**0.5), 0.0, 0.0)
_Z_TO_X = (0.5**0.5, 0.0, 0.5**0.5, 0.0)
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)

_EDGE_M = 0.003

PALM_MIDDLE_M = (-0.044, -0.035)
"""x and y of the middle of the palm's skin in the palm's frame [m]."""


@dataclass(frozen=True)
class Piece:
    """A solid of an object.

    Attributes
    ----------
    kind : int
        Of `skin_kernels`.
    size_m : tuple of float
        As `skin_kernels` has it.
    offset_m : tuple of float
        Where it lies in the object's frame, turned by `quaternion` (w, x, y, z).
    """

    kind: int
    size_m: tuple[float, ...]
    offset_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, float, float, float] = _UPRIGHT


@dataclass(frozen=True)
class HeldObject:
    """A thing that can be in the hand.

    Attributes
    ----------
    name : str
    pieces : tuple of Piece
    mass_kg : float
    unevenness : float
        Height of its bumps, relative to what is set; 0 for spheres, whose pattern moves anyway.
    height_m : float
        How far its middle is above the palm when it lies there [m].
    """

    name: str
    pieces: tuple[Piece, ...]
    mass_kg: float
    height_m: float
    unevenness: float = 1.0

    def on_palm(self, dx_m: float, dy_m: float) -> NDArray[np.float64]:
        """Where its middle is when it lies on the palm, off the palm's middle; np.ndarray [shape=(3,)] [m]."""
        return np.array([PALM_MIDDLE_M[0] + dx_m, PALM_MIDDLE_M[1] + dy_m, PALM_SURFACE_Z_M - self.height_m])


# Smallest and largest of each, and what it is unless told otherwise: radius, or half the width [m], and mass [kg].
_SIZES_M = {
    "sphere": (0.015, 0.030, 0.045),
    "small_sphere": (0.005, 0.011, 0.020),
    "box": (0.010, 0.022, 0.040),
    "cylinder": (0.010, 0.025, 0.040),
    "other_hand": (0.0075, 0.0085, 0.011),
}
_MASSES_KG = {"sphere": 0.10, "small_sphere": 0.02, "box": 0.12, "cylinder": 0.15, "other_hand": 0.40}

OBJECTS = tuple(_SIZES_M)
"""Names of the objects."""

_CYLINDER_HALF_LENGTH_M = 0.06
_FINGER_HALF_LENGTH_M = 0.065
_FINGERS = 4


def size_range_m(name: str) -> tuple[float, float, float]:
    """Smallest, usual and largest size of an object [m]."""
    return _SIZES_M[name]


def held_object(name: str, size_m: float = 0.0, mass_kg: float = 0.0) -> HeldObject:
    """An object; sizes and masses of 0 are the usual ones.

    Parameters
    ----------
    name : str
        One of `OBJECTS`.
    size_m : float
        Radius of spheres, of the cylinder and of the other hand's fingers; half the width of the box [m].
    mass_kg : float
    """
    size_m = size_m or _SIZES_M[name][1]
    mass_kg = mass_kg or _MASSES_KG[name]
    if name == "box":
        return HeldObject(name, (Piece(BOX, (size_m, 1.5 * size_m, size_m, _EDGE_M)),), mass_kg, size_m)
    if name == "cylinder":
        size = (size_m, _CYLINDER_HALF_LENGTH_M, _EDGE_M)
        return HeldObject(name, (Piece(CYLINDER, size, quaternion=_Z_TO_Y),), mass_kg, size_m)
    if name == "other_hand":
        return HeldObject(name, _other_hand(size_m), mass_kg, size_m)
    return HeldObject(name, (Piece(SPHERE, (size_m,)),), mass_kg, size_m, unevenness=0.0)


def _other_hand(radius_m: float) -> tuple[Piece, ...]:
    """Four fingers with their bones in the palm side by side along y, and two across the back that hold them."""
    pitch_m = 1.8 * radius_m
    size = (radius_m, _FINGER_HALF_LENGTH_M)
    fingers = [Piece(CAPSULE, size, ((k - (_FINGERS - 1) / 2) * pitch_m, 0.0, 0.0), _Z_TO_Y) for k in range(_FINGERS)]
    across = (0.8 * radius_m, (_FINGERS - 1) / 2 * pitch_m)
    return (
        *fingers,
        Piece(CAPSULE, across, (0.0, 0.025, -0.5 * radius_m), _Z_TO_X),
        Piece(CAPSULE, across, (0.0, 0.050, -0.5 * radius_m), _Z_TO_X),
    )
