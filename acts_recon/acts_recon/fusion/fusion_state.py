# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings and state of the fusion's kernels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_recon.images import LEAST_NOISE_COUNTS, Borders

TILE = 4
"""Side of the tiles that have a velocity each [taxels]."""

UNKNOWN_COUNTS = 300.0
"""Sigma of a taxel that was never measured: about that of equally likely counts, ``1024 / sqrt(12)``."""


def known_noise(noise_counts: float) -> float:
    """`FusionConfig.noise_counts` for noise that is known, even to be none; there 0 stands for not known [counts]."""
    return max(noise_counts, LEAST_NOISE_COUNTS)


SUMS = 7
LEARNT_COLUMNS = SUMS + 4
PRODUCT, SQUARE, READINGS, CHANGES, EXPECTED, TOTAL, NUMBER, QUIET, TRUST, IS_NOISE, RESTING = range(LEARNT_COLUMNS)
"""Columns of `State.learnt`; the first `SUMS` are sums that fade."""

CLIPPED_CHANGE = 0.68
"""Mean square of the change from reading to reading over the variance of the noise, where readings below 0 are 0."""

QUIET_SIGMAS = 4.6
"""A taxel reads less than this many standard deviations of its noise while nothing touches it."""

PRIOR_SAMPLES = 4.0
"""As if so many readings of untouched taxels had shown the calibrated noise."""


