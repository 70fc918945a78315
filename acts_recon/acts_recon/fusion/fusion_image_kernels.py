# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What fusion shows: image, standard deviations and confidence out of its state; kernels of `fusion_kernels`."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel
from acts_recon.fusion.fusion_motion_kernels import FASTMATH
from acts_recon.fusion.fusion_state import IS_NOISE, QUIET, RESTING, TRUST, UNKNOWN_COUNTS, State, Tuning

# Lower limit of the process noise: what an untouched taxel may drift [counts/s].
IDLE_COUNTS_PER_S = 20.0
# Predictions are trusted until sums of squares of this size say otherwise [counts^2].
TRUST_PRIOR = 0.3
# A slope that no measurement has confirmed is followed in full over times well below this [s], and hardly over longer
# ones: an impact is over within a few milliseconds. It weighs as much as so many confirmed predictions of its size.
UNPROVEN_S = 1e-3
UNPROVEN_WEIGHT = 0.3
# What came true of earlier slopes counts for at most so much of what they predicted: a small one before a large one
# confirms little of it.
MOST_CONFIRMED = 2.0
# Smaller predicted changes are not shown: one step of the converter looks like a slope of nearly one count.
LEAST_CHANGE_COUNTS = 0.85
# Above this nothing is shown to have risen beyond what was measured lately: near full scale a few counts more are a
# multiple of the force.
STEEP_COUNTS = (COUNT_MAX + 1) // 2

_F = np.float32


@kernel(fastmath=FASTMATH, inline="always")
def trust(product: np.float32, square: np.float32) -> np.float32:
    """Share of what was predicted that came true, by least squares, 0 to 1."""
    share = (product + _F(TRUST_PRIOR)) / (square + _F(TRUST_PRIOR))
    return min(max(share, _F(0)), _F(1))


@kernel(fastmath=FASTMATH, inline="always")
def _trust_slope(
    product: np.float32, square: np.float32, slope_square: np.float32, change: np.float32, time: np.float32
) -> np.float32:
    """`trust` in what a slope predicts, a change over a time [s].

    Of all that was predicted only slopes confirm a slope. One more prediction, this one, has come true by the share to
    expect.
    """
    came_true = min((product + _F(TRUST_PRIOR)) / (square + _F(TRUST_PRIOR)), _F(MOST_CONFIRMED))
    weight = _F(UNPROVEN_WEIGHT) * change * change
    expected = _F(1) / (_F(1) + time * time / _F(UNPROVEN_S * UNPROVEN_S))
    return trust(slope_square * came_true + weight * expected, slope_square + weight)


@kernel(fastmath=FASTMATH, inline="always")
def _maximum_filter(state: State, values: NDArray[np.float32], cols: int) -> NDArray[np.float32]:
    """Maximum filter of 3 x 3 taxels within each patch; overwritten by the next call."""
    in_row, around = state.in_row, state.around
    # Unsigned, so that the compiler sees that no index is negative, and vectorises.
    one, width = np.uint64(1), np.uint64(cols)
    for p in range(state.patches.shape[0]):
        top, bottom = np.uint64(state.patches[p, 0]), np.uint64(state.patches[p, 1])
        left, right = np.uint64(state.patches[p, 2]), np.uint64(state.patches[p, 3])
        for row in range(top, bottom):
            first, last = row * width + left, row * width + right - one
            in_row[first] = max(values[first], values[min(first + one, last)])
            for i in range(first + one, last):
                in_row[i] = max(values[i - one], values[i], values[i + one])
            # Not `last - one` alone: before the first taxel of all there is none.
            in_row[last] = max(values[last], values[max(last, first + one) - one])
        for row in range(top, bottom):
            above = np.uint64(0) if row == top else width
            below = np.uint64(0) if row + one == bottom else width
            for i in range(row * width + left, row * width + right):
                around[i] = max(in_row[i - above], in_row[i], in_row[i + below])
    return around


@kernel(fastmath=FASTMATH, inline="always")
def _find_most(state: State, cols: int, horizon: np.float32) -> None:
    """The largest value of each patch that was measured within the horizon."""
    for p in range(state.patches.shape[0]):
        top, bottom, left, right = state.patches[p, 0], state.patches[p, 1], state.patches[p, 2], state.patches[p, 3]
        if right - left == cols:
            state.most[p] = _most_of(state, top * cols, bottom * cols, horizon)
            continue
        state.most[p] = _F(0)
        for row in range(top, bottom):
            state.most[p] = max(state.most[p], _most_of(state, row * cols + left, row * cols + right, horizon))


@kernel(fastmath=FASTMATH, inline="always")
def _most_of(state: State, first: int, end: int, horizon: np.float32) -> np.float32:
    """`_find_most` of consecutive taxels."""
    value, age, most = state.value[first:end], state.age[first:end], np.int32(0)
    # All are whole numbers; the compiler vectorises the maximum of integers only.
    for i in range(value.shape[0]):
        most = max(most, np.int32(value[i]) if age[i] < horizon else np.int32(0))
    return _F(most)


