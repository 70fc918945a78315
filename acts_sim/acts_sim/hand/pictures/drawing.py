# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A drawing of the hand from its true state: links as lines, taxels as dots, the object as a wire frame."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.skin import Layout
from acts_sim.hand import BOX, CAPSULE, CYLINDER, PALM, SOLIDS, HandTruth, HeldObject, Piece, frames, rotation_of

_LINK_COLOUR, _OBJECT_COLOUR = "0.6", "tab:orange"
_COUNTS_FULL = 400.0
_AROUND = np.linspace(0.0, 2.0 * np.pi, 25)
_REACH_M = 0.11
_MIDDLE_M = (0.0, -0.03, -0.05)


def draw_hand(
    axes: Any,
    truth: HandTruth,
    layout: Layout,
    thing: HeldObject | None = None,
    counts: NDArray[np.float64] | None = None,
) -> None:
    """Draw hand, skin and object.

    Parameters
    ----------
    axes : mpl_toolkits.mplot3d.Axes3D
        Axes of matplotlib with ``projection="3d"``; gravity points down in the picture.
    truth : HandTruth
    layout : Layout
        Positions of the taxels.
    thing : HeldObject, optional
        The object in the hand.
    counts : np.ndarray [shape=(taxels,), dtype=float64], optional
        Counts of the taxels, in the order of the matrix.
    """
    show = _upright(np.array(truth.gravity_m_s2))
    links, at_rest = frames(truth.q_rad), frames()
    for solid in SOLIDS:
        (origin, turn), (rest_origin, rest_turn) = links[solid.link], at_rest[solid.link]
        ends = (np.array([solid.start_m, solid.end_m]) - rest_origin) @ rest_turn @ turn.T + origin
        if solid.link == PALM:
            _lines(axes, [_box(ends[0], ends[1])], show, _LINK_COLOUR, 1.0)
        else:
            _lines(axes, [ends], show, _LINK_COLOUR, 9.0)
    for patch in layout.patches:
        origin, turn = links[patch.link]
        points = (patch.points_m().reshape(-1, 3) @ turn.T + origin) @ show.T
        pressed = np.zeros(len(points))
        if counts is not None:
            pressed = np.clip(counts[patch.of(layout.taxels).ravel()] / _COUNTS_FULL, 0.0, 1.0)
        colour = np.column_stack([0.25 + 0.75 * pressed, 0.3 * (1 - pressed), 0.35 * (1 - pressed)])
        axes.scatter(*points.T, s=2.0 + 14.0 * pressed, c=colour, depthshade=False)
    if thing is not None:
        turn, where = rotation_of(_four(truth.object_quaternion)), np.array(truth.object_position_m)
        for piece in thing.pieces:
            inner = rotation_of(piece.quaternion)
            curves = [(curve @ inner.T + piece.offset_m) @ turn.T + where for curve in _net(piece)]
            _lines(axes, curves, show, _OBJECT_COLOUR, 0.8)
    middle = show @ _MIDDLE_M
    for set_limits, value in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), middle, strict=True):
        set_limits(value - _REACH_M, value + _REACH_M)
    axes.set_box_aspect((1, 1, 1), zoom=1.7)
    axes.set_axis_off()


def _upright(gravity: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation that turns gravity in the palm's frame to -z."""
    up = -gravity / max(float(np.linalg.norm(gravity)), 1e-9)
    forward = np.array([1.0, 0.0, 0.0]) if abs(up[0]) < 0.9 else np.array([0.0, 0.0, -1.0])
    forward = forward - (forward @ up) * up
    forward /= np.linalg.norm(forward)
    return np.array([forward, np.cross(up, forward), up])


def _lines(
    axes: Any, curves: Sequence[NDArray[np.float64]], show: NDArray[np.float64], colour: str, width: float
) -> None:
    for curve in curves:
        axes.plot(*(curve @ show.T).T, color=colour, linewidth=width, solid_capstyle="round")


def _four(numbers: tuple[float, ...]) -> tuple[float, float, float, float]:
    w, x, y, z = numbers
    return w, x, y, z


def _box(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """All edges of a box as one polyline."""
    corners = [0b000, 0b001, 0b011, 0b010, 0b000, 0b100, 0b101, 0b001, 0b101, 0b111, 0b011, 0b111, 0b110, 0b010, 0b110]
    path = [*corners, 0b100]
    return np.array([[(low, high)[corner >> axis & 1][axis] for axis in range(3)] for corner in path])


def _net(piece: Piece) -> list[NDArray[np.float64]]:
    """Lines on the surface of a solid, in its frame."""
    size = piece.size_m
    c, s, zero = np.cos(_AROUND), np.sin(_AROUND), np.zeros(len(_AROUND))
    if piece.kind == BOX:
        return [_box(-np.array(size[:3]), np.array(size[:3]))]
    if piece.kind in (CAPSULE, CYLINDER):
        rings = [np.column_stack([size[0] * c, size[0] * s, zero + z]) for z in (-size[1], 0.0, size[1])]
        sides = [
            np.array([[size[0] * np.cos(a), size[0] * np.sin(a), z] for z in (-size[1], size[1])])
            for a in np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
        ]
        return [*rings, *sides]
    meridians = [np.column_stack([s * np.cos(a), s * np.sin(a), c]) for a in np.linspace(0.0, np.pi, 6, endpoint=False)]
    circles = [
        np.column_stack([np.cos(b) * c, np.cos(b) * s, zero + np.sin(b)]) for b in np.linspace(-np.pi / 3, np.pi / 3, 5)
    ]
    return [size[0] * curve for curve in (*meridians, *circles)]
