"""SRC in numba: the same as `acts_recon.classification.classify`, in single precision and without allocation.

And what all classifiers share: sorting by class, and deciding.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from acts_recon.fastomp_kernels import pursue
from acts_recon.fastomp_vectors import padded

_OPTIONS = {"cache": True, "nogil": True, "fastmath": {"nnan", "ninf", "nsz", "contract", "reassoc", "arcp"}}


@numba.njit(**_OPTIONS)  # type: ignore[untyped-decorator]
def class_residuals(
    blocks: NDArray[np.float32],
    columns: NDArray[np.float32],
    classes: NDArray[np.int64],
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    touch_counts: int,
    n_columns: int,
    taxels: NDArray[np.int64],
    y: NDArray[np.float32],
    residual: NDArray[np.float32],
    Q: NDArray[np.float32],
    R: NDArray[np.float32],
    chosen: NDArray[np.int64],
    coefficients: NDArray[np.float32],
    residuals: NDArray[np.float32],
) -> bool:
    """Compute what every class leaves of one frame into `residuals`; returns whether anything was pressed.

    `blocks` is the library as `acts_recon.fastomp_kernels.in_blocks` lays it out, `columns` the same with a column a
    row, then come the frame, whose indices must be in range, the settings, and the buffers of `Workspace`.
    """
    m = indices.shape[0]
    square = np.float32(0.0)
    for i in range(m):
        taxels[i] = indices[i]
        y[i] = np.float32(counts[i]) if counts[i] > touch_counts else np.float32(0.0)
        square += y[i] * y[i]
    for number in range(residuals.shape[0]):
        residuals[number] = 1.0
    if square == 0:
        return False
    s = pursue(blocks, columns, taxels, y, m, n_columns, residual, Q, R, chosen, coefficients)
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
                    residual[p] -= coefficients[j] * columns[chosen[j], taxels[p]]
        left = np.float32(0.0)
        for p in range(m):
            left += residual[p] * residual[p]
        residuals[number] = np.sqrt(left) / norm
    return True


@numba.njit(**_OPTIONS)  # type: ignore[untyped-decorator]
def decide(residuals: NDArray[np.float32]) -> tuple[int, float]:
    """Class of the smallest residual, the first of equal ones, and `acts_core.residuals.confidence_of` all."""
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


class Workspace:
    """The buffers that `class_residuals` works in, allocated once.

    Parameters
    ----------
    n_taxels : int
        Size of the array.
    n_columns : int
        Columns chosen at most.
    """

    def __init__(self, n_taxels: int, n_columns: int) -> None:
        def floats(*shape: int) -> NDArray[np.float32]:
            return np.zeros(shape, dtype=np.float32)

        self.taxels = np.zeros(n_taxels, dtype=np.int64)
        self.y = floats(padded(n_taxels))
        self.residual = floats(padded(n_taxels))
        self.Q = floats(n_columns, padded(n_taxels))
        self.R = floats(n_columns, n_columns)
        self.chosen = np.zeros(n_columns, dtype=np.int64)
        self.coefficients = floats(n_columns)

    def arrays(self) -> tuple[NDArray, ...]:
        """The buffers in the order in which `class_residuals` takes them."""
        return (self.taxels, self.y, self.residual, self.Q, self.R, self.chosen, self.coefficients)
