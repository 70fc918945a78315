# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts_recon.slip.watch` for every patch of an image, in numba; the reference implementation is in the tests."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.images import DeadTable, fill_dead
from acts_recon.slip.motion_kernels import cut, normal_equations, solve

RESULTS = 9
"""Numbers that `watch` writes of a patch."""

HAS_MOTION, COLS, ROWS, SD_TAXELS, GAIN, GROWTH, ELAPSED_S, CUT, PACE_S = range(RESULTS)
"""Where each of them is: the motion, see `acts_recon.slip.motion.Motion`, in what time, and what `cut` says.

`PACE_S`: how long before the earlier of both images the one before it was kept; inf where there was none.
"""

# Times differ by more where a taxel was measured anew [s].
_SAME_TIME_S = 1e-5


class Memory(NamedTuple):
    """What is known of an image of (rows, cols) with so many patches, and buffers.

    Attributes
    ----------
    last, before : np.ndarray [shape=(rows, cols), dtype=float32]
        The last two measurements of each taxel [counts].
    last_s, before_s : np.ndarray [shape=(rows, cols), dtype=float64]
        Their times, -inf: none yet [s].
    now : np.ndarray [shape=(rows, cols), dtype=float32]
        The image as it stood at one moment, patch by patch.
    past : np.ndarray [shape=(kept, rows, cols), dtype=float32]
        Such images of the past, in a ring for each patch.
    past_s : np.ndarray [shape=(patches, kept), dtype=float64]
        Their moments, -inf: none [s].
    newest : np.ndarray [shape=(patches,), dtype=int64]
        Which of them is the youngest.
    matrix, inverse : np.ndarray [shape=(4, 5) and (4, 4), dtype=float64]
        For `solve`.
    is_dead : np.ndarray [shape=(rows, cols), dtype=bool]
        Taxels that are never measured, since they are broken.
    dead : DeadTable
        How these are estimated.
    """

    last: NDArray[np.float32]
    before: NDArray[np.float32]
    last_s: NDArray[np.float64]
    before_s: NDArray[np.float64]
    now: NDArray[np.float32]
    past: NDArray[np.float32]
    past_s: NDArray[np.float64]
    newest: NDArray[np.int64]
    matrix: NDArray[np.float64]
    inverse: NDArray[np.float64]
    is_dead: NDArray[np.bool_]
    dead: DeadTable


class Tuning(NamedTuple):
    """Settings for the kernel; times [s]."""

    window_s: float
    keep_s: float
    max_lag_s: float
    min_counts: float
    pressed_counts: float
    noise_counts: float
    ridge: float


@kernel
def update(time_s: float, values: NDArray[np.float32], age_s: NDArray[np.float32], memory: Memory) -> None:
    """Update the last two measurements by what was measured since the last call; forget those of an infinite age."""
    last, before, last_s, before_s = memory.last, memory.before, memory.last_s, memory.before_s
    for row in range(values.shape[0]):
        for col in range(values.shape[1]):
            measured_s = time_s - np.float64(age_s[row, col])
            if measured_s == -np.inf:
                last_s[row, col] = before_s[row, col] = -np.inf
            elif measured_s > last_s[row, col] + _SAME_TIME_S:
                before[row, col], before_s[row, col] = last[row, col], last_s[row, col]
                last[row, col], last_s[row, col] = values[row, col], measured_s


