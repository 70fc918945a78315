# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Optical flow of the image for `fusion_kernels`: Lucas-Kanade per tile, in each patch by itself."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.fusion.fusion_state import State, Tuning

AROUND = 2
"""The window of a tile reaches so many tiles beyond it on every side."""

# Ridge (Tikhonov) term of the least squares: the velocity is 0 where the image has no gradient [counts^2].
RIDGE = 200.0

FASTMATH = {"nsz", "contract", "reassoc", "arcp"}
TINY = np.float32(1e-20)
"""What fades exponentially is 0 below it: denormal numbers are slow."""

_F = np.float32


@kernel(fastmath=FASTMATH, inline="always")
def observe_motion(
    state: State,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    period_s: float,
    lag_step_s: float,
    cols: int,
    tuning: Tuning,
) -> None:
    """Add the samples to the sums of the normal equations of their tiles: products of gradients and changes."""
    m = indices.shape[0]
    fade = _F(math.exp(-period_s / tuning.motion_memory_s))
    image, normal_sums, tile_of = state.estimate, state.normal_sums, state.tile_of
    for a in range(normal_sums.shape[0]):
        for q in range(6):
            faded = normal_sums[a, q] * fade
            normal_sums[a, q] = faded if abs(faded) > TINY else _F(0)
    patches, patch_of = state.patches, state.patch_of
    horizon = _F(tuning.horizon_s)
    for k in range(m):
        i = int(np.int64(indices[k]))
        since = state.age[i] + _F(period_s) - _F(lag_step_s * (m - 1 - k))
        if not _F(0) < since < horizon:
            continue
        row = i // cols
        col = i - row * cols
        change = (_F(counts[k]) - state.value[i]) / since
        p = patch_of[i]
        top, bottom, left, right = patches[p, 0], patches[p, 1] - 1, patches[p, 2], patches[p, 3] - 1
        along_cols = (image[row * cols + min(col + 1, right)] - image[row * cols + max(col - 1, left)]) * _F(0.5)
        along_rows = (image[min(row + 1, bottom) * cols + col] - image[max(row - 1, top) * cols + col]) * _F(0.5)
        tile = tile_of[i]
        normal_sums[tile, 0] += along_cols * along_cols
        normal_sums[tile, 1] += along_cols * along_rows
        normal_sums[tile, 2] += along_rows * along_rows
        normal_sums[tile, 3] -= along_cols * change
        normal_sums[tile, 4] -= along_rows * change
        normal_sums[tile, 5] += change * change


@kernel(fastmath=FASTMATH, inline="always")
def find_velocities(state: State, tuning: Tuning) -> None:
    """Solve the normal equations of every tile; keep the velocity where it explains enough of the changes."""
    for p in range(state.patches.shape[0]):
        first, tile_rows, tile_cols = state.patches[p, 4], state.patches[p, 5], state.patches[p, 6]
        last = first + tile_rows * tile_cols
        _find_velocities_of(
            state.normal_sums[first:last].reshape((tile_rows, tile_cols, 6)),
            state.row_sums[first:last].reshape((tile_rows, tile_cols, 6)),
            state.velocity[first:last].reshape((tile_rows, tile_cols, 3)),
            tuning,
        )


@kernel(fastmath=FASTMATH, inline="always")
def _find_velocities_of(
    normal_sums: NDArray[np.float32], row_sums: NDArray[np.float32], velocities: NDArray[np.float32], tuning: Tuning
) -> None:
    """`find_velocities` of one patch; arrays are (tile rows, tile columns, ...)."""
    tile_rows, tile_cols = normal_sums.shape[0], normal_sums.shape[1]
    for a in range(tile_rows):
        for b in range(tile_cols):
            for q in range(6):
                row_sums[a, b, q] = _F(0)
            for beside in range(max(b - AROUND, 0), min(b + AROUND + 1, tile_cols)):
                for q in range(6):
                    row_sums[a, b, q] += normal_sums[a, beside, q]
    for a in range(tile_rows):
        for b in range(tile_cols):
            cc, cr, rr, ct, rt, tt = _F(0), _F(0), _F(0), _F(0), _F(0), _F(0)
            for beside in range(max(a - AROUND, 0), min(a + AROUND + 1, tile_rows)):
                cc += row_sums[beside, b, 0]
                cr += row_sums[beside, b, 1]
                rr += row_sums[beside, b, 2]
                ct += row_sums[beside, b, 3]
                rt += row_sums[beside, b, 4]
                tt += row_sums[beside, b, 5]
            for q in range(3):
                velocities[a, b, q] = _F(0)
            if not tt > _F(0):
                continue
            cc += _F(RIDGE)
            rr += _F(RIDGE)
            determinant = cc * rr - cr * cr
            if not determinant > _F(0):
                continue
            by_cols = (rr * ct - cr * rt) / determinant
            by_rows = (cc * rt - cr * ct) / determinant
            share = (by_cols * ct + by_rows * rt) / tt
            if share > _F(tuning.motion_share):
                velocities[a, b, 0], velocities[a, b, 1], velocities[a, b, 2] = by_cols, by_rows, min(share, _F(1))


@kernel(fastmath=FASTMATH, inline="always")
def moved(
    before: NDArray[np.float32],
    row: int,
    col: int,
    back_rows: np.float32,
    back_cols: np.float32,
    first_row: int,
    end_row: int,
    first_col: int,
    end_col: int,
    cols: int,
) -> np.float32:
    """The image `back_rows` and `back_cols` away, bilinear; beyond the patch its edge is continued."""
    c = min(max(_F(col) - back_cols, _F(first_col)), _F(end_col - 1))
    r = min(max(_F(row) - back_rows, _F(first_row)), _F(end_row - 1))
    left, top = int(c), int(r)
    right, bottom = min(left + 1, end_col - 1), min(top + 1, end_row - 1)
    c -= _F(left)
    r -= _F(top)
    above = before[top * cols + left] * (_F(1) - c) + before[top * cols + right] * c
    below = before[bottom * cols + left] * (_F(1) - c) + before[bottom * cols + right] * c
    return above * (_F(1) - r) + below * r