@kernel(fastmath=FASTMATH, inline="always")
def show(state: State, cols: int, tuning: Tuning) -> None:
    """Image of the estimates as far as they are trusted; where readings are noise, what untouched skin reads."""
    above, quiet, resting, tile_of = state.total, state.weight, state.before, state.tile_of
    image, value, age, low, fresh = state.image, state.value, state.age, state.low, state.fresh
    rate, estimate, learnt = state.rate, state.estimate, state.learnt
    product, square, slope_square = state.product, state.square, state.slope_square
    for i in range(image.shape[0]):
        t = tile_of[i]
        usual = state.noise[i] * learnt[t, QUIET]
        above[i] = value[i] - usual
        quiet[i] = usual if learnt[t, IS_NOISE] > _F(0) else _F(-1)
        resting[i] = state.unknown[i] * learnt[t, RESTING]
    around = _maximum_filter(state, above, cols)
    least, quiet_s, horizon = _F(LEAST_CHANGE_COUNTS), _F(tuning.quiet_s), _F(tuning.horizon_s)
    slope, fade, velocity = state.slope, state.fade, state.velocity
    _find_most(state, cols, horizon)
    for i in range(image.shape[0]):
        # Too old to be followed: of what the slope has added, only as much stays as is trusted.
        if slope[i] != _F(0) and not age[i] < horizon:
            if not velocity[tile_of[i], 2] > _F(0):
                by_slope = slope[i] * fade[i] * horizon
                share = _trust_slope(product[i], square[i], slope_square[i], by_slope, horizon)
                estimate[i] = value[i] + share * (estimate[i] - value[i])
            slope[i] = _F(0)
    for i in range(image.shape[0]):
        ahead = rate[i] * age[i] if around[i] > _F(0) else _F(0)
        change = ahead if fresh[i] else estimate[i] - value[i]
        above[i] = change if abs(change) >= least else _F(0)
        image[i] = value[i]
    for i in range(image.shape[0]):
        if above[i] != _F(0):
            if age[i] < horizon:
                by_slope = (_F(1) - velocity[tile_of[i], 2]) * slope[i] * fade[i] * age[i]
                # Of a fresh taxel the rest is motion, found in the same changes as the slope: it is in doubt with it.
                in_doubt = by_slope if fresh[i] else _F(0)
                share = _trust_slope(product[i], square[i], square[i], in_doubt, age[i])
                # What samples beside have corrected since is not the slope's.
                by_slope = min(max(by_slope, min(above[i], _F(0))), max(above[i], _F(0)))
                slope_share = _trust_slope(product[i], square[i], slope_square[i], by_slope, age[i])
                change = share * (above[i] - by_slope) + slope_share * by_slope
            else:
                change = learnt[tile_of[i], TRUST] * above[i]
            if abs(change) >= least:
                highest = max(state.most[state.patch_of[i]], value[i], _F(STEEP_COUNTS))
                # Whole counts, as readings are: with a fraction more, a taxel that reads just the threshold would be
                # pressed.
                image[i] = _F(int(min(max(value[i] + change, _F(0)), highest) + _F(0.5)))
    for i in range(image.shape[0]):
        low[i] = around[i] <= _F(0)
        is_settled = (image[i] <= quiet[i]) | ((age[i] < quiet_s) & (quiet[i] >= _F(0)))
        image[i] = resting[i] if low[i] & is_settled & (not fresh[i]) else image[i]
        above[i], quiet[i] = _F(0), _F(0)


@kernel(fastmath=FASTMATH, inline="always")
def update_sigma(state: State, cols: int, tuning: Tuning) -> None:
    """Sigma of every taxel from measurement noise, drift, process noise over its age, and the scales.

    What moves beside a taxel may have come to it since it was measured. So half of its process noise is the maximum of
    the 3 x 3 taxels around it.
    """
    around = _maximum_filter(state, state.process_noise, cols)
    for p in range(state.patches.shape[0]):
        top, bottom, left, right = state.patches[p, 0], state.patches[p, 1], state.patches[p, 2], state.patches[p, 3]
        scale = _F(math.exp(state.log_scale[p])) * state.frame_scale[p]
        if right - left == cols:
            _update_sigma_of(state, around, top * cols, bottom * cols, scale, tuning)
            continue
        for row in range(top, bottom):
            _update_sigma_of(state, around, row * cols + left, row * cols + right, scale, tuning)


@kernel(fastmath=FASTMATH, inline="always")
def _update_sigma_of(
    state: State, around: NDArray[np.float32], first: int, end: int, scale: np.float32, tuning: Tuning
) -> None:
    """`update_sigma` of consecutive taxels."""
    idle, horizon = _F(IDLE_COUNTS_PER_S), _F(tuning.horizon_s)
    noise = state.noise[first:end]
    limit = _F(UNKNOWN_COUNTS)
    process_noise, sigma = state.process_noise[first:end], state.sigma[first:end]
    ages, around = state.age[first:end], around[first:end]
    for i in range(sigma.shape[0]):
        age = ages[i]
        q = _F(0.5) * (process_noise[i] + around[i])
        time = min(age, horizon)
        idled = idle * min(age, _F(1e3))
        variance = noise[i] * noise[i] + idled * idled + scale * q * time * time
        sigma[i] = min(_F(math.sqrt(variance)), limit)


@kernel(fastmath=FASTMATH)
def confidence(sigma: NDArray[np.float32], half_counts: float, out: NDArray[np.uint8]) -> None:
    """Write ``255 / (1 + (sigma / half_counts)^2)``, rounded."""
    for i in range(sigma.shape[0]):
        ratio = sigma[i] / _F(half_counts)
        out[i] = np.uint8(_F(255) / (_F(1) + ratio * ratio) + _F(0.5))
