"""FastOMP in numba: the same as `acts_recon.fastomp`, in single precision and without allocation.

Most of the time goes into finding the atom that correlates most with a residual (`acts_recon.fastomp_choice`). All
patches of a frame choose their first atom together, then their second one, and so on: a block of the dictionary is
fetched once for all of them, and while the processor waits for one patch's numbers it computes another's.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.fastomp import REGULARISATION
from acts_recon.fastomp_choice import best_by_bounds, best_columns
from acts_recon.fastomp_model import (
    ALLOWED,
    BEST,
    CHOSEN,
    FEW,
    MANY,
    MEASURED,
    N_CHOSEN,
    ORDER,
    PRESSED,
    Q_ROWS,
    RESIDUAL_ROWS,
    Y_ROWS,
)
from acts_recon.fastomp_vectors import add_square, clear, dot, padded, subtract

OK = 0
INDEX_OUT_OF_RANGE = 1
INDEX_TWICE = 2
COUNT_OUT_OF_RANGE = 3

_REGULARISATION = np.float32(REGULARISATION)
_FASTMATH = {"nnan", "ninf", "nsz", "contract", "reassoc", "arcp"}
_padded = numba.njit(inline="always")(padded)


@kernel(fastmath=_FASTMATH)
def pursue(
    blocks: NDArray[np.float32],
    groups: NDArray[np.float32],
    numbers: NDArray[np.int32],
    bounds: NDArray[np.float32],
    few_pixels: int,
    atoms: NDArray[np.float32],
    n_problems: int,
    pixels: NDArray[np.uint32],
    table: NDArray[np.int32],
    rows: NDArray[np.float32],
    systems: NDArray[np.float32],
    lanes: NDArray[np.float32],
) -> None:
    """`acts_recon.fastomp.fast_omp` on several problems with the same dictionary, in step.

    The dictionary: as `acts_recon.fastomp_model.in_blocks` lays it out; as `Grouped`, which is used for problems of at
    most `few_pixels` pixels; and with an atom a row. Then the buffers of `acts_recon.fastomp_model.Problems`, filled in
    for the first `n_problems` of ``table[ORDER]``, whose contents are overwritten.
    """
    order, few, many, best = table[ORDER], table[FEW], table[MANY], table[BEST]
    active = n_problems
    i = 0
    while active > 0:
        # Pixels that read 0 come last and add nothing to the first correlations, which leave them out.
        counts = table[PRESSED if i == 0 else MEASURED]
        residuals = rows[Y_ROWS if i == 0 else RESIDUAL_ROWS]
        n_few = n_many = 0
        for k in range(active):
            problem = order[k]
            few[n_few] = problem
            many[n_many] = problem
            if counts[problem] <= few_pixels:
                n_few += 1
            else:
                n_many += 1
        best_by_bounds(groups, numbers, bounds, pixels, residuals, counts, few, n_few, lanes, best)
        best_columns(blocks, pixels, residuals, counts, many, n_many, lanes, best)
        # Values are fetched in one loop and computed with in the next: a vector has to wait for elements just written.
        active = _take_atoms(i, active, atoms, pixels, table, rows, systems)
        active = _use_atoms(i, active, table, rows, systems)
        i += 1


# A call with arrays costs as much as a patch of few pixels: the loops over problems are in the functions below.


@kernel(fastmath=_FASTMATH)
def _take_atoms(
    i: int,
    active: int,
    atoms: NDArray[np.float32],
    pixels: NDArray[np.uint32],
    table: NDArray[np.int32],
    rows: NDArray[np.float32],
    systems: NDArray[np.float32],
) -> int:
    """Fetch the measured pixels of the atoms that were chosen; keep and count the problems that have to go on."""
    n = rows.shape[1]
    last = systems.shape[1]
    going_on = 0
    for k in range(active):
        problem = table[ORDER, k]
        best = table[BEST, problem]
        table[N_CHOSEN, problem] = i
        if best < 0:
            continue
        table[N_CHOSEN, problem] = i + 1
        table[CHOSEN + i, problem] = best
        atom = np.uint32(best)
        m = table[MEASURED, problem]
        if i == 0:
            # Nothing to orthogonalise. Most patches of a fully pressed skin have few pixels and need no other atom.
            square = np.float32(0.0)
            projection = np.float32(0.0)
            for p in range(m):
                value = atoms[atom, pixels[problem, p]]
                square += value * value
                projection += value * rows[Y_ROWS, problem, p]
            systems[problem, 0, 0] = square + _REGULARISATION
            systems[problem, 0, last] = projection
            if table[ALLOWED, problem] == 1:
                continue
        clear(rows, (Q_ROWS + i) * n + problem, _padded(m))
        for p in range(m):
            rows[Q_ROWS + i, problem, p] = atoms[atom, pixels[problem, p]]
        table[ORDER, going_on] = problem
        going_on += 1
    return going_on


@kernel(fastmath=_FASTMATH)
def _use_atoms(
    i: int, active: int, table: NDArray[np.int32], rows: NDArray[np.float32], systems: NDArray[np.float32]
) -> int:
    """Make the `i`-th atoms orthogonal to those before and take what they explain off the residuals.

    Keeps and counts the problems that are allowed another atom.
    """
    n = rows.shape[1]
    last = systems.shape[1]
    going_on = 0
    for k in range(active):
        problem = table[ORDER, k]
        length = _padded(table[MEASURED, problem])
        y, residual, new = Y_ROWS * n + problem, RESIDUAL_ROWS * n + problem, (Q_ROWS + i) * n + problem
        if i > 0:
            for j in range(i):
                old = (Q_ROWS + j) * n + problem
                systems[problem, j, i] = dot(rows, old, rows, new, length)
                subtract(rows, new, new, systems[problem, j, i] / systems[problem, j, j], old, length)
            systems[problem, i, i] = dot(rows, new, rows, new, length) + _REGULARISATION
            systems[problem, i, last] = dot(rows, new, rows, y, length)
        if i + 1 < table[ALLOWED, problem]:
            before = residual if i > 0 else y
            share = dot(rows, new, rows, before, length) / systems[problem, i, i]
            subtract(rows, residual, before, share, new, length)
            table[ORDER, going_on] = problem
            going_on += 1
    return going_on


@kernel(fastmath=_FASTMATH)
def solve(problem: int, s: int, systems: NDArray[np.float32]) -> None:
    """From projections onto `s` orthogonalised atoms to the coefficients of the atoms, both in the last column."""
    last = systems.shape[1]
    for i in range(s - 1, -1, -1):
        value = systems[problem, i, last]
        for j in range(i + 1, s):
            value -= systems[problem, i, j] * systems[problem, j, last]
        systems[problem, i, last] = value / systems[problem, i, i]


@kernel(fastmath=_FASTMATH)
def recover_image(
    blocks: NDArray[np.float32],
    groups: NDArray[np.float32],
    numbers: NDArray[np.int32],
    bounds: NDArray[np.float32],
    few_pixels: int,
    atoms: NDArray[np.float32],
    corners: NDArray[np.uint32],
    holders: NDArray[np.uint32],
    share: NDArray[np.float32],
    side: int,
    stride: int,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    touch_counts: int,
    count_max: int,
    ratio: float,
    keep_measured: bool,
    seen: NDArray[np.bool_],
    pixels: NDArray[np.uint32],
    table: NDArray[np.int32],
    rows: NDArray[np.float32],
    systems: NDArray[np.float32],
    lanes: NDArray[np.float32],
    image: NDArray[np.float32],
) -> int:
    """Check one frame and recover its image into `image`.

    First what `acts_recon.fastomp_model.PatchModel` is made of, then the frame, the settings, and the buffers of
    `acts_recon.fastomp_model.Workspace`. `image` is flat. Values are clipped to 0 to `count_max`.
    Returns a code; unless it is `OK` the image is left as it was.
    """
    size = image.shape[0]
    m = indices.shape[0]
    code = OK
    checked = 0
    for i in range(m):
        if indices[i] >= size:
            code = INDEX_OUT_OF_RANGE
        elif counts[i] > count_max:
            code = COUNT_OUT_OF_RANGE
        elif seen[indices[i]]:
            code = INDEX_TWICE
        if code != OK:
            break
        seen[indices[i]] = True
        checked += 1
    for i in range(checked):
        seen[indices[i]] = False
    if code != OK:
        return code

    n_patches = corners.shape[0]
    measured, pressed, order, y = table[MEASURED], table[PRESSED], table[ORDER], rows[Y_ROWS]
    for patch in range(n_patches):
        measured[patch] = 0
    _hand_out(True, touch_counts, indices, counts, holders, measured, pixels, y)
    n_pressed = 0
    for patch in range(n_patches):
        pressed[patch] = measured[patch]
        order[n_pressed] = patch
        n_pressed += pressed[patch] > 0
    _hand_out(False, touch_counts, indices, counts, holders, measured, pixels, y)
    for patch in range(n_patches):
        table[ALLOWED, patch] = max(1, int(ratio * measured[patch] + 0.5))
    pursue(blocks, groups, numbers, bounds, few_pixels, atoms, n_pressed, pixels, table, rows, systems, lanes)

    for t in range(size):
        image[t] = 0.0
    for patch in range(n_patches):
        if pressed[patch] == 0:
            continue
        s = table[N_CHOSEN, patch]
        solve(patch, s, systems)
        for j in range(s):
            coefficient = systems[patch, j, systems.shape[1]]
            add_square(image, corners[patch], stride, coefficient, atoms, table[CHOSEN + j, patch], side)
    top = np.float32(count_max)
    for t in range(size):
        image[t] = min(max(image[t] * share[t], np.float32(0.0)), top)
    if keep_measured:
        for i in range(m):
            image[indices[i]] = np.float32(counts[i]) if counts[i] > touch_counts else np.float32(0.0)
    return OK


@kernel(fastmath=_FASTMATH)
def _hand_out(
    pressed: bool,
    touch_counts: int,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    holders: NDArray[np.uint32],
    measured: NDArray[np.int32],
    pixels: NDArray[np.uint32],
    y: NDArray[np.float32],
) -> None:
    """Give the samples of the pressed taxels, or those of the others, to the patches that hold them."""
    for i in range(indices.shape[0]):
        if (counts[i] > touch_counts) != pressed:
            continue
        value = np.float32(counts[i]) if pressed else np.float32(0.0)
        taxel = indices[i]
        for holder in range(holders[taxel, 0]):
            patch = holders[taxel, 1 + 2 * holder]
            place = measured[patch]
            pixels[patch, place] = holders[taxel, 2 + 2 * holder]
            y[patch, place] = value
            measured[patch] = place + 1
