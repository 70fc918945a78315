# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contacts in an image one by one, in numba, without allocation: the same as `blobs_reference` in the tests."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel
from acts_recon.contacts.grid import Grid, Thresholds
from acts_recon.images import SMALLEST_DIVISOR, force_of, taxel_variances

MAX_BLOBS = 16
"""Contacts kept of a frame at most, the strongest."""

BLOB = np.dtype(
    [
        ("x_m", "f8"),
        ("y_m", "f8"),
        ("force_n", "f8"),
        ("peak_counts", "f8"),
        ("taxels", "i8"),
        # Central second moments of the force [m^2].
        ("xx_m2", "f8"),
        ("xy_m2", "f8"),
        ("yy_m2", "f8"),
        # Variances of position [m^2], force [N^2], number of taxels and square of the spread [m^4].
        ("x_var", "f8"),
        ("y_var", "f8"),
        ("force_var", "f8"),
        ("taxels_var", "f8"),
        ("spread_square_var", "f8"),
        # Where its taxels stand in `members`.
        ("first", "i8"),
        ("last", "i8"),
        # Index of the first taxel of the rectangle that it lies in: borders part contacts.
        ("patch", "i8"),
    ]
)
"""What `find_blobs` writes of each contact."""


class Work(NamedTuple):
    """The buffers of `find_blobs`; n is the number of taxels.

    Attributes
    ----------
    state : np.ndarray [shape=(n,), dtype=uint8]
        Which taxels are pressed; kept from frame to frame.
    members : np.ndarray [shape=(n,), dtype=int32]
        Written: the taxels of the contacts, one contact after the other.
    label, border : np.ndarray [shape=(n,), dtype=int32]
        Group of each taxel, and the taxels around one group.
    blobs : np.ndarray [shape=(MAX_BLOBS + 1,), dtype=BLOB]
        Written: the contacts; the last one is work space.
    """

    state: NDArray[np.uint8]
    members: NDArray[np.int32]
    label: NDArray[np.int32]
    border: NDArray[np.int32]
    blobs: NDArray[Any]

    @classmethod
    def empty(cls, n: int) -> Work:
        """At the start, with nothing pressed."""
        return cls(
            state=np.zeros(n, dtype=np.uint8),
            members=np.zeros(n, dtype=np.int32),
            label=np.zeros(n, dtype=np.int32),
            border=np.zeros(n, dtype=np.int32),
            blobs=np.zeros(MAX_BLOBS + 1, dtype=BLOB),
        )


@kernel
def find_blobs(
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    grid: Grid,
    thresholds: Thresholds,
    release_counts: float,
    work: Work,
) -> tuple[int, int]:
    """Find the groups of neighbouring pressed taxels, and describe each.

    Parameters
    ----------
    image : np.ndarray [shape=(rows * cols,), dtype=float32]
        Counts.
    sigma : np.ndarray [shape=(rows * cols,) or (0,), dtype=float32]
        Standard deviations of the taxels [counts]; empty where not known, the variances are then 0.
    grid : Grid
    thresholds : Thresholds
    release_counts : float
        At or below it a taxel ceases to be pressed.
    work : Work

    Returns
    -------
    tuple of int
        Contacts written, and weaker ones left out.
    """
    state, members, label, border, blobs = work.state, work.members, work.label, work.border, work.blobs
    bounds, cols, touch_counts = grid.bounds, grid.cols, thresholds.touch_counts
    size = image.shape[0]
    for t in range(size):
        state[t] = 1 if image[t] > (release_counts if state[t] else touch_counts) else 0
        label[t] = 0
    groups = 0
    n_members = 0
    kept = 0
    dropped = 0
    for seed in range(size):
        if not state[seed] or label[seed] > 0:
            continue
        groups += 1
        first = n_members
        members[n_members] = seed
        n_members += 1
        label[seed] = groups
        n_border = 0
        top, bottom, left, right = bounds[seed, 0], bounds[seed, 1], bounds[seed, 2], bounds[seed, 3]
        i = first
        while i < n_members:
            row = members[i] // cols
            col = members[i] - row * cols
            i += 1
            for r in range(max(row - 1, top), min(row + 2, bottom)):
                for c in range(max(col - 1, left), min(col + 2, right)):
                    other = r * cols + c
                    if state[other]:
                        if label[other] == 0:
                            label[other] = groups
                            members[n_members] = other
                            n_members += 1
                    elif label[other] != -groups:
                        label[other] = -groups
                        border[n_border] = other
                        n_border += 1
        place = kept
        if kept < MAX_BLOBS:
            kept += 1
        else:
            dropped += 1
        blob = blobs[place]
        blob.first = first
        blob.last = n_members
        blob.patch = top * cols + left
        # What only the hysteresis holds joins, but does not count, unless there is nothing else.
        least = release_counts
        for i in range(first, n_members):
            if image[members[i]] > touch_counts:
                least = touch_counts
                break
        _describe(image, least, grid, members, blob)
        if sigma.shape[0] > 0:
            _propagate(image, sigma, least, grid, thresholds, members, border[:n_border], blob)
        else:
            blob.x_var = blob.y_var = blob.force_var = blob.taxels_var = blob.spread_square_var = 0.0
        if place == MAX_BLOBS:
            weakest = 0
            for b in range(1, MAX_BLOBS):
                if blobs[b].force_n < blobs[weakest].force_n:
                    weakest = b
            if blob.force_n > blobs[weakest].force_n:
                blobs[weakest] = blobs[place]
    return kept, dropped


