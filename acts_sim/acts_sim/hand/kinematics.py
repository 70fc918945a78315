# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Links, joints and solids of the right LEAP hand.

Offsets and limits are those of its URDF (Shaw et al., 2023, doi:10.15607/RSS.2023.XIX.089). The palm's frame is that of
the link ``palm_lower``: fingers point along x, the flat open thumb along y, and the palm faces -z. The solids are a
model of ours: capsules and boxes around the centre lines of the links.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FINGERS = ("index", "middle", "ring")
PALM = "palm_lower"

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Link:
    """A link and its joint, which turns it about the axis (0, 0, -1) of its own frame.

    Attributes
    ----------
    name, parent : str
    joint : str
    motor_id : int
    offset_m : tuple of float
        Its frame's origin in the parent's frame, with the joint at 0 [m].
    quaternion : tuple of float
        Orientation of its frame in the parent's frame: w, x, y, z.
    limits_rad : (float, float)
        Limits of the joint [rad].
    mass_kg : float
    """

    name: str
    parent: str
    joint: str
    motor_id: int
    offset_m: Triple
    quaternion: tuple[float, float, float, float]
    limits_rad: tuple[float, float]
    mass_kg: float


_FORWARD = (-0.314, 2.23)
_SIDE = (-1.047, 1.047)
_PIP = (-0.506, 1.885)
_DIP = (-0.366, 2.042)
_HALF = 0.5**0.5


def _finger(name: str, first_motor: int, root_m: Triple) -> tuple[Link, ...]:
    return (
        Link(
            *(f"{name}_base", PALM, f"{name}_mcp_forward", first_motor + 1),
            *(root_m, (0.5, 0.5, 0.5, -0.5), _FORWARD, 0.044),
        ),
        Link(
            *(f"{name}_proximal", f"{name}_base", f"{name}_mcp_side", first_motor),
            *((-0.0122, 0.0381, 0.0145), (0.5, -0.5, -0.5, 0.5), _SIDE, 0.032),
        ),
        Link(
            *(f"{name}_medial", f"{name}_proximal", f"{name}_pip", first_motor + 2),
            *((0.0150, 0.0143, -0.0130), (0.5, 0.5, -0.5, 0.5), _PIP, 0.037),
        ),
        Link(
            *(f"{name}_distal", f"{name}_medial", f"{name}_dip", first_motor + 3),
            *((0.0, -0.0361, 0.0002), (1.0, 0.0, 0.0, 0.0), _DIP, 0.016),
        ),
    )


LINKS: tuple[Link, ...] = (
    *_finger("index", 0, (-0.0070, 0.0230, -0.0187)),
    *_finger("middle", 4, (-0.0071, -0.0224, -0.0187)),
    *_finger("ring", 8, (-0.00709, -0.0678, -0.0187)),
    Link(
        *("thumb_base", PALM, "thumb_cmc", 12, (-0.0693, -0.0012, -0.0216)),
        *((_HALF, 0.0, _HALF, 0.0), (-0.349, 2.094), 0.032),
    ),
    Link(
        *("thumb_proximal", "thumb_base", "thumb_axial", 13, (0.0, 0.0143, -0.0130)),
        *((0.5, 0.5, -0.5, 0.5), (-0.47, 2.443), 0.003),
    ),
    Link(
        *("thumb_medial", "thumb_proximal", "thumb_mcp", 14, (0.0, 0.0145, -0.0170)),
        *((_HALF, -_HALF, 0.0, 0.0), (-1.20, 1.90), 0.038),
    ),
    Link(
        *("thumb_distal", "thumb_medial", "thumb_ipl", 15, (0.0, 0.0466, 0.0002)),
        *((0.0, 0.0, 0.0, 1.0), (-1.34, 1.88), 0.049),
    ),
)
"""Parents before children."""

PALM_MASS_KG = 0.237


@dataclass(frozen=True)
class Solid:
    """A part of a link, in the palm's frame while the hand is open and flat.

    Attributes
    ----------
    link : str
    start_m, end_m : tuple of float
        Ends of a capsule's centre line; corners of a box.
    radius_m : float
        Radius of a capsule; 0 for a box.
    """

    link: str
    start_m: Triple
    end_m: Triple
    radius_m: float = 0.0


# Centre lines of the fingers and of the thumb.
_FINGER_Y_M = {"index": 0.0081, "middle": -0.0373, "ring": -0.0827}
_FINGER_Z_M = -0.0195
_THUMB_X_M, _THUMB_Z_M = -0.0823, -0.0214
_CORE_RADIUS_M = 0.010

SKIN_THICKNESS_M = 0.003
"""Thickness of the foam between the solids and the surface of the skin [m]."""

PALM_SURFACE_Z_M = -0.0345
"""z of the surface of the palm's skin, in the palm's frame [m]."""


def _finger_solids(name: str) -> tuple[Solid, ...]:
    y_m = _FINGER_Y_M[name]
    spans = {"base": (0.000, 0.034), "proximal": (0.038, 0.044), "medial": (0.050, 0.079), "distal": (0.088, 0.124)}
    return tuple(
        Solid(f"{name}_{link}", (start, y_m, _FINGER_Z_M), (end, y_m, _FINGER_Z_M), _CORE_RADIUS_M)
        for link, (start, end) in spans.items()
    )


def _thumb_solid(link: str, start_m: float, end_m: float) -> Solid:
    return Solid(link, (_THUMB_X_M, start_m, _THUMB_Z_M), (_THUMB_X_M, end_m, _THUMB_Z_M), _CORE_RADIUS_M)


_CORE_Z_M = PALM_SURFACE_Z_M + SKIN_THICKNESS_M

SOLIDS: tuple[Solid, ...] = (
    # Without the corner in which the thumb turns.
    Solid(PALM, (-0.070, -0.098, _CORE_Z_M), (-0.018, 0.028, 0.0115)),
    Solid(PALM, (-0.094, -0.098, _CORE_Z_M), (-0.070, -0.020, 0.0115)),
    *(solid for finger in FINGERS for solid in _finger_solids(finger)),
    _thumb_solid("thumb_base", 0.000, 0.008),
    _thumb_solid("thumb_proximal", 0.016, 0.026),
    _thumb_solid("thumb_medial", 0.036, 0.072),
    _thumb_solid("thumb_distal", 0.084, 0.1265),
)


def rotation_of(quaternion: tuple[float, float, float, float]) -> NDArray[np.float64]:
    """Rotation matrix of a unit quaternion w, x, y, z; np.ndarray [shape=(3, 3), dtype=float64]."""
    w, x, y, z = np.asarray(quaternion) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def frames(q_rad: Sequence[float] = (0.0,) * 16) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Origin [m] (3,) and rotation (3, 3) of every link in the palm's frame.

    Parameters
    ----------
    q_rad : sequence of float
        Angles of the joints in the order of the motors; all at 0, the hand is open and flat.
    """
    found = {PALM: (np.zeros(3), np.eye(3))}
    for link in LINKS:
        origin_m, rotation = found[link.parent]
        c, s = math.cos(q_rad[link.motor_id]), math.sin(q_rad[link.motor_id])
        turned = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        found[link.name] = (
            origin_m + rotation @ np.array(link.offset_m),
            rotation @ rotation_of(link.quaternion) @ turned,
        )
    return found
