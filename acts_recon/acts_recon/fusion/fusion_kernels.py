# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fusion of samples over time in numba: the same as `fusion_reference` in the tests, in float32 and without allocation.

`fuse` takes one frame through the steps that `fusion` explains: find the velocities, predict the image to the end of
the frame, update it by the samples, interpolate the innovations between them, and compute every taxel's sigma.
Each patch of a layout is treated by itself. Indices are made signed before a subtraction: numba keeps them unsigned.
The steps are inlined: a call counts the references of all arrays of the state, which took a fifth of a frame's time.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel
from acts_recon.fusion.fusion_image_kernels import show, trust, update_sigma
from acts_recon.fusion.fusion_motion_kernels import FASTMATH, TINY, find_velocities, moved, observe_motion
from acts_recon.fusion.fusion_state import (
    CHANGES,
    CLIPPED_CHANGE,
    EXPECTED,
    IS_NOISE,
    NUMBER,
    PRODUCT,
    QUIET,
    QUIET_SIGMAS,
    READINGS,
    RESTING,
    SQUARE,
    SUMS,
    TILE,
    TOTAL,
    TRUST,
    Memory,
    State,
    Tuning,
    state_of,
)

REACH = 2
"""Taxels so far from a sample, along rows and columns, are corrected by its innovation."""

# Gain of the exponential average of a taxel's squared prediction errors.
PROCESS_NOISE_GAIN = 0.3
# Added to the time between two measurements, so that errors over short times are not taken for fast changes [s].
SHORTEST_S = 5e-4
# Motion is not followed over less [s]: within that a float32 shows none, and the rate would be one of roundings.
LEAST_MOTION_S = 1e-5
# An innovation on a taxel that was not measured within the horizon is a new contact, assumed to be this old [s].
NEW_CONTACT_AGE_S = 3e-3
# Step of the logarithm of the scale of all variances per normalised innovation squared above 1, and its limit.
SCALE_STEP = 0.01
SCALE_LIMIT = 3.0
# The scale of one frame is a mean over its samples and so many more whose normalised innovation squared is 1.
NIS_PRIOR_SAMPLES = 4.0
# Normalised innovations squared are limited to this: a new contact says little about known ones.
OUTLIER = 25.0
# Limits of ages that are divided; the longer one stands for never [s].
SHORTEST_AGE_S = 1e-6
LONGEST_AGE_S = 1e3
# What the estimate of a taxel that was never measured has above the least sample around fades with this constant [s].
UNMEASURED_MEMORY_S = 0.010
# The correction of a taxel is halved where the weights of the samples around it sum up to this.
SPREAD_PRIOR = 0.5

# What was learnt of the noise fades with this time constant, and what was learnt of predictions with the next [s].
NOISE_MEMORY_S = 1.0
TRUST_MEMORY_S = 0.3
# Readings are noise where 0 predicts them at least so well, in squares of their changes,
ZERO_MARGIN = 1.5
# and where their changes are at most so large, in squares of those of fast measured taxels.
NOISE_MARGIN = 2.0
# Step of the logarithm of a patch's noise variance per squared innovation above the mean of normal ones; its limits.
NOISE_STEP = 0.05
NOISE_STEP_LIMIT = 1.0
NOISE_LIMIT = 6.0
# A squared innovation counts as at most this; and the mean of normal ones that are limited so.
NOISE_OUTLIER = 4.0
NOISE_MEAN = 0.92

_F = np.float32
_TOP = np.float32(COUNT_MAX)


def _weights_around() -> NDArray[np.float32]:
    """Weights of a sample's innovation for the taxels around it, row by row: ``1 / distance^5``."""
    away = np.arange(-REACH, REACH + 1, dtype=np.float32)
    square = away[:, None] ** 2 + away[None, :] ** 2
    square[REACH, REACH] = np.inf
    return np.asarray(1.0 / square**2.5, dtype=np.float32).ravel()


_SIDE = 2 * REACH + 1
_NEAR = _weights_around()

_state_of = kernel(fastmath=FASTMATH, inline="always")(state_of)


