# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""SRC in numba: the same as `classification_reference` in the tests, in single precision and without allocation.

Also what all classifiers share: sorting by class, and the decision.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.sparse import (
    ALLOWED,
    CHOSEN,
    FASTMATH,
    MEASURED,
    N_CHOSEN,
    ORDER,
    PRESSED,
    RESIDUAL_ROWS,
    Y_ROWS,
    Problems,
    pursue,
    solve,
)


class Model(NamedTuple):
    """A library as `class_residuals` reads it.

    Attributes
    ----------
    blocks, columns : np.ndarray
        As `acts_recon.sparse.fastomp_kernels.pursue` takes a dictionary.
    classes : np.ndarray [shape=(n_columns,), dtype=int64]
    """

    blocks: NDArray[np.float32]
    columns: NDArray[np.float32]
    classes: NDArray[np.int64]


@kernel(fastmath=FASTMATH)
def class_residuals(
    model: Model,
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    touch_counts: int,
    n_columns: int,
    problems: Problems,
    residuals: NDArray[np.float32],
) -> bool:
    """Write the residual of every class for one frame into `residuals`; return whether anything was pressed.

    The frame's indices must be in range. `problems` has room for a single one, with `n_columns` columns.
    """
    columns, classes = model.columns, model.classes
    taxels, table, rows, systems = problems.pixels, problems.table, problems.rows, problems.systems
    m = indices.shape[0]
    y, residual = rows[Y_ROWS, 0], rows[RESIDUAL_ROWS, 0]
    square = np.float32(0.0)
    pressed = 0
    for i in range(m):
        if counts[i] > touch_counts:
            taxels[0, pressed] = indices[i]
            y[pressed] = counts[i]
            square += y[pressed] * y[pressed]
            pressed += 1
    for number in range(residuals.shape[0]):
        residuals[number] = 1.0
    if pressed == 0:
        return False
    place = pressed
    for i in range(m):
        if counts[i] <= touch_counts:
            taxels[0, place] = indices[i]
            y[place] = 0.0
            place += 1
    table[MEASURED, 0] = m
    table[PRESSED, 0] = pressed
    table[ALLOWED, 0] = n_columns
    table[ORDER, 0] = 0
    pursue(model.blocks, columns, 1, problems)
    s = table[N_CHOSEN, 0]
    solve(0, s, systems)
    coefficients = systems[0, :, systems.shape[1]]
    chosen = table[CHOSEN:, 0]
    norm = np.sqrt(square)
    for i in range(s):
        number = classes[chosen[i]]
        done = False
        for j in range(i):
            done = done or classes[chosen[j]] == number
        if done:
            continue
        for p in range(m):
            residual[p] = y[p]
        for j in range(s):
            if classes[chosen[j]] == number:
                for p in range(m):
                    residual[p] -= coefficients[j] * columns[chosen[j], taxels[0, p]]
        left = np.float32(0.0)
        for p in range(m):
            left += residual[p] * residual[p]
        residuals[number] = np.sqrt(left) / norm
    return True


@kernel(fastmath=FASTMATH)
def decide(residuals: NDArray[np.float32]) -> tuple[int, float]:
    """Class of the smallest residual, the first of equal ones, and `acts_core.wire.residuals.confidence_of` all."""
    best = 0
    second = -1
    for number in range(1, residuals.shape[0]):
        if residuals[number] < residuals[best]:
            second = best
            best = number
        elif second < 0 or residuals[number] < residuals[second]:
            second = number
    if second < 0 or residuals[second] <= 0:
        return best, 0.0
    return best, 1.0 - np.float64(residuals[best]) / np.float64(residuals[second])


def by_class(classes: NDArray[np.int64], n_classes: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Sort what belongs to classes.

    Returns
    -------
    first : np.ndarray [shape=(n_classes + 1,), dtype=int64]
        Where each class begins in `members`, and its end.
    members : np.ndarray [shape=(n,), dtype=int64]
        Places in `classes`, class by class.
    """
    counts = np.bincount(classes, minlength=n_classes)
    first = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    return first, np.argsort(classes, kind="stable").astype(np.int64)
