# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects for the hand to hold, each made of a few solids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_sim.hand.kinematics import PALM_SURFACE_Z_M, rotation_of
from acts_sim.hand.solid_kernels import BOX, CAPSULE, CYLINDER, SOLID, SPHERE, TIP

# Rotations of the z axis to y and to x: quaternions w, x, y, z.
_Z_TO_Y = (0.5**0.5, -(0.5**0.5), 0.0, 0.0)
_Z_TO_X = (0.5**0.5, 0.0, 0.5**0.5, 0.0)
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)

_EDGE_M = 0.003

PALM_MIDDLE_M = (-0.044, -0.035)
"""x and y of the centre of the palm's skin in the palm's frame [m]."""


@dataclass(frozen=True)
class Piece:
    """A solid of an object.

    Attributes
    ----------
    kind : int
        Kind of solid as in `solid_kernels`.
    size_m : tuple of float
        Dimensions as in `solid_kernels.SOLID`.
    offset_m : tuple of float
        Position in the object's frame; `quaternion` (w, x, y, z) is the orientation.
    """

    kind: int
    size_m: tuple[float, ...]
    offset_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, float, float, float] = _UPRIGHT


@dataclass(frozen=True)
class HeldObject:
    """An object that the hand can hold.

    Attributes
    ----------
    name : str
    pieces : tuple of Piece
    mass_kg : float
    unevenness : float
        Factor on the setting `unevenness_m`; 0 for spheres, whose pressure pattern moves without it.
    height_m : float
        Height of its centre above the palm when it lies there [m].
    """

    name: str
    pieces: tuple[Piece, ...]
    mass_kg: float
    height_m: float
    unevenness: float = 1.0

    def on_palm(self, dx_m: float, dy_m: float) -> NDArray[np.float64]:
        """Its centre when it lies on the palm, at an offset from the palm's centre; np.ndarray [shape=(3,)] [m]."""
        return np.array([PALM_MIDDLE_M[0] + dx_m, PALM_MIDDLE_M[1] + dy_m, PALM_SURFACE_Z_M - self.height_m])


# The defaults: radius or half the width [m], and mass [kg].
_SIZES_M = {"sphere": 0.030, "small_sphere": 0.011, "box": 0.022, "cylinder": 0.025, "other_hand": 0.0085}
_MASSES_KG = {"sphere": 0.10, "small_sphere": 0.02, "box": 0.12, "cylinder": 0.15, "other_hand": 0.40}

OBJECTS = tuple(_SIZES_M)
"""Names of the objects."""

_CYLINDER_HALF_LENGTH_M = 0.06
_FINGER_HALF_LENGTH_M = 0.065
_FINGERS = 4


def held_object(name: str, size_m: float = 0.0, mass_kg: float = 0.0) -> HeldObject:
    """Make an object; size and mass of 0 mean the defaults.

    Parameters
    ----------
    name : str
        One of `OBJECTS`.
    size_m : float
        Radius of spheres, of the cylinder and of the other hand's fingers; half the width of the box [m].
    mass_kg : float
    """
    size_m = size_m or _SIZES_M[name]
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
    """Four fingers and their metacarpals side by side along y, and two bars across the back that join them."""
    pitch_m = 1.8 * radius_m
    size = (radius_m, _FINGER_HALF_LENGTH_M)
    fingers = [Piece(CAPSULE, size, ((k - (_FINGERS - 1) / 2) * pitch_m, 0.0, 0.0), _Z_TO_Y) for k in range(_FINGERS)]
    across = (0.8 * radius_m, (_FINGERS - 1) / 2 * pitch_m)
    return (
        *fingers,
        Piece(CAPSULE, across, (0.0, 0.025, -0.5 * radius_m), _Z_TO_X),
        Piece(CAPSULE, across, (0.0, 0.050, -0.5 * radius_m), _Z_TO_X),
    )


def solids_of(thing: HeldObject | None, thing_body: int, tip_body: int, unevenness_m: float) -> NDArray[np.void]:
    """The pieces of an object, and last a tip that is not there yet.

    Parameters
    ----------
    thing : HeldObject or None
    thing_body, tip_body : int
        Bodies of the model.
    unevenness_m : float
        The setting.

    Returns
    -------
    np.ndarray [shape=(pieces + 1,), dtype=SOLID]
        Without waves, which `Skin` draws.
    """
    pieces = () if thing is None else thing.pieces
    solids = np.zeros(len(pieces) + 1, SOLID)
    for solid, piece in zip(solids, pieces, strict=False):
        solid["kind"], solid["body"], solid["there"] = piece.kind, thing_body, True
        solid["pos"], solid["mat"] = piece.offset_m, rotation_of(piece.quaternion)
        solid["size"][: len(piece.size_m)] = piece.size_m
        solid["uneven"] = thing.unevenness * unevenness_m if thing else 0.0
    solids[-1]["kind"], solids[-1]["body"], solids[-1]["mat"] = TIP, tip_body, np.eye(3)
    return solids