@kernel(fastmath=FASTMATH, inline="always")
def _predict(state: State, period_s: float, cols: int, tuning: Tuning) -> None:
    """Predict the image at the end of the frame: by motion, and by slopes for the share that motion does not explain.

    First all taxels by their slopes, without a branch, so that the compiler vectorises; then again those that move.
    """
    estimate, before, age, elapsed, rate = state.estimate, state.before, state.age, state.elapsed, state.rate
    period, horizon = _F(period_s), _F(tuning.horizon_s)
    fading = _F(math.exp(-period_s / tuning.damping_s))
    for i in range(estimate.shape[0]):
        before[i] = estimate[i]
        age[i] += period
        # The estimate of a measured taxel is of the time of its measurement, not of the end of the frame.
        elapsed[i] = min(age[i] if state.fresh[i] else period, horizon)
        state.fresh[i] = False
        faded = state.fade[i] * fading
        state.fade[i] = faded if faded > TINY else _F(0)
        # What can be noise has no slope worth following: in 20 ms one of 3 sigma would look like a touch.
        follows = (age[i] < horizon) & (elapsed[i] > _F(0)) & (not state.low[i])
        rate[i] = state.slope[i] * state.fade[i] if follows else _F(0)
        estimate[i] = min(max(before[i] + rate[i] * elapsed[i], _F(0)), _TOP)
    patches = state.patches
    for p in range(patches.shape[0]):
        top, bottom, left, right = patches[p, 0], patches[p, 1], patches[p, 2], patches[p, 3]
        tile_cols = patches[p, 6]
        for tile in range(patches[p, 5] * tile_cols):
            velocity = state.velocity[patches[p, 4] + tile]
            share = velocity[2]
            if not share > _F(0):
                continue
            first_row, first_col = top + tile // tile_cols * TILE, left + tile % tile_cols * TILE
            for row in range(first_row, min(first_row + TILE, bottom)):
                for col in range(first_col, min(first_col + TILE, right)):
                    i = row * cols + col
                    time = elapsed[i]
                    came = before[i]
                    if time > _F(LEAST_MOTION_S):
                        back_rows, back_cols = velocity[1] * time, velocity[0] * time
                        came = moved(before, row, col, back_rows, back_cols, top, bottom, left, right, cols)
                    change = share * (came - before[i]) + (_F(1) - share) * rate[i] * time
                    rate[i] = change / time if time > _F(0) else _F(0)
                    estimate[i] = min(max(before[i] + change, _F(0)), _TOP)


@kernel(fastmath=FASTMATH, inline="always")
def _learn(
    state: State,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    period_s: float,
    lag_step_s: float,
    tuning: Tuning,
) -> None:
    """Innovations of all samples; what they say of predictions and of the noise.

    All in one function: a call for every sample would count the references of all arrays of the state.
    """
    m = indices.shape[0]
    horizon, tile_fade = _F(tuning.horizon_s), _F(math.exp(-period_s / NOISE_MEMORY_S))
    learnt, product, square, noise_excess = state.learnt, state.product, state.square, state.noise_excess
    slope_square = state.slope_square
    for p in range(noise_excess.shape[0]):
        state.noise_scale[p] = _F(math.exp(state.log_noise[p]))
        noise_excess[p] = _F(0)
    for k in range(m):
        i = int(np.int64(indices[k]))
        p = int(np.int64(state.patch_of[i]))
        tile = state.tile_of[i]
        lag = _F(lag_step_s * (m - 1 - k))
        since = state.age[i] - lag
        count, value, noise = _F(counts[k]), state.value[i], state.noise[i]
        predicted = state.estimate[i] - state.rate[i] * lag - value
        change = count - value
        if _F(0) < since < horizon:
            innovation = change - trust(product[i], square[i]) * predicted
            fade = _F(math.exp(-since / _F(TRUST_MEMORY_S)))
            product[i] = product[i] * fade + predicted * change
            square[i] = square[i] * fade + predicted * predicted
            by_slope = (_F(1) - state.velocity[tile, 2]) * state.slope[i] * state.fade[i] * since
            slope_square[i] = slope_square[i] * fade + by_slope * by_slope
            if value > _F(0):
                expected = _F(2) * noise * noise * state.noise_scale[p]
                noise_excess[p] += min(innovation * innovation / expected, _F(NOISE_OUTLIER)) - _F(NOISE_MEAN)
        else:
            innovation = change - learnt[tile, TRUST] * predicted
            if not since < horizon:
                learnt[tile, PRODUCT] += predicted * change
                learnt[tile, SQUARE] += predicted * predicted
                product[i], square[i], slope_square[i] = _F(0), _F(0), _F(0)
        if since > _F(0) and state.low[i] and count <= _F(2) * noise * learnt[tile, QUIET]:
            learnt[tile, READINGS] += count * count
            learnt[tile, CHANGES] += change * change
            learnt[tile, EXPECTED] += noise * noise
            learnt[tile, TOTAL] += count
            learnt[tile, NUMBER] += _F(1)
        state.innovation[k], state.since[k] = innovation, since
    for p in range(noise_excess.shape[0]):
        step = min(max(_F(NOISE_STEP) * noise_excess[p], -_F(NOISE_STEP_LIMIT)), _F(NOISE_STEP_LIMIT))
        state.log_noise[p] = min(max(state.log_noise[p] + step, -_F(NOISE_LIMIT)), _F(NOISE_LIMIT))
        limit = _F(NOISE_MARGIN) * state.noise_scale[p]
        first = state.patches[p, 4]
        for t in range(first, first + state.patches[p, 5] * state.patches[p, 6]):
            for q in range(SUMS):
                faded = learnt[t, q] * tile_fade
                learnt[t, q] = faded if abs(faded) > TINY else _F(0)
            changes, expected = learnt[t, CHANGES], learnt[t, EXPECTED]
            if expected > TINY:
                learnt[t, QUIET] = _F(QUIET_SIGMAS) * _F(math.sqrt(changes / (_F(CLIPPED_CHANGE) * expected)))
            learnt[t, TRUST] = trust(learnt[t, PRODUCT], learnt[t, SQUARE])
            is_noise = learnt[t, READINGS] < _F(ZERO_MARGIN) * changes and changes < limit * expected
            learnt[t, IS_NOISE] = _F(1) if is_noise else _F(0)
            number = learnt[t, NUMBER]
            learnt[t, RESTING] = learnt[t, TOTAL] / number if number > TINY else _F(0)


