# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames with a contact, and samples of them, for the tests of this folder."""

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray
from pressed_frames import press

from acts_core.array import ArrayGeometry
from acts_core.sampling import measure_in
from acts_core.sampling.schemes.adaptive import adaptive
from acts_core.skin import NO_PATCH, Layout, SkinPatch


def bump(
    geometry: ArrayGeometry, row: float, col: float, *, width: float = 1.5, peak: float = 700
) -> NDArray[np.uint16]:
    """A round contact; counts (rows, cols)."""
    return press(row, col, width, peak, (geometry.rows, geometry.cols))


def sample(frame: NDArray[np.uint16], m: int) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
    """Adaptive samples of a frame."""
    rows, cols = frame.shape
    return adaptive(measure_in(frame), rows, cols, m, threshold_counts=60)


@st.composite
def layouts(draw: st.DrawFn, rows: int, cols: int) -> Layout | None:
    """A picture cut into patches, with or without gaps, of a matrix as large, whose wires run anyhow; or none."""
    if draw(st.booleans()):
        return None
    pieces = [(0, rows, 0, cols)]
    for _ in range(draw(st.integers(0, 6))):
        top, bottom, left, right = pieces.pop(draw(st.integers(0, len(pieces) - 1)))
        if draw(st.booleans()):
            cut = draw(st.integers(top, bottom))
            halves = [(top, cut, left, right), (cut, bottom, left, right)]
        else:
            cut = draw(st.integers(left, right))
            halves = [(top, bottom, left, cut), (top, bottom, cut, right)]
        pieces += [half for half in halves if half[0] < half[1] and half[2] < half[3]]
    if len(pieces) > 1 and draw(st.booleans()):
        pieces.pop()
    patch_of = np.full((rows, cols), NO_PATCH, dtype=np.uint8)
    for index, (top, bottom, left, right) in enumerate(pieces):
        patch_of[top:bottom, left:right] = index
    taxels = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).permutation(rows * cols).astype(np.uint16)
    patches = tuple(SkinPatch(f"patch_{i}", *piece) for i, piece in enumerate(pieces))
    places = np.argsort(taxels).astype(np.uint16)
    return Layout("drawn", taxels.reshape(rows, cols), places, rows, cols, 0.004, 0.004, patches, patch_of)
