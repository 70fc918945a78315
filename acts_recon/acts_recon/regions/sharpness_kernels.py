# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How much more a contact looks like a tip than like something blunt, in numba; see `acts_recon.regions.sharpness`."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel
from acts_recon.images import force_of

REACH = 2
"""So many taxels to each side of the most pressed one are looked at."""

WINDOW = 2 * REACH + 1

PLACES = 25
"""Along each axis, so many places of a contact within and about the most pressed taxel are tried."""

# How far they reach from its middle [taxels]: gains differ, so the most pressed taxel is not always the one pressed.
_FARTHEST = 0.6

# The first places that are tried about the best so far are so far from it.
_FIRST_STEP = 4

# Of a grid over what presses.
_POINTS = 17

MOST_PRESSED = 9
"""Where more taxels of the window are pressed there is no tip."""

LEAST_LIVE = 5
"""With fewer live taxels of the eight about the most pressed one there is no tip: too little is known."""

MISFIT = 40.0
"""A shape that is worse than this (chi squared of 24 taxels) does not fit."""

_TINY = 1e-30


@kernel
def footprints(
    pitch_m: NDArray[np.float64],
    bend_per_m: NDArray[np.float64],
    radius_m: float,
    stiffness_n_per_m3: float,
    spread_m: float,
    depth_m: NDArray[np.float64],
    force_n: NDArray[np.float64],
    share: NDArray[np.float32],
) -> None:
    """What the taxels feel of a rod with a round end that is pressed into foam.

    The foam's pressure grows with the depth at each point, and is spread sideways by a Gaussian.

    Parameters
    ----------
    pitch_m, bend_per_m : np.ndarray [shape=(2,), dtype=float64]
        Of the taxels along a column and along a row [m], and how the skin is bent there [1/m]; below 0: hollow.
    radius_m : float
        Of the rod and its end.
    stiffness_n_per_m3, spread_m : float
        Of the foam.
    depth_m : np.ndarray [shape=(levels,), dtype=float64]
    force_n : np.ndarray [shape=(levels,), dtype=float64]
        Written: with which force the end is so deep [N].
    share : np.ndarray [shape=(levels, PLACES, PLACES, WINDOW, WINDOW), dtype=float32]
        Written: the part of it that each taxel of the window feels when the end is at a place of its middle taxel.
    """
    # By axis, place, point and taxel.
    felt = np.empty((2, PLACES, _POINTS, WINDOW))
    pressure = np.empty((_POINTS, _POINTS))
    half = np.empty((_POINTS, WINDOW))
    width_m = math.sqrt(2.0) * spread_m
    for level in range(len(depth_m)):
        depth = depth_m[level]
        # Half axes of an ellipse about what is touched.
        touched = np.empty(2)
        for axis in range(2):
            # In a hollow that is bent no less than the end, all of the end is touched.
            curve_per_m = 1.0 / radius_m + bend_per_m[axis]
            touched[axis] = min(math.sqrt(2.0 * depth / curve_per_m), radius_m) if curve_per_m > 0.0 else radius_m
            for place in range(PLACES):
                at = _FARTHEST * (2.0 * place / (PLACES - 1) - 1.0) * pitch_m[axis]
                for point in range(_POINTS):
                    x = at + touched[axis] * (2.0 * point / (_POINTS - 1) - 1.0)
                    for k in range(WINDOW):
                        near, far = (k - REACH - 0.5) * pitch_m[axis], (k - REACH + 0.5) * pitch_m[axis]
                        felt[axis, place, point, k] = 0.5 * (
                            math.erf((far - x) / width_m) - math.erf((near - x) / width_m)
                        )
        total = 0.0
        for i in range(_POINTS):
            y = touched[0] * (2.0 * i / (_POINTS - 1) - 1.0)
            for j in range(_POINTS):
                x = touched[1] * (2.0 * j / (_POINTS - 1) - 1.0)
                below = radius_m * radius_m - x * x - y * y
                deep = depth - radius_m + math.sqrt(max(below, 0.0))
                deep -= 0.5 * (y * y * bend_per_m[0] + x * x * bend_per_m[1])
                pressure[i, j] = deep if deep > 0.0 and below >= 0.0 else 0.0
                total += pressure[i, j]
        force_n[level] = stiffness_n_per_m3 * total * 4.0 * touched[0] * touched[1] / (_POINTS - 1) ** 2
        for b in range(PLACES):
            for i in range(_POINTS):
                for k in range(WINDOW):
                    part = 0.0
                    for j in range(_POINTS):
                        part += pressure[i, j] * felt[1, b, j, k]
                    # Above 0: the middle is as deep as the level says.
                    half[i, k] = part / total
            for a in range(PLACES):
                for row in range(WINDOW):
                    for col in range(WINDOW):
                        part = 0.0
                        for i in range(_POINTS):
                            part += felt[0, a, i, row] * half[i, col]
                        share[level, a, b, row, col] = part