class Tuning(NamedTuple):
    """`acts_recon.fusion.fusion.FusionConfig` for the kernels; times [s], counts."""

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
        The skin at the end of the last frame, as far as the estimate is trusted, and its standard deviation [counts].
    estimate : np.ndarray [shape=(taxels,), dtype=float32]
        What motion, slopes and innovations beside predict [counts]; of fresh taxels what was measured.
    noise : np.ndarray [shape=(taxels,), dtype=float32]
        Calibrated standard deviation of a reading [counts].
    unknown : np.ndarray [shape=(taxels,), dtype=float32]
        1 where the noise is only assumed, else 0.
    value, slope, age : np.ndarray [shape=(taxels,), dtype=float32]
        Last measurement [counts], how fast it changed [counts/s], and how long it has been [s]; inf: never.
    process_noise : np.ndarray [shape=(taxels,), dtype=float32]
        Mean square of the prediction error per second [(counts/s)^2].
    around : np.ndarray [shape=(taxels,), dtype=float32]
        Maximum of the process noise of the 3 x 3 taxels around each, as `sigma` was computed from it.
    fade : np.ndarray [shape=(taxels,), dtype=float32]
        Factor of the slope, from 1 at the time of the measurement towards 0.
    fresh : np.ndarray [shape=(taxels,), dtype=bool]
        Whether the taxel was measured in the last frame.
    low : np.ndarray [shape=(taxels,), dtype=bool]
        Whether the last readings of the taxel and of all beside it can be noise.
    product, square, slope_square : np.ndarray [shape=(taxels,), dtype=float32]
        Sums, fading, of predicted times measured change, of predicted change squared, and of the square of what the
        slope alone predicted [counts^2], where a taxel was measured within the horizon.
    learnt : np.ndarray [shape=(tiles, LEARNT_COLUMNS), dtype=float32]
        Fading sums of each tile [counts^2]: the same two of taxels not measured for longer, and of low readings their
        squares, squares of their changes, calibrated variances, the readings themselves [counts], and their number.
        From them: what untouched taxels may read, in standard deviations of their calibrated noise; the share of
        predictions that came true; 1 where the mean is better than low readings, else 0; that mean [counts].
    log_noise : np.ndarray [shape=(patches,), dtype=float32]
        Logarithm of the noise variance of fast measured taxels over the calibrated one.
    tile_of : np.ndarray [shape=(taxels,), dtype=uint16]
    normal_sums, row_sums : np.ndarray [shape=(tiles, 6), dtype=float32]
        Sums of the normal equations of Lucas-Kanade: of a tile, fading; and over the tiles beside it.
    velocity : np.ndarray [shape=(tiles, 3), dtype=float32]
        Columns and rows per second, and R^2, the share of the changes they explain; 0: not used.
    log_scale : np.ndarray [shape=(patches,), dtype=float32]
        Logarithm of the scale of a patch's process noise, which follows the normalised innovations squared.
    frame_scale : np.ndarray [shape=(patches,), dtype=float32]
        Further scale, from the normalised innovations squared of the last frame alone; at least 1.
    patches : np.ndarray [shape=(patches, 7), dtype=int64]
        First row, row behind the last, first column, column behind the last, first tile, rows and columns of tiles.
    patch_of : np.ndarray [shape=(taxels,), dtype=uint16]
    most : np.ndarray [shape=(patches,), dtype=float32]
        Largest value that was measured within the horizon [counts].
    nis_excess : np.ndarray [shape=(patches,), dtype=float32]
        Sum of the normalised innovations squared of a frame, less their number.
    rate : np.ndarray [shape=(taxels,), dtype=float32]
        How fast the estimate changes [counts/s].
    noise_scale, noise_excess, scale, compared, before, elapsed, innovation, since, total, process_noise_total, weight,
    in_row
        Scratch.
    """

    image: NDArray[np.float32]
    sigma: NDArray[np.float32]
    value: NDArray[np.float32]
    slope: NDArray[np.float32]
    age: NDArray[np.float32]
    process_noise: NDArray[np.float32]
    fade: NDArray[np.float32]
    estimate: NDArray[np.float32]
    noise: NDArray[np.float32]
    unknown: NDArray[np.float32]
    fresh: NDArray[np.bool_]
    low: NDArray[np.bool_]
    product: NDArray[np.float32]
    square: NDArray[np.float32]
    slope_square: NDArray[np.float32]
    learnt: NDArray[np.float32]
    log_noise: NDArray[np.float32]
    noise_scale: NDArray[np.float32]
    noise_excess: NDArray[np.float32]
    tile_of: NDArray[np.uint16]
    normal_sums: NDArray[np.float32]
    row_sums: NDArray[np.float32]
    velocity: NDArray[np.float32]
    log_scale: NDArray[np.float32]
    frame_scale: NDArray[np.float32]
    patches: NDArray[np.int64]
    patch_of: NDArray[np.uint16]
    scale: NDArray[np.float32]
    most: NDArray[np.float32]
    nis_excess: NDArray[np.float32]
    compared: NDArray[np.float32]
    before: NDArray[np.float32]
    elapsed: NDArray[np.float32]
    rate: NDArray[np.float32]
    innovation: NDArray[np.float32]
    since: NDArray[np.float32]
    total: NDArray[np.float32]
    process_noise_total: NDArray[np.float32]
    weight: NDArray[np.float32]
    in_row: NDArray[np.float32]
    around: NDArray[np.float32]


class Memory(NamedTuple):
    """The arrays that `State` is a view of: few, since each argument of a kernel costs time.

    Attributes
    ----------
    taxels : np.ndarray [shape=(23, taxels), dtype=float32]
    flags : np.ndarray [shape=(2, taxels), dtype=bool]
    tiles : np.ndarray [shape=(2, tiles, 6), dtype=float32]
    velocity : np.ndarray [shape=(tiles, 3), dtype=float32]
    scales : np.ndarray [shape=(9, patches), dtype=float32]
    learnt : np.ndarray [shape=(tiles, LEARNT_COLUMNS), dtype=float32]
    patches : np.ndarray [shape=(patches, 7), dtype=int64]
    owners : np.ndarray [shape=(2, taxels), dtype=uint16]
        Patch and tile of every taxel.
    """

    taxels: NDArray[np.float32]
    flags: NDArray[np.bool_]
    tiles: NDArray[np.float32]
    velocity: NDArray[np.float32]
    scales: NDArray[np.float32]
    learnt: NDArray[np.float32]
    patches: NDArray[np.int64]
    owners: NDArray[np.uint16]


def new_memory(rows: int, cols: int, borders: Borders) -> Memory:
    """Allocate the memory of an array that was never measured; its noise is still to be set."""
    patches = _with_tiles(borders.rectangles)
    tiles = int((patches[:, 5] * patches[:, 6]).sum())
    memory = Memory(
        taxels=np.zeros((23, rows * cols), dtype=np.float32),
        flags=np.zeros((2, rows * cols), dtype=np.bool_),
        tiles=np.zeros((2, tiles, 6), dtype=np.float32),
        velocity=np.zeros((tiles, 3), dtype=np.float32),
        scales=np.zeros((9, len(patches)), dtype=np.float32),
        learnt=np.zeros((tiles, LEARNT_COLUMNS), dtype=np.float32),
        patches=patches,
        owners=np.stack((borders.rectangle_of.ravel(), _tile_of(rows, cols, patches))).astype(np.uint16),
    )
    forget(memory)
    return memory


def expect_noise(memory: Memory) -> None:
    """Forget what was learnt of the noise: it is as calibrated until readings say otherwise."""
    state = state_of(memory)
    tiles = len(memory.learnt)
    taxels = np.maximum(np.bincount(state.tile_of, minlength=tiles), 1)
    variance = np.bincount(state.tile_of, np.square(state.noise, dtype=np.float64), tiles) / taxels
    # Readings below 0 are 0, so that their mean square is half of the variance.
    for column, share in ((READINGS, 0.5), (CHANGES, CLIPPED_CHANGE), (EXPECTED, 1.0)):
        memory.learnt[:, column] = PRIOR_SAMPLES * share * variance
    memory.learnt[:, [TOTAL, NUMBER, RESTING]] = 0.0
    memory.learnt[:, QUIET] = QUIET_SIGMAS
    memory.learnt[:, IS_NOISE] = 1.0
    state.log_noise.fill(0.0)


def _tile_of(rows: int, cols: int, patches: NDArray[np.int64]) -> NDArray[np.uint16]:
    """Tile of every taxel; where there is no skin each taxel is a patch, so that none is without."""
    tile_of = np.zeros((rows, cols), dtype=np.uint16)
    for top, bottom, left, right, first, _, tile_cols in patches.tolist():
        row, col = np.ogrid[: bottom - top, : right - left]
        tile_of[top:bottom, left:right] = first + row // TILE * tile_cols + col // TILE
    return tile_of.ravel()


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
        estimate=taxels[16],
        noise=taxels[21],
        unknown=taxels[22],
        fresh=memory.flags[0],
        low=memory.flags[1],
        product=taxels[17],
        square=taxels[18],
        slope_square=taxels[19],
        learnt=memory.learnt,
        log_noise=scales[5],
        noise_scale=scales[6],
        noise_excess=scales[7],
        tile_of=memory.owners[1],
        normal_sums=tiles[0],
        row_sums=tiles[1],
        velocity=memory.velocity,
        log_scale=scales[0],
        frame_scale=scales[1],
        patches=memory.patches,
        patch_of=memory.owners[0],
        scale=scales[2],
        most=scales[8],
        nis_excess=scales[3],
        compared=scales[4],
        before=taxels[7],
        elapsed=taxels[8],
        rate=taxels[9],
        innovation=taxels[10],
        since=taxels[20],
        total=taxels[11],
        process_noise_total=taxels[12],
        weight=taxels[13],
        in_row=taxels[14],
        around=taxels[15],
    )


def forget(memory: Memory) -> None:
    """Reset a memory to the state of an array that was never measured, but for what was learnt of its noise."""
    for array in (memory.taxels[:20], memory.flags, memory.tiles, memory.velocity, memory.scales[:5]):
        array.fill(0)
    state = state_of(memory)
    state.age.fill(np.inf)
    state.sigma.fill(UNKNOWN_COUNTS)
    memory.learnt[:, [PRODUCT, SQUARE]] = 0.0
    memory.learnt[:, TRUST] = 1.0