@kernel(fastmath=FASTMATH, inline="always")
def _update(
    state: State, indices: NDArray[np.uint16], counts: NDArray[np.uint16], lag_step_s: float, tuning: Tuning
) -> None:
    """Update of value, slope and process noise of the taxels of all samples, and of the scales."""
    m = indices.shape[0]
    horizon = _F(tuning.horizon_s)
    scale, nis_excess, compared = state.scale, state.nis_excess, state.compared
    slopes, process_noises, rates = state.slope, state.process_noise, state.rate
    for p in range(scale.shape[0]):
        scale[p] = _F(math.exp(state.log_scale[p]))
        nis_excess[p], compared[p] = _F(0), _F(0)
    for k in range(m):
        i = int(np.int64(indices[k]))
        p = int(np.int64(state.patch_of[i]))
        noise_variance = state.noise[i] * state.noise[i]
        lag = _F(lag_step_s * (m - 1 - k))
        since = state.age[i] - lag
        count = _F(counts[k])
        is_known = _F(0) < since < horizon
        innovation = state.innovation[k]
        slope_before = slopes[i] * state.fade[i] if state.age[i] < horizon else _F(0)
        if is_known:
            # As `update_sigma` had it after the last frame, of touched taxels only: beside them it is too large.
            process_noise = _F(0.5) * (process_noises[i] + state.around[i])
            predicted_variance = process_noise * since * since
            if predicted_variance > noise_variance and count > _F(QUIET_SIGMAS) * state.noise[i]:
                ratio = innovation * innovation / (_F(2) * noise_variance + scale[p] * predicted_variance)
                nis_excess[p] += min(ratio, _F(OUTLIER)) - _F(1)
                compared[p] += _F(1)
            # By the square, as the noise of a slope: two measurements in quick succession say little of it.
            square_s = since * since
            share = square_s / (square_s + _F(tuning.slope_memory_s) * _F(tuning.slope_memory_s))
            slopes[i] += share * ((count - state.value[i]) / since - slopes[i])
        elif not since < horizon:
            slopes[i] = _F(0)
        if since > _F(0):
            error = _excess(innovation, since if since < horizon else _F(NEW_CONTACT_AGE_S), noise_variance)
            is_new_contact = error > process_noises[i] and not since < horizon
            process_noises[i] += (_F(1) if is_new_contact else _F(PROCESS_NOISE_GAIN)) * (error - process_noises[i])
        state.value[i] = count
        state.age[i] = lag
        state.fade[i] = _F(math.exp(-lag / _F(tuning.damping_s)))
        state.fresh[i] = True
        # From here on the taxel changes as its new slope says, for the share that motion does not explain.
        unexplained = _F(1) - state.velocity[state.tile_of[i], 2]
        rates[i] += unexplained * (slopes[i] * state.fade[i] - slope_before)
    for p in range(scale.shape[0]):
        log_scale = state.log_scale[p] + _F(SCALE_STEP) * nis_excess[p]
        state.log_scale[p] = min(max(log_scale, -_F(SCALE_LIMIT)), _F(SCALE_LIMIT))
        state.frame_scale[p] = max(_F(1) + nis_excess[p] / (compared[p] + _F(NIS_PRIOR_SAMPLES)), _F(1))


