# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines over time as a surface, with time along z, and as a file that viewers of 3D models open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import write_whole
from acts_recon.outlines.outline import Outline, way_around

Array = NDArray[np.float64]

_CORNERS = 72


@dataclass(frozen=True)
class Surface:
    """A closed surface of triangles.

    Attributes
    ----------
    points_m : np.ndarray [shape=(n, 3), dtype=float64]
        x and y on the skin [m], and z: time after the first outline, times a speed [m].
    triangles : np.ndarray [shape=(m, 3), dtype=intp]
        Indices of points, counter-clockwise seen from outside.
    """

    points_m: Array
    triangles: NDArray[np.intp]


def surface_of(outlines: Sequence[Outline], speed_m_s: float = 5.0) -> Surface:
    """The surface through the outlines of one contact.

    Parameters
    ----------
    outlines : sequence of Outline
        In the order of time; at least two.
    speed_m_s : float
        How far a second reaches along z [m/s].

    Raises
    ------
    RecordingError
        With fewer than two outlines.
    """
    if len(outlines) < 2:
        raise RecordingError(f"{len(outlines)} outlines: a surface needs two or more of one contact")
    rings = [_ring(outline, speed_m_s * (outline.time_s - outlines[0].time_s)) for outline in outlines]
    here = np.arange(_CORNERS)
    after = (here + 1) % _CORNERS
    faces = []
    for number in range(len(rings) - 1):
        low, high = number * _CORNERS, (number + 1) * _CORNERS
        faces.append(np.column_stack((low + here, low + after, high + after)))
        faces.append(np.column_stack((low + here, high + after, high + here)))
    # Lids: fans around the middle of the first and the last.
    first, last, top = len(rings) * _CORNERS, len(rings) * _CORNERS + 1, (len(rings) - 1) * _CORNERS
    faces.append(np.column_stack((np.full(_CORNERS, first), after, here)))
    faces.append(np.column_stack((np.full(_CORNERS, last), top + here, top + after)))
    middles = np.array([rings[0].mean(axis=0), rings[-1].mean(axis=0)])
    return Surface(np.vstack((*rings, middles)), np.concatenate(faces).astype(np.intp))


def write_ply(surface: Surface, path: Path) -> None:
    """Write a surface as PLY (Stanford polygon file), in text, as a whole or not at all.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    head = (
        "ply\nformat ascii 1.0\ncomment x and y on the skin [m], z is time\n"
        f"element vertex {len(surface.points_m)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(surface.triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    points = "".join(f"{x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in surface.points_m.tolist())
    faces = "".join(f"3 {a} {b} {c}\n" for a, b, c in surface.triangles.tolist())
    with write_whole(path, error=RecordingError, hint="its folder must exist") as file:
        file.write(f"{head}{points}{faces}".encode())


def _ring(outline: Outline, z_m: float) -> Array:
    """Corners at equal distances along the outline, from where it is farthest along x from its centre."""
    centre_x, centre_y = outline.centre_m
    angle = np.arctan2(outline.y_m - centre_y, outline.x_m - centre_x)
    first = int(np.argmin(np.abs(angle)))
    corners = np.roll(np.column_stack((outline.x_m, outline.y_m)), -first, axis=0)
    closed, along = way_around(corners)
    at = along[-1] * np.arange(_CORNERS) / _CORNERS
    return np.column_stack([*(np.interp(at, along, closed[:, k]) for k in (0, 1)), np.full(_CORNERS, z_m)])