@kernel
def find_sharpness(
    image: NDArray[np.float32],
    bounds: NDArray[np.int64],
    skin_of: NDArray[np.int64],
    level_force_n: NDArray[np.float64],
    share: NDArray[np.float32],
    order: NDArray[np.int64],
    touch_counts: float,
    noise_counts: float,
    gain_error: float,
    force_n: NDArray[np.float64],
    is_dead: NDArray[np.bool_],
    sharpness: NDArray[np.float64],
) -> None:
    """Compare the contact of every patch with a tip and with what is blunt.

    Parameters
    ----------
    image, bounds, touch_counts, force_n
        As of `region_kernels.find_regions`.
    skin_of : np.ndarray [shape=(patches,), dtype=int64]
        Which of the skins below each patch has.
    level_force_n : np.ndarray [shape=(skins, 2, levels), dtype=float64]
        Of a tip and of what is blunt, as `footprints` writes it.
    share : np.ndarray [shape=(skins, 2, levels, PLACES, PLACES, WINDOW, WINDOW), dtype=float32]
    order : np.ndarray [shape=(WINDOW * WINDOW - 1, 2), dtype=int64]
        Row and column of the taxels about the middle of the window, the nearest first.
    noise_counts, gain_error : float
        Standard deviations: of a measurement [counts], and of what a taxel makes of a force, relative to it.
    is_dead : np.ndarray [shape=(rows, cols), dtype=bool]
        Taxels that are estimated from others.
    sharpness : np.ndarray [shape=(patches,), dtype=float64]
        Written: by how much the logarithm of the likelihood of a tip is larger; 0 where it is not, where the most
        pressed taxel lies at the border of its patch, where more than `MOST_PRESSED` are pressed, and where fewer than
        `LEAST_LIVE` beside it are live.
    """
    force, variance = np.empty((WINDOW, WINDOW)), np.empty((WINDOW, WINDOW))
    for p in range(len(bounds)):
        sharpness[p] = 0.0
        first_row, end_row, first_col, end_col = bounds[p]
        peak, at_row, at_col = np.float64(touch_counts), -1, -1
        for row in range(first_row, end_row):
            for col in range(first_col, end_col):
                if image[row, col] > peak and not is_dead[row, col]:
                    peak, at_row, at_col = np.float64(image[row, col]), row, col
        if not (first_row < at_row < end_row - 1 and first_col < at_col < end_col - 1):
            continue
        total, pressed = 0.0, 0
        for i in range(WINDOW):
            for j in range(WINDOW):
                row, col = at_row + i - REACH, at_col + j - REACH
                variance[i, j] = -1.0  # beyond the border: nothing is known
                if first_row <= row < end_row and first_col <= col < end_col:
                    counts = float(image[row, col])
                    value = min(counts, float(COUNT_MAX)) if counts > 0.0 else 0.0
                    force[i, j] = force_of(value, force_n)
                    if not is_dead[row, col]:
                        variance[i, j] = ((force_n[int(value) + 1] - force_n[int(value)]) * noise_counts) ** 2
                    if value > touch_counts:
                        total += force[i, j]
                        pressed += 1
        live = 0
        for i in range(REACH - 1, REACH + 2):
            for j in range(REACH - 1, REACH + 2):
                live += variance[i, j] >= 0.0
        # The most pressed one is live itself.
        if pressed > MOST_PRESSED or live <= LEAST_LIVE:
            continue
        relative = 2.0 * gain_error**2 + variance[REACH, REACH] / force[REACH, REACH] ** 2
        tip = _level(level_force_n[skin_of[p], 0], total)
        blunt = _level(level_force_n[skin_of[p], 1], total)
        a, b = _middle(force, variance, force_n[0])
        of_tip, a, b = _least_misfit(force, variance, relative, force_n[0], share[skin_of[p], 0, tip], order, a, b)
        if of_tip < MISFIT:
            # From where a tip would be: otherwise chance decides which of both is searched better.
            of_blunt, _, _ = _least_misfit(
                force, variance, relative, force_n[0], share[skin_of[p], 1, blunt], order, a, b
            )
            sharpness[p] = max(0.5 * (min(of_blunt, MISFIT) - of_tip), 0.0)


