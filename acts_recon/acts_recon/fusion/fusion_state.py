# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings and state of the fusion's kernels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_recon.images import Borders

TILE = 4
"""Side of the tiles that have a velocity each [taxels]."""

PATCH_COLUMNS = 7
"""Numbers that `State` has of every patch."""

UNKNOWN_COUNTS = 300.0
"""Sigma of a taxel that was never measured: about that of equally likely counts, ``1024 / sqrt(12)``."""


class Tuning(NamedTuple):
    """`acts_recon.fusion.fusion.FusionConfig` for the kernels; times [s], counts."""

    noise_counts: float
    quiet_counts: float
    quiet_s: float
    horizon_s: float
    damping_s: float
    slope_memory_s: float
    motion_memory_s: float
    motion_share: float
    spread_gain: float


class State(NamedTuple):
    """State of every taxel, and the buffers that `fuse` works in. Arrays of taxels are flat.

    Attributes
    ----------
    image, sigma : np.ndarray [shape=(taxels,), dtype=float32]
        Estimate at the end of the last frame and its standard deviation [counts].
    value, slope, age : np.ndarray [shape=(taxels,), dtype=float32]
        Last measurement [counts], how fast it changed [counts/s], and how long it has been [s]; inf: never.
    process_noise : np.ndarray [shape=(taxels,), dtype=float32]
        Mean square of the prediction error per second [(counts/s)^2].
    fade : np.ndarray [shape=(taxels,), dtype=float32]
        Factor of the slope, from 1 at the time of the measurement towards 0.
    fresh : np.ndarray [shape=(taxels,), dtype=bool]
        Whether the taxel was measured in the last frame.
    normal_sums, row_sums : np.ndarray [shape=(tiles, 6), dtype=float32]
        Sums of the normal equations of Lucas-Kanade: of a tile, fading; and over the tiles beside it.
    velocity : np.ndarray [shape=(tiles, 3), dtype=float32]
        Columns and rows per second, and R^2, the share of the changes they explain; 0: not used.
    log_scale : np.ndarray [shape=(patches,), dtype=float32]
        Logarithm of the scale of a patch's process noise, which follows the normalised innovations squared.
    frame_scale : np.ndarray [shape=(patches,), dtype=float32]
        Further scale, from the normalised innovations squared of the last frame alone; at least 1.
    patches : np.ndarray [shape=(patches, PATCH_COLUMNS), dtype=int64]
        First row, row behind the last, first column, column behind the last, first tile, rows and columns of tiles.
    patch_of : np.ndarray [shape=(taxels,), dtype=uint16]
    nis_excess : np.ndarray [shape=(patches,), dtype=float32]
        Sum of the normalised innovations squared of a frame, less their number.
    scale, compared, before, elapsed, rate, innovation, total, process_noise_total, weight, in_row, around
        Scratch.
    """

    image: NDArray[np.float32]
    sigma: NDArray[np.float32]
    value: NDArray[np.float32]
    slope: NDArray[np.float32]
    age: NDArray[np.float32]
    process_noise: NDArray[np.float32]
    fade: NDArray[np.float32]
    fresh: NDArray[np.bool_]
    normal_sums: NDArray[np.float32]
    row_sums: NDArray[np.float32]
    velocity: NDArray[np.float32]
    log_scale: NDArray[np.float32]
    frame_scale: NDArray[np.float32]
    patches: NDArray[np.int64]
    patch_of: NDArray[np.uint16]
    scale: NDArray[np.float32]
    nis_excess: NDArray[np.float32]
    compared: NDArray[np.float32]
    before: NDArray[np.float32]
    elapsed: NDArray[np.float32]
    rate: NDArray[np.float32]
    innovation: NDArray[np.float32]
    total: NDArray[np.float32]
    process_noise_total: NDArray[np.float32]
    weight: NDArray[np.float32]
    in_row: NDArray[np.float32]
    around: NDArray[np.float32]


class Memory(NamedTuple):
    """The arrays that `State` is a view of: few, since each argument of a kernel costs time.

    Attributes
    ----------
    taxels : np.ndarray [shape=(16, taxels), dtype=float32]
    fresh : np.ndarray [shape=(taxels,), dtype=bool]
    tiles : np.ndarray [shape=(2, tiles, 6), dtype=float32]
    velocity : np.ndarray [shape=(tiles, 3), dtype=float32]
    scales : np.ndarray [shape=(5, patches), dtype=float32]
    patches : np.ndarray [shape=(patches, PATCH_COLUMNS), dtype=int64]
    patch_of : np.ndarray [shape=(taxels,), dtype=uint16]
    """

    taxels: NDArray[np.float32]
    fresh: NDArray[np.bool_]
    tiles: NDArray[np.float32]
    velocity: NDArray[np.float32]
    scales: NDArray[np.float32]
    patches: NDArray[np.int64]
    patch_of: NDArray[np.uint16]


def new_memory(rows: int, cols: int, borders: Borders) -> Memory:
    """Allocate the memory of an array that was never measured."""
    patches = _with_tiles(borders.rectangles)
    tiles = int((patches[:, 5] * patches[:, 6]).sum())
    memory = Memory(
        taxels=np.zeros((16, rows * cols), dtype=np.float32),
        fresh=np.zeros(rows * cols, dtype=np.bool_),
        tiles=np.zeros((2, tiles, 6), dtype=np.float32),
        velocity=np.zeros((tiles, 3), dtype=np.float32),
        scales=np.zeros((5, len(patches)), dtype=np.float32),
        patches=patches,
        patch_of=borders.rectangle_of.copy(),
    )
    forget(memory)
    return memory


def _with_tiles(rectangles: NDArray[np.int32]) -> NDArray[np.int64]:
    """Rectangles with the tiles of each: every one is tiled by itself."""
    tile_rows = -(-(rectangles[:, 1] - rectangles[:, 0]) // TILE)
    tile_cols = -(-(rectangles[:, 3] - rectangles[:, 2]) // TILE)
    first = np.cumsum(tile_rows * tile_cols) - tile_rows * tile_cols
    return np.column_stack((rectangles, first, tile_rows, tile_cols)).astype(np.int64)


def state_of(memory: Memory) -> State:
    """The state in a memory; also compiled, see `acts_recon.fusion.fusion_kernels`."""
    taxels, tiles, scales = memory.taxels, memory.tiles, memory.scales
    return State(
        image=taxels[0],
        sigma=taxels[1],
        value=taxels[2],
        slope=taxels[3],
        age=taxels[4],
        process_noise=taxels[5],
        fade=taxels[6],
        fresh=memory.fresh,
        normal_sums=tiles[0],
        row_sums=tiles[1],
        velocity=memory.velocity,
        log_scale=scales[0],
        frame_scale=scales[1],
        patches=memory.patches,
        patch_of=memory.patch_of,
        scale=scales[2],
        nis_excess=scales[3],
        compared=scales[4],
        before=taxels[7],
        elapsed=taxels[8],
        rate=taxels[9],
        innovation=taxels[10],
        total=taxels[11],
        process_noise_total=taxels[12],
        weight=taxels[13],
        in_row=taxels[14],
        around=taxels[15],
    )


def forget(memory: Memory) -> None:
    """Reset a memory to the state of an array that was never measured."""
    for array in (memory.taxels, memory.fresh, memory.tiles, memory.velocity, memory.scales):
        array.fill(0)
    state = state_of(memory)
    state.age.fill(np.inf)
    state.sigma.fill(UNKNOWN_COUNTS)