@kernel(fastmath=FASTMATH, inline="always")
def _excess(innovation: np.float32, since: np.float32, noise_variance: np.float32) -> np.float32:
    """Squared innovation beyond the measurement noise, per squared second since the last measurement."""
    time = since + _F(SHORTEST_S)
    return max(innovation * innovation - _F(2) * noise_variance, _F(0)) / (time * time)


@kernel(fastmath=FASTMATH, inline="always")
def _spread(
    state: State,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    period_s: float,
    cols: int,
    tuning: Tuning,
) -> None:
    """Scatter the innovations to the taxels around the samples, then correct each taxel by their weighted mean."""
    m = indices.shape[0]
    total, process_noise_total, weight = state.total, state.process_noise_total, state.weight
    estimate, process_noise, fresh = state.estimate, state.process_noise, state.fresh
    patches, patch_of, age, least = state.patches, state.patch_of, state.age, state.in_row
    least[:] = _TOP
    for k in range(m):
        i = int(np.int64(indices[k]))
        row = i // cols
        col = i - row * cols
        innovation = state.innovation[k]
        if abs(innovation) <= _F(QUIET_SIGMAS) * state.noise[i]:
            innovation = _F(0)
        own_noise, count = process_noise[i], _F(counts[k])
        # A taxel that was measured since then has seen part of the change: only the rest is missing there.
        per_s = _F(1) / min(max(state.since[k], _F(SHORTEST_AGE_S)), _F(LONGEST_AGE_S))
        p = patch_of[i]
        top, bottom, left, right = patches[p, 0], patches[p, 1], patches[p, 2], patches[p, 3]
        first, last = max(col - REACH, left), min(col + REACH + 1, right)
        for r in range(max(row - REACH, top), min(row + REACH + 1, bottom)):
            # Unsigned: the compiler need not look whether an index is negative.
            beside, place = np.uint64(r * cols + first), np.uint64((r - row + REACH) * _SIDE + first - col + REACH)
            for _ in range(last - first):
                near = _NEAR[place]
                total[beside] += near * innovation * min(min(age[beside], _F(LONGEST_AGE_S)) * per_s, _F(1))
                process_noise_total[beside] += near * own_noise
                weight[beside] += near
                least[beside] = min(least[beside], count)
                beside += np.uint64(1)
                place += np.uint64(1)
    gain, fade = _F(tuning.spread_gain), _F(1.0 - math.exp(-period_s / UNMEASURED_MEMORY_S))
    # All taxels without a branch, so that the compiler vectorises; where no weight arrived,
    # and of what was measured, nothing changes.
    for j in range(estimate.shape[0]):
        share = (_F(0) if fresh[j] else _F(1)) / (weight[j] + _F(SPREAD_PRIOR))
        estimate[j] = min(max(estimate[j] + gain * total[j] * share, _F(0)), _TOP)
        # A taxel that was never measured is known by those around it alone: it is no part of a contact that ends there.
        fading = fade * weight[j] * share if age[j] > _F(LONGEST_AGE_S) else _F(0)
        estimate[j] -= fading * max(estimate[j] - least[j], _F(0))
        learnt = (process_noise_total[j] - weight[j] * process_noise[j]) * share
        updated = process_noise[j] + _F(PROCESS_NOISE_GAIN) * learnt
        process_noise[j] = updated if updated > TINY else _F(0)
        total[j], process_noise_total[j], weight[j] = _F(0), _F(0), _F(0)
    for k in range(m):
        i = int(np.int64(indices[k]))
        estimate[i] = state.value[i]


@kernel(fastmath=FASTMATH)
def fuse(
    memory: Memory,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    period_s: float,
    duration_s: float,
    cols: int,
    tuning: Tuning,
) -> None:
    """Predict to the end of one frame and update by its samples, which `check_frame` has accepted.

    Parameters
    ----------
    memory : Memory
        Written.
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
        Samples in the order of measurement, at least one.
    period_s : float
        From the end of the last frame to the end of this one, at least 0.
    duration_s : float
        Sample k of m was taken ``duration_s * (m - 1 - k) / m`` before the end.
    cols : int
    tuning : Tuning
    """
    state = _state_of(memory)
    lag_step_s = duration_s / indices.shape[0]
    observe_motion(state, indices, counts, period_s, lag_step_s, cols, tuning)
    find_velocities(state, tuning)
    _predict(state, period_s, cols, tuning)
    _learn(state, indices, counts, period_s, lag_step_s, tuning)
    _update(state, indices, counts, lag_step_s, tuning)
    _spread(state, indices, counts, period_s, cols, tuning)
    show(state, cols, tuning)
    update_sigma(state, cols, tuning)
