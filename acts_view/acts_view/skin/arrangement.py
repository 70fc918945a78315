# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the patches of a skin are drawn, as a person sees them from outside. Knows no ROS.

Patches in the frame of the whole skin lie as they do in the picture. Those of a hand, which links carry, are packed
into the picture as the wires allow; they are drawn as a right hand with its palm towards the viewer, fingertips up.
"""

from __future__ import annotations

from typing import NamedTuple

from acts_core.skin import Layout, SkinPatch

# From the left: of a right hand whose palm one looks at.
_FINGERS = ("little", "ring", "middle", "index")
_THUMB = "thumb"
_PALM = "palm"
_SEGMENTS = ("distal", "medial", "proximal")
_GAP_M = 0.004
# The base of the thumb, counted from the upper edge of the palm.
_THUMB_DOWN_M = 0.03


class Box(NamedTuple):
    """Where a patch is drawn [m]: x to the right and y down, from the upper left corner of the whole."""

    x_m: float
    y_m: float
    width_m: float
    height_m: float


def arrangement(layout: Layout, pitch_m: float = 0.0, row_pitch_m: float = 0.0) -> list[Box]:
    """Where every patch of a layout is drawn, in the order of its patches.

    Parameters
    ----------
    layout : Layout
    pitch_m, row_pitch_m : float
        As `Layout.geometry` takes them [m].
    """
    hand = _hand(layout.patches)
    if hand is not None:
        return hand
    geometry = layout.geometry(pitch_m, row_pitch_m)
    dx_m, dy_m = geometry.pitch_m, geometry.pitch_y_m
    return [
        Box(patch.first_col * dx_m, patch.first_row * dy_m, patch.cols * dx_m, patch.rows * dy_m)
        for patch in layout.patches
    ]


def _hand(patches: tuple[SkinPatch, ...]) -> list[Box] | None:
    """The patches as a hand; None where they are not all of a hand, by their links and names."""
    sizes = {patch.name: (patch.cols * patch.pitch_m, patch.rows * patch.row_pitch_m) for patch in patches}
    columns = {
        finger: [f"{finger}_{segment}" for segment in _SEGMENTS if f"{finger}_{segment}" in sizes]
        for finger in (*_FINGERS, _THUMB)
    }
    known = {_PALM, *(name for names in columns.values() for name in names)}
    if _PALM not in sizes or not sizes.keys() <= known or not all(patch.link for patch in patches):
        return None
    fingers = [finger for finger in _FINGERS if columns[finger]]
    heights_m = {finger: _height_m(columns[finger], sizes) for finger in columns}
    thumb_m = heights_m[_THUMB] - _THUMB_DOWN_M
    palm_y_m = max([0.0, thumb_m, *(heights_m[finger] + _GAP_M for finger in fingers)])
    boxes: dict[str, Box] = {}
    x_m = 0.0
    for finger in fingers:
        x_m = _GAP_M + _stack(columns[finger], sizes, x_m, palm_y_m - _GAP_M, boxes)
    fingers_m = max(x_m - _GAP_M, 0.0)
    palm_m, palm_height_m = sizes[_PALM]
    palm_x_m = max(0.0, (fingers_m - palm_m) / 2)
    boxes[_PALM] = Box(palm_x_m, palm_y_m, palm_m, palm_height_m)
    _stack(columns[_THUMB], sizes, max(fingers_m, palm_x_m + palm_m) + _GAP_M, palm_y_m + _THUMB_DOWN_M, boxes)
    return [boxes[patch.name] for patch in patches]


def _height_m(names: list[str], sizes: dict[str, tuple[float, float]]) -> float:
    return sum(sizes[name][1] for name in names) + _GAP_M * max(len(names) - 1, 0)


def _stack(
    names: list[str], sizes: dict[str, tuple[float, float]], x_m: float, base_m: float, boxes: dict[str, Box]
) -> float:
    """Put the segments of a finger, from the tip down, above its base; returns its right edge."""
    widest_m = max((sizes[name][0] for name in names), default=0.0)
    y_m = base_m - _height_m(names, sizes)
    for name in names:
        width_m, height_m = sizes[name]
        boxes[name] = Box(x_m + (widest_m - width_m) / 2, y_m, width_m, height_m)
        y_m += height_m + _GAP_M
    return x_m + widest_m