@kernel
def _describe(image: NDArray[np.float32], least: float, grid: Grid, members: NDArray[np.int32], blob: Any) -> None:
    """Write force, place, size and second moments of a contact, of its taxels above `least` [counts]."""
    cols, pitch_m, pitch_y_m, force_n = grid.cols, grid.pitch_m, grid.pitch_y_m, grid.force_n
    rows = image.shape[0] // cols
    total = by_col = by_row = peak = 0.0
    taxels = 0
    for i in range(blob.first, blob.last):
        if image[members[i]] <= least:
            continue
        row = members[i] // cols
        col = members[i] - row * cols
        value = min(np.float64(image[members[i]]), float(COUNT_MAX))
        weight = force_of(value, force_n)
        total += weight
        by_col += weight * col
        by_row += weight * row
        peak = max(peak, value)
        taxels += 1
    mean_col = by_col / max(total, SMALLEST_DIVISOR)
    mean_row = by_row / max(total, SMALLEST_DIVISOR)
    xx = xy = yy = 0.0
    for i in range(blob.first, blob.last):
        if image[members[i]] <= least:
            continue
        row = members[i] // cols
        weight = force_of(np.float64(image[members[i]]), force_n)
        x = (members[i] - row * cols - mean_col) * pitch_m
        y = (mean_row - row) * pitch_y_m
        xx += weight * x * x
        xy += weight * x * y
        yy += weight * y * y
    blob.x_m = (mean_col - (cols - 1) / 2) * pitch_m
    blob.y_m = ((rows - 1) / 2 - mean_row) * pitch_y_m
    blob.force_n = total
    blob.peak_counts = peak
    blob.taxels = taxels
    blob.xx_m2 = xx / max(total, SMALLEST_DIVISOR)
    blob.xy_m2 = xy / max(total, SMALLEST_DIVISOR)
    blob.yy_m2 = yy / max(total, SMALLEST_DIVISOR)


@kernel
def _propagate(
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    least: float,
    grid: Grid,
    thresholds: Thresholds,
    members: NDArray[np.int32],
    border: NDArray[np.int32],
    blob: Any,
) -> None:
    """Variances; see `acts_recon.images.uncertainty` for the formulae."""
    cols, pitch_m, pitch_y_m = grid.cols, grid.pitch_m, grid.pitch_y_m
    noise_counts, together = thresholds.noise_counts, thresholds.together
    rows = image.shape[0] // cols
    x_var = y_var = force_var = taxels_var = spread_square_var = 0.0
    spread_square = blob.xx_m2 + blob.yy_m2
    n = blob.last - blob.first
    for i in range(n + border.shape[0]):
        t = members[blob.first + i] if i < n else border[i - n]
        pressed = i < n and image[t] > least
        if not sigma[t] > 0.0:
            continue
        # What is not a number is not pressed.
        value = float(image[t]) if image[t] > 0.0 else 0.0
        square, wrong = taxel_variances(
            value, float(sigma[t]), pressed, least, noise_counts, together, grid.force_n, grid.slope_n
        )
        row = t // cols
        x = ((t - row * cols) - (cols - 1) / 2) * pitch_m - blob.x_m
        y = ((rows - 1) / 2 - row) * pitch_y_m - blob.y_m
        force_var += square
        x_var += square * x * x
        y_var += square * y * y
        taxels_var += wrong
        spread_square_var += square * (x * x + y * y - spread_square) ** 2
    square_n = max(blob.force_n, SMALLEST_DIVISOR) ** 2
    blob.x_var = x_var / square_n
    blob.y_var = y_var / square_n
    blob.force_var = force_var
    blob.taxels_var = taxels_var
    blob.spread_square_var = spread_square_var / square_n