@kernel
def _level(level_force_n: NDArray[np.float64], total_n: float) -> int:
    """The deepest level with no more force than that."""
    level = 0
    while level < len(level_force_n) - 1 and level_force_n[level + 1] <= total_n:
        level += 1
    return level


@kernel
def _middle(force: NDArray[np.float64], variance: NDArray[np.float64], dead_n: float) -> tuple[int, int]:
    """The place where the force has its centre."""
    total, by_row, by_col = _TINY, 0.0, 0.0
    for i in range(REACH - 1, REACH + 2):
        for j in range(REACH - 1, REACH + 2):
            if variance[i, j] >= 0.0:
                # Of what reads 0 nothing is known.
                total += force[i, j] - dead_n
                by_row += (force[i, j] - dead_n) * (i - REACH)
                by_col += (force[i, j] - dead_n) * (j - REACH)
    return _place(by_row / total), _place(by_col / total)


@kernel
def _place(taxels: float) -> int:
    """The place that is nearest to so far from the middle of a taxel."""
    return min(max(round((taxels / _FARTHEST + 1.0) * (PLACES // 2)), 0), PLACES - 1)


@kernel
def _least_misfit(
    force: NDArray[np.float64],
    variance: NDArray[np.float64],
    relative: float,
    dead_n: float,
    share: NDArray[np.float32],
    order: NDArray[np.int64],
    a: int,
    b: int,
) -> tuple[float, int, int]:
    """Chi squared at the place where a shape fits best, and that place, searched from the place `a`, `b` on."""
    least = _misfit(force, variance, relative, dead_n, share[a, b], order, math.inf)
    step = _FIRST_STEP
    while step:
        better_a, better_b = a, b
        for way in range(9):
            to_a, to_b = a + step * (way // 3 - 1), b + step * (way % 3 - 1)
            if not (0 <= to_a < PLACES and 0 <= to_b < PLACES):
                continue
            misfit = _misfit(force, variance, relative, dead_n, share[to_a, to_b], order, least)
            if misfit < least:
                least, better_a, better_b = misfit, to_a, to_b
        if (better_a, better_b) == (a, b):
            step //= 2
        a, b = better_a, better_b
    return least, a, b


@kernel
def _misfit(
    force: NDArray[np.float64],
    variance: NDArray[np.float64],
    relative: float,
    dead_n: float,
    share: NDArray[np.float32],
    order: NDArray[np.int64],
    enough: float,
) -> float:
    """Chi squared of a shape that is as strong as the middle taxel says; beyond `enough` it is not worked out.

    Infinite where the middle taxel, which is pressed, would feel nothing of the shape: a tip may be finer than the gap.
    """
    if share[REACH, REACH] <= 0.0:
        return math.inf
    strength = force[REACH, REACH] / share[REACH, REACH]
    total = 0.0
    for k in range(len(order)):
        i, j = order[k, 0], order[k, 1]
        if variance[i, j] < 0.0:
            continue
        # A taxel that reads 0 may feel as much as `dead_n`.
        expected = max(strength * share[i, j], dead_n)
        total += (force[i, j] - expected) ** 2 / (variance[i, j] + relative * expected**2 + _TINY)
        if total >= enough:
            break
    return total
