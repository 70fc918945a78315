# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""FastOMP in numba: the same as `acts_recon.sparse.fastomp`, in single precision and without allocation.

Most of the time goes into finding the atom that correlates most with a residual. All patches of a frame choose their
first atom together, then their second one, and so on: a block of the dictionary is fetched once for all of them.

All are inlined into those that call them; sums in any order would else differ in the last digits between processes
(docs/development.md, Rules).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.sparse.fastomp import REGULARISATION
from acts_recon.sparse.fastomp_model import (
    ALLOWED,
    BEST,
    BLOCK,
    CHOSEN,
    MEASURED,
    N_CHOSEN,
    ORDER,
    PRESSED,
    Q_ROWS,
    RESIDUAL_ROWS,
    Y_ROWS,
    PatchModel,
    Problems,
)

_REGULARISATION = np.float32(REGULARISATION)
FASTMATH = {"nnan", "ninf", "nsz", "contract", "reassoc", "arcp"}
"""What LLVM may do with floats: above all take sums in another order. All values are finite."""


@kernel(fastmath=FASTMATH, inline="always")
def pursue(
    blocks: NDArray[np.float32],
    atoms: NDArray[np.float32],
    n_problems: int,
    problems: Problems,
) -> None:
    """`acts_recon.sparse.fastomp.fast_omp` on several problems with the same dictionary, in step.

    The dictionary: as `fastomp_model.in_blocks` lays it out, and with an atom a row. The problems are filled in for the
    first `n_problems` of ``table[ORDER]``, whose contents are overwritten.
    """
    pixels, table, rows = problems.pixels, problems.table, problems.rows
    active = n_problems
    i = 0
    while active > 0:
        # Pixels that read 0 come last and add nothing to the first correlations, which leave them out.
        counts = table[PRESSED if i == 0 else MEASURED]
        residuals = rows[Y_ROWS if i == 0 else RESIDUAL_ROWS]
        choose(blocks, pixels, residuals, counts, table[ORDER], active, problems.sums, problems.largest, table[BEST])
        active = _project(i, active, atoms, pixels, table, rows, problems.systems)
        i += 1


@kernel(fastmath=FASTMATH, inline="always")
def choose(
    blocks: NDArray[np.float32],
    pixels: NDArray[np.uint32],
    residuals: NDArray[np.float32],
    counts: NDArray[np.int32],
    problems: NDArray[np.int32],
    n: int,
    sums: NDArray[np.float32],
    largest: NDArray[np.float32],
    best: NDArray[np.int32],
) -> None:
    """Find the atom whose correlation with the residual is largest in magnitude, for each of `n` problems.

    Written to `best`: the first of equally good atoms, -1 where all correlations are 0; and its size to `largest`.
    """
    for k in range(n):
        best[problems[k]] = -1
        largest[problems[k]] = 0.0
    for b in range(blocks.shape[0]):
        for k in range(n):
            problem = problems[k]
            _correlate(blocks, b, pixels, residuals, problem, counts[problem], sums)
            top = _largest(sums)
            if top > largest[problem]:
                largest[problem] = top
                column = 0
                while abs(sums[column]) < top:
                    column += 1
                best[problem] = b * BLOCK + column


@kernel(fastmath=FASTMATH, inline="always")
def _correlate(
    blocks: NDArray[np.float32],
    block: int,
    pixels: NDArray[np.uint32],
    residuals: NDArray[np.float32],
    problem: int,
    m: int,
    sums: NDArray[np.float32],
) -> None:
    """Correlate a residual with the atoms of a block; four pixels at a time, so that sums are fetched less often.

    (Whole arrays with indices: a slice would be counted as a new reference in every call.)
    """
    for column in range(BLOCK):
        sums[column] = 0.0
    p = 0
    while p + 4 <= m:
        a, b, c, d = pixels[problem, p], pixels[problem, p + 1], pixels[problem, p + 2], pixels[problem, p + 3]
        at_a, at_b = residuals[problem, p], residuals[problem, p + 1]
        at_c, at_d = residuals[problem, p + 2], residuals[problem, p + 3]
        for column in range(BLOCK):
            first = at_a * blocks[block, a, column] + at_b * blocks[block, b, column]
            sums[column] += first + at_c * blocks[block, c, column] + at_d * blocks[block, d, column]
        p += 4
    while p < m:
        a, at_a = pixels[problem, p], residuals[problem, p]
        for column in range(BLOCK):
            sums[column] += at_a * blocks[block, a, column]
        p += 1


@kernel(fastmath=FASTMATH, inline="always")
def _largest(sums: NDArray[np.float32]) -> np.float32:
    """The largest magnitude. Eight maxima, for each comparison waits for the one before it."""
    a = b = c = d = e = f = g = h = np.float32(0.0)
    for column in range(0, BLOCK, 8):
        a = max(a, abs(sums[column]))
        b = max(b, abs(sums[column + 1]))
        c = max(c, abs(sums[column + 2]))
        d = max(d, abs(sums[column + 3]))
        e = max(e, abs(sums[column + 4]))
        f = max(f, abs(sums[column + 5]))
        g = max(g, abs(sums[column + 6]))
        h = max(h, abs(sums[column + 7]))
    return max(max(max(a, b), max(c, d)), max(max(e, f), max(g, h)))


