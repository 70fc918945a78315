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


@kernel(fastmath=FASTMATH, inline="always")
def _propose(
    residuals: NDArray[np.float32],
    explained: NDArray[np.float32],
    class_first: NDArray[np.int64],
    class_columns: NDArray[np.int64],
    most_classes: int,
    most_columns: int,
    proposed: NDArray[np.int64],
) -> int:
    """Write the best columns of the best classes into `proposed`, in no order; returns how many there are."""
    n = 0
    for number in range(residuals.shape[0]):
        better = 0
        for other in range(residuals.shape[0]):
            if residuals[other] < residuals[number] or (residuals[other] == residuals[number] and other < number):
                better += 1
        if better >= most_classes:
            continue
        begin, end = class_first[number], class_first[number + 1]
        for q in range(begin, end):
            column = class_columns[q]
            ahead = 0
            if end - begin > most_columns:
                for r in range(begin, end):
                    rival = class_columns[r]
                    if explained[rival] > explained[column] or (
                        explained[rival] == explained[column] and rival < column
                    ):
                        ahead += 1
            if ahead < most_columns:
                proposed[n] = column
                n += 1
    return n


@kernel(fastmath=FASTMATH, inline="always")
def _solve(
    n: int,
    gram: NDArray[np.float64],
    pull: NDArray[np.float64],
    factor: NDArray[np.float64],
    share: NDArray[np.float64],
) -> None:
    """Solve ``(gram + REGULARISATION I) share = pull`` by Cholesky's method; only the lower half of `gram` is read."""
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
    columns: NDArray[np.float32],
    products: NDArray[np.float64],
    classes: NDArray[np.int64],
    class_first: NDArray[np.int64],
    class_columns: NDArray[np.int64],
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    compared: NDArray[np.float32],
    explained: NDArray[np.float32],
    touch_counts: float,
    known_counts: float,
    most_classes: int,
    most_columns: int,
    proposed: NDArray[np.int64],
    pressed: NDArray[np.int64],
    gram: NDArray[np.float64],
    factor: NDArray[np.float64],
    pull: NDArray[np.float64],
    share: NDArray[np.float64],
    there: NDArray[np.float64],
    residuals: NDArray[np.float32],
) -> bool:
    """Write the residual of every class into `residuals`; return whether a taxel with a small sigma is pressed.

    First come the arrays of `Model`, then the image, the results of a comparison (residual of every class, energy
    that every column alone explains), the settings, and the arrays of `Workspace`.
    """
    n_pressed = 0
    square = 0.0
    for t in range(image.shape[0]):
        if image[t] > touch_counts and sigma[t] <= known_counts:
            pressed[n_pressed] = t
            n_pressed += 1
            square += np.float64(image[t]) * np.float64(image[t])
    for number in range(residuals.shape[0]):
        residuals[number] = 1.0
    if square <= 0:
        return False
    n = _propose(compared, explained, class_first, class_columns, most_classes, most_columns, proposed)
    for i in range(n):
        column = columns[proposed[i]]
        pull[i] = 0.0
        for e in range(n_pressed):
            pull[i] += column[pressed[e]] * image[pressed[e]]
        for j in range(i + 1):
            gram[i, j] = products[proposed[i], proposed[j]]
    for t in range(image.shape[0]):
        if sigma[t] <= known_counts:
            continue
        for i in range(n):
            there[i] = columns[proposed[i], t]
        for i in range(n):
            if there[i] != 0:
                for j in range(i + 1):
                    gram[i, j] -= there[i] * there[j]
    _solve(n, gram, pull, factor, share)
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


class Model:
    """A library as `class_residuals` reads it.

    Parameters
    ----------
    library : ObjectLibrary
    """

    def __init__(self, library: ObjectLibrary) -> None:
        self.columns = np.ascontiguousarray(library.columns.T)
        exact = self.columns.astype(np.float64)
        self.products = exact @ exact.T
        self.classes = library.classes
        self.class_first, self.class_columns = by_class(library.classes, library.n_classes)

    def arrays(self) -> tuple[NDArray, ...]:
        """The arrays in the order in which `class_residuals` takes them."""
        return (self.columns, self.products, self.classes, self.class_first, self.class_columns)


class Workspace:
    """The buffers that `class_residuals` works in, allocated once.

    Parameters
    ----------
    n_taxels, n_classes : int
    most_columns : int
        Columns proposed at most.
    """

    def __init__(self, n_taxels: int, n_classes: int, most_columns: int) -> None:
        self.proposed = np.zeros(most_columns, dtype=np.int64)
        self.pressed = np.zeros(n_taxels, dtype=np.int64)
        self.gram = np.zeros((most_columns, most_columns))
        self.factor = np.zeros((most_columns, most_columns))
        self.pull = np.zeros(most_columns)
        self.share = np.zeros(most_columns)
        self.there = np.zeros(most_columns)
        self.residuals = np.ones(n_classes, dtype=np.float32)

    def arrays(self) -> tuple[NDArray, ...]:
        """The arrays in the order in which `class_residuals` takes them."""
        return (
            self.proposed,
            self.pressed,
            self.gram,
            self.factor,
            self.pull,
            self.share,
            self.there,
            self.residuals,
        )