@kernel
def _bring_to_one_moment(
    time_s: float, top: int, end: int, left: int, right: int, memory: Memory, tuning: Tuning
) -> float:
    """Interpolate the patch to the time of the last measurement of a pressed taxel, into `now`; return that time."""
    last, before, last_s, before_s, now = memory.last, memory.before, memory.last_s, memory.before_s, memory.now
    moment_s = time_s
    for row in range(top, end):
        for col in range(left, right):
            if last[row, col] > tuning.pressed_counts:
                moment_s = min(moment_s, last_s[row, col])
    moment_s = max(moment_s, time_s - tuning.max_lag_s)
    for row in range(top, end):
        for col in range(left, right):
            later_s, earlier_s = last_s[row, col], before_s[row, col]
            if later_s <= moment_s or earlier_s == -np.inf:
                now[row, col] = last[row, col]
            elif earlier_s >= moment_s:
                now[row, col] = before[row, col]
            else:
                share = (moment_s - earlier_s) / (later_s - earlier_s)
                now[row, col] = before[row, col] + share * (last[row, col] - before[row, col])
    # Of the other patches, too; theirs are estimated again when they are brought to their moment.
    fill_dead(now.reshape(-1), now[0, :0], memory.dead)
    return moment_s


@kernel
def _is_known(memory: Memory, top: int, end: int, left: int, right: int) -> bool:
    """Whether each live taxel of a patch has been measured."""
    for row in range(top, end):
        for col in range(left, right):
            if memory.last_s[row, col] == -np.inf and not memory.is_dead[row, col]:
                return False
    return True


@kernel
def watch(
    time_s: float,
    bounds: NDArray[np.int64],
    counts: NDArray[np.float64],
    memory: Memory,
    tuning: Tuning,
    results: NDArray[np.float64],
) -> None:
    """Estimate the motion on every patch that is pressed.

    Parameters
    ----------
    time_s : float
        Of what `update` was given last.
    bounds : np.ndarray [shape=(patches, 4), dtype=int64]
        First and end row, first and end column of every patch, at least 3 by 3. While a live taxel of a patch has not
        been measured, nothing is estimated there: it would look as if the contact grew to one side.
    counts : np.ndarray [shape=(patches,), dtype=float64]
        Sum over each patch; with fewer than `min_counts` nothing is estimated, and the patch's past is forgotten.
    memory : Memory
        Written.
    tuning : Tuning
    results : np.ndarray [shape=(patches, RESULTS), dtype=float64]
        Written; left as it is where no pressed taxel was measured since the last call.
    """
    past, past_s, newest = memory.past, memory.past_s, memory.newest
    kept = past.shape[0]
    for p in range(bounds.shape[0]):
        top, end, left, right = bounds[p]
        if not (counts[p] >= tuning.min_counts and _is_known(memory, top, end, left, right)):
            past_s[p] = -np.inf
            results[p] = 0.0
            continue
        moment_s = _bring_to_one_moment(time_s, top, end, left, right, memory, tuning)
        youngest_s = past_s[p, newest[p]]
        if not moment_s > youngest_s:
            continue
        now = memory.now[top:end, left:right]
        reference = -1
        for k in range(kept):
            i = (newest[p] - k) % kept
            if moment_s - past_s[p, i] >= tuning.window_s:
                reference = i if past_s[p, i] > -np.inf else -1
                break
        results[p] = 0.0
        if reference >= 0:
            then = past[reference, top:end, left:right]
            squares, taxels = normal_equations(then, now, memory.is_dead[top:end, left:right], memory.matrix)
            if taxels:
                right_by, down_by, deviation, gain, growth = solve(
                    memory.matrix, memory.inverse, squares, taxels, tuning.noise_counts, tuning.ridge
                )
                results[p, HAS_MOTION] = 1.0
                results[p, COLS] = right_by
                results[p, ROWS] = down_by
                results[p, SD_TAXELS] = deviation
                results[p, GAIN] = gain
                results[p, GROWTH] = growth
                results[p, ELAPSED_S] = moment_s - past_s[p, reference]
                results[p, CUT] = cut(then, now)
                # Of the ring no more is used than a window's worth, so this is not one that came later.
                results[p, PACE_S] = past_s[p, reference] - past_s[p, (reference - 1) % kept]
        if moment_s - youngest_s >= tuning.keep_s:
            newest[p] = (newest[p] + 1) % kept
            past[newest[p], top:end, left:right] = now
            past_s[p, newest[p]] = moment_s