@kernel(fastmath=FASTMATH, inline="always")
def _dot(x: NDArray[np.float32], y: NDArray[np.float32], m: int) -> np.float32:
    """Inner product of the first `m` elements."""
    total = np.float32(0.0)
    for p in range(m):
        total += x[p] * y[p]
    return total


@kernel(fastmath=FASTMATH, inline="always")
def _project(
    i: int,
    active: int,
    atoms: NDArray[np.float32],
    pixels: NDArray[np.uint32],
    table: NDArray[np.int32],
    rows: NDArray[np.float32],
    systems: NDArray[np.float32],
) -> int:
    """Make the `i`-th atoms orthogonal to those before, and take the projections on them off the residuals.

    Keeps and counts the problems that are allowed another atom.
    """
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
        m = table[MEASURED, problem]
        atom, places, new = atoms[np.uint32(best)], pixels[problem], rows[Q_ROWS + i, problem]
        for p in range(m):
            new[p] = atom[places[p]]
        system = systems[problem]
        for j in range(i):
            old = rows[Q_ROWS + j, problem]
            system[j, i] = _dot(old, new, m)
            share = system[j, i] / system[j, j]
            for p in range(m):
                new[p] -= share * old[p]
        y, residual = rows[Y_ROWS, problem], rows[RESIDUAL_ROWS, problem]
        system[i, i] = _dot(new, new, m) + _REGULARISATION
        system[i, last] = _dot(new, y, m)
        if i + 1 < table[ALLOWED, problem]:
            before = residual if i > 0 else y
            share = _dot(new, before, m) / system[i, i]
            for p in range(m):
                residual[p] = before[p] - share * new[p]
            table[ORDER, going_on] = problem
            going_on += 1
    return going_on


@kernel(fastmath=FASTMATH, inline="always")
def solve(problem: int, s: int, systems: NDArray[np.float32]) -> None:
    """Back substitution: from projections on `s` orthogonalised atoms to coefficients, both in the last column."""
    last = systems.shape[1]
    for i in range(s - 1, -1, -1):
        value = systems[problem, i, last]
        for j in range(i + 1, s):
            value -= systems[problem, i, j] * systems[problem, j, last]
        systems[problem, i, last] = value / systems[problem, i, i]


@kernel(fastmath=FASTMATH)
def recover_image(
    model: PatchModel,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    touch_counts: int,
    count_max: int,
    ratio: float,
    keep_measured: bool,
    problems: Problems,
    image: NDArray[np.float32],
) -> None:
    """Recover the image of one frame, which `acts_recon.images.PlacedSamples` has accepted, into `image`.

    `problems` is of `acts_recon.sparse.fastomp_model.workspace`, with the same `ratio` of atoms per measured taxel.
    `image` is flat. Values are clipped to 0 to `count_max`.
    """
    atoms, corners, holders, side = model.atoms, model.corners, model.holders, model.side
    pixels, table, rows, systems = problems.pixels, problems.table, problems.rows, problems.systems
    size = image.shape[0]
    m = indices.shape[0]
    n_patches = corners.shape[0]
    measured, pressed, order, y = table[MEASURED], table[PRESSED], table[ORDER], rows[Y_ROWS]
    for patch in range(n_patches):
        measured[patch] = 0
    _scatter(True, touch_counts, indices, counts, holders, measured, pixels, y)
    n_pressed = 0
    for patch in range(n_patches):
        pressed[patch] = measured[patch]
        order[n_pressed] = patch
        n_pressed += pressed[patch] > 0
    _scatter(False, touch_counts, indices, counts, holders, measured, pixels, y)
    for patch in range(n_patches):
        table[ALLOWED, patch] = max(1, int(ratio * measured[patch] + 0.5))
    pursue(model.blocks, atoms, n_pressed, problems)

    for t in range(size):
        image[t] = 0.0
    for patch in range(n_patches):
        if pressed[patch] == 0:
            continue
        s = table[N_CHOSEN, patch]
        solve(patch, s, systems)
        for j in range(s):
            coefficient = systems[patch, j, systems.shape[1]]
            atom = atoms[np.uint32(table[CHOSEN + j, patch])]
            for row in range(side):
                first = int(corners[patch]) + row * model.stride
                line, part = image[first : first + side], atom[row * side : (row + 1) * side]
                for column in range(side):
                    line[column] += coefficient * part[column]
    top = np.float32(count_max)
    for t in range(size):
        image[t] = min(max(image[t] * model.share[t], np.float32(0.0)), top)
    if keep_measured:
        for i in range(m):
            image[indices[i]] = np.float32(counts[i]) if counts[i] > touch_counts else np.float32(0.0)


@kernel(fastmath=FASTMATH, inline="always")
def _scatter(
    pressed: bool,
    touch_counts: int,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    holders: NDArray[np.uint32],
    measured: NDArray[np.int32],
    pixels: NDArray[np.uint32],
    y: NDArray[np.float32],
) -> None:
    """Scatter the samples of the pressed taxels, or those of the others, to the patches that hold them."""
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
