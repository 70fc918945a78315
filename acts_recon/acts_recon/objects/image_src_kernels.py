# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sparse-representation classification (SRC) of a whole image, among the classes that a comparison ranks first.

The paper's SRC (`classification`) chooses columns out of the whole library by a pursuit. Here `image_classification`
has ranked the classes already. Columns A of the best classes, from each those that alone explain most, are fitted to
the image y by ridge regression: ``x = (A'A + r I)^-1 A'y``. The residual of class c uses its own columns only:
``|y - A_c x_c| / |y|``.

Only taxels whose sigma is small take part. The kernels know A'A of the whole library, and subtract the other taxels.
They allocate nothing; the tests compare them with `src_residuals` in `classification_reference`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.objects.classification_kernels import by_class
from acts_recon.objects.object_library import ObjectLibrary
from acts_recon.sparse import FASTMATH, REGULARISATION

PROPOSED_CLASSES = 5
"""Classes that the comparison proposes."""

PROPOSED_COLUMNS = 12
"""Library columns of each of them at most."""

KNOWN_COUNTS = 200.0
"""Standard deviation up to which a taxel is a sample for SRC, which knows no uncertainty."""


class Model(NamedTuple):
    """A library as `class_residuals` reads it.

    Attributes
    ----------
    columns : np.ndarray [shape=(n_columns, n_taxels), dtype=float32]
    products : np.ndarray [shape=(n_columns, n_columns), dtype=float64]
        Inner products of the columns.
    classes : np.ndarray [shape=(n_columns,), dtype=int64]
    class_first, class_columns : np.ndarray [dtype=int64]
        The columns class by class, see `by_class`.
    """

    columns: NDArray[np.float32]
    products: NDArray[np.float64]
    classes: NDArray[np.int64]
    class_first: NDArray[np.int64]
    class_columns: NDArray[np.int64]

    @classmethod
    def of(cls, library: ObjectLibrary) -> Model:
        """Of a library."""
        columns = np.ascontiguousarray(library.columns.T)
        exact = columns.astype(np.float64)
        return cls(columns, exact @ exact.T, library.classes, *by_class(library.classes, library.n_classes))


class Workspace(NamedTuple):
    """The buffers of `class_residuals`; n is the number of columns proposed at most.

    Attributes
    ----------
    proposed : np.ndarray [shape=(n,), dtype=int64]
        Columns that take part.
    pressed : np.ndarray [shape=(n_taxels,), dtype=int64]
        Samples that are pressed.
    gram, factor : np.ndarray [shape=(n, n), dtype=float64]
        A'A of the proposed columns over the samples, and its Cholesky factor.
    pull, share, there : np.ndarray [shape=(n,), dtype=float64]
        A'y, the coefficients x, and the columns at one taxel.
    residuals : np.ndarray [shape=(n_classes,), dtype=float32]
        Result.
    """

    proposed: NDArray[np.int64]
    pressed: NDArray[np.int64]
    gram: NDArray[np.float64]
    factor: NDArray[np.float64]
    pull: NDArray[np.float64]
    share: NDArray[np.float64]
    there: NDArray[np.float64]
    residuals: NDArray[np.float32]

    @classmethod
    def empty(cls, n_taxels: int, n_classes: int) -> Workspace:
        """For images of so many taxels."""
        n = PROPOSED_CLASSES * PROPOSED_COLUMNS
        return cls(
            proposed=np.zeros(n, dtype=np.int64),
            pressed=np.zeros(n_taxels, dtype=np.int64),
            gram=np.zeros((n, n)),
            factor=np.zeros((n, n)),
            pull=np.zeros(n),
            share=np.zeros(n),
            there=np.zeros(n),
            residuals=np.ones(n_classes, dtype=np.float32),
        )


@kernel(fastmath=FASTMATH, inline="always")
def _propose(
    residuals: NDArray[np.float32], explained: NDArray[np.float32], model: Model, proposed: NDArray[np.int64]
) -> int:
    """Write the best columns of the best classes into `proposed`, in no order; returns how many there are."""
    class_first, class_columns = model.class_first, model.class_columns
    n = 0
    for number in range(residuals.shape[0]):
        better = 0
        for other in range(residuals.shape[0]):
            if residuals[other] < residuals[number] or (residuals[other] == residuals[number] and other < number):
                better += 1
        if better >= PROPOSED_CLASSES:
            continue
        begin, end = class_first[number], class_first[number + 1]
        for q in range(begin, end):
            column = class_columns[q]
            ahead = 0
            if end - begin > PROPOSED_COLUMNS:
                for r in range(begin, end):
                    rival = class_columns[r]
                    if explained[rival] > explained[column] or (
                        explained[rival] == explained[column] and rival < column
                    ):
                        ahead += 1
            if ahead < PROPOSED_COLUMNS:
                proposed[n] = column
                n += 1
    return n


@kernel(fastmath=FASTMATH, inline="always")
def _normal_equations(
    n: int,
    n_pressed: int,
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    model: Model,
    work: Workspace,
) -> None:
    """Write A'A and A'y of the `n` proposed columns, on the taxels whose sigma is small."""
    columns, products, proposed, pressed = model.columns, model.products, work.proposed, work.pressed
    gram, pull, there = work.gram, work.pull, work.there
    for i in range(n):
        column = columns[proposed[i]]
        pull[i] = 0.0
        for e in range(n_pressed):
            pull[i] += column[pressed[e]] * image[pressed[e]]
        for j in range(i + 1):
            gram[i, j] = products[proposed[i], proposed[j]]
    for t in range(image.shape[0]):
        if sigma[t] <= KNOWN_COUNTS:
            continue
        for i in range(n):
            there[i] = columns[proposed[i], t]
        for i in range(n):
            if there[i] != 0:
                for j in range(i + 1):
                    gram[i, j] -= there[i] * there[j]


@kernel(fastmath=FASTMATH, inline="always")
def _solve(n: int, work: Workspace) -> None:
    """Solve ``(gram + REGULARISATION I) share = pull`` by Cholesky's method; only the lower half of `gram` is read."""
    gram, factor, pull, share = work.gram, work.factor, work.pull, work.share
    for i in range(n):
        for j in range(i + 1):
            total = gram[i, j] + (REGULARISATION if i == j else 0.0)
            for k in range(j):
                total -= factor[i, k] * factor[j, k]
            # The regularisation keeps the diagonal above 0; rounding errors are far below it.
            factor[i, j] = np.sqrt(max(total, 0.5 * REGULARISATION)) if i == j else total / factor[j, j]
    for i in range(n):
        total = pull[i]
        for k in range(i):
            total -= factor[i, k] * share[k]
        share[i] = total / factor[i, i]
    for i in range(n - 1, -1, -1):
        total = share[i]
        for k in range(i + 1, n):
            total -= factor[k, i] * share[k]
        share[i] = total / factor[i, i]


@kernel(fastmath=FASTMATH)
def class_residuals(
    model: Model,
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    compared: NDArray[np.float32],
    explained: NDArray[np.float32],
    touch_counts: float,
    work: Workspace,
) -> bool:
    """Write the residual of every class into `work.residuals`; return whether a taxel with a small sigma is pressed.

    Parameters
    ----------
    model : Model
    image, sigma : np.ndarray [shape=(n_taxels,), dtype=float32]
        Counts, and the standard deviation of each.
    compared : np.ndarray [shape=(n_classes,), dtype=float32]
        Residual of every class by a comparison.
    explained : np.ndarray [shape=(n_columns,), dtype=float32]
        Energy of the image that every column alone explains.
    touch_counts : float
        Counts above which a taxel is pressed.
    work : Workspace
    """
    classes, proposed, pressed, residuals = model.classes, work.proposed, work.pressed, work.residuals
    gram, pull, share = work.gram, work.pull, work.share
    n_pressed = 0
    square = 0.0
    for t in range(image.shape[0]):
        if image[t] > touch_counts and sigma[t] <= KNOWN_COUNTS:
            pressed[n_pressed] = t
            n_pressed += 1
            square += np.float64(image[t]) * np.float64(image[t])
    for number in range(residuals.shape[0]):
        residuals[number] = 1.0
    if square <= 0:
        return False
    n = _propose(compared, explained, model, proposed)
    _normal_equations(n, n_pressed, image, sigma, model, work)
    _solve(n, work)
    for i in range(n):
        # Columns of a class follow one another: the first of them sums for all.
        number = classes[proposed[i]]
        if i > 0 and classes[proposed[i - 1]] == number:
            continue
        left = square
        for j in range(i, n):
            if classes[proposed[j]] != number:
                break
            left += share[j] * (share[j] * gram[j, j] - 2.0 * pull[j])
            for k in range(i, j):
                left += 2.0 * share[j] * share[k] * gram[j, k]
        residuals[number] = np.sqrt(max(left, 0.0) / square)
    return True
