# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Classification of images in numba, with memory and without allocation; `image_classification` says how it works."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.objects.classification_kernels import by_class
from acts_recon.sparse import FASTMATH

_ROUNDS = 40
"""Rounds of coordinate descent for the non-negative least squares; it stops earlier once nothing changes."""

_SETTLED = np.float32(1e-4)
_TINY = np.float32(1e-12)


@kernel(fastmath=FASTMATH, inline="always")
def _mixture_explains(
    dense: NDArray[np.float32],
    norms_counts: NDArray[np.float32],
    mixed: NDArray[np.int64],
    n: int,
    square: float,
    force_weight: float,
    weight: NDArray[np.float32],
    dot: NDArray[np.float32],
    gram: NDArray[np.float32],
    share: NDArray[np.float32],
) -> float:
    """Squared norm of the weighted image that `n` patterns explain by non-negative least squares.

    Less the penalty of its force; see `acts_recon.objects.image_classification`.
    """
    taxels = weight.shape[0]
    for i in range(n):
        share[i] = np.float32(0.0)
        for j in range(i + 1):
            total = np.float32(0.0)
            a, b = dense[mixed[i]], dense[mixed[j]]
            for t in range(taxels):
                total += weight[t] * a[t] * b[t]
            gram[i, j] = total
            gram[j, i] = total
    for _ in range(_ROUNDS):
        moved = np.float32(0.0)
        largest = np.float32(0.0)
        for i in range(n):
            if gram[i, i] <= _TINY:
                continue
            pull = dot[mixed[i]]
            for j in range(n):
                if j != i:
                    pull -= gram[i, j] * share[j]
            new = max(pull / gram[i, i], np.float32(0.0))
            moved = max(moved, abs(new - share[i]))
            largest = max(largest, new)
            share[i] = new
        if moved <= _SETTLED * largest:
            break
    explained = np.float32(0.0)
    force = np.float32(0.0)
    for i in range(n):
        force += share[i] / norms_counts[mixed[i]]
        explained += np.float32(2.0) * share[i] * dot[mixed[i]]
        for j in range(n):
            explained -= share[i] * share[j] * gram[i, j]
    if force <= _TINY:
        return 0.0
    return float(explained - square * np.float32(force_weight * np.log(force)) ** 2)


@kernel(fastmath=FASTMATH)
def class_residuals(
    dense: NDArray[np.float32],
    column_first: NDArray[np.int64],
    taxel: NDArray[np.int32],
    first: NDArray[np.int64],
    value: NDArray[np.float32],
    norms_counts: NDArray[np.float32],
    classes: NDArray[np.int64],
    class_first: NDArray[np.int64],
    class_patterns: NDArray[np.int64],
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    touch_counts: float,
    noise_counts: float,
    relative_error: float,
    force_weight: float,
    kept: float,
    refined: int,
    mixing: int,
    weight: NDArray[np.float32],
    weighted: NDArray[np.float32],
    near_weight: NDArray[np.float32],
    near_weighted: NDArray[np.float32],
    dot: NDArray[np.float32],
    explained: NDArray[np.float32],
    best: NDArray[np.float32],
    mixed: NDArray[np.int64],
    gram: NDArray[np.float32],
    share: NDArray[np.float32],
    left: NDArray[np.float64],
    energy: NDArray[np.float64],
    residuals: NDArray[np.float32],
) -> bool:
    """Write the residuals of every class, averaged over this image and those before; return whether something presses.

    First come the arrays of `Model`, then the image, the settings, and the arrays of `State`.
    """
    noise = np.float32(noise_counts) ** 2
    error = np.float32(relative_error) ** 2
    square = np.float32(0.0)
    for t in range(image.shape[0]):
        x = image[t] if image[t] > touch_counts else np.float32(0.0)
        weight[t] = np.float32(1.0) / (noise + error * x * x + sigma[t] * sigma[t])
        weighted[t] = weight[t] * x
        square += weighted[t] * x
    n_classes = residuals.shape[0]
    energy[0] *= kept
    for number in range(n_classes):
        left[number] *= kept
        residuals[number] = np.float32(1.0)
        best[number] = np.float32(0.0)
    if square <= 0:
        return False
    n_columns = column_first.shape[0] - 1
    levels = classes.shape[0] // n_columns
    for column in range(n_columns):
        # All levels of a column press the first so many of its taxels: gathered once, the sums run along memory.
        begin = column_first[column]
        for e in range(column_first[column + 1] - begin):
            near_weight[e] = weight[taxel[begin + e]]
            near_weighted[e] = weighted[taxel[begin + e]]
        for p in range(column * levels, (column + 1) * levels):
            with_image = np.float32(0.0)
            norm = np.float32(0.0)
            at = first[p]
            for e in range(first[p + 1] - at):
                with_image += value[at + e] * near_weighted[e]
                norm += value[at + e] * value[at + e] * near_weight[e]
            dot[p] = with_image
            explained[p] = np.float32(0.0)
            if with_image > 0 and norm > _TINY:
                against = np.float32(force_weight * np.log(with_image / (norm * norms_counts[p]))) ** 2
                explained[p] = max(with_image * with_image / norm - square * against, np.float32(0.0))
            best[classes[p]] = max(best[classes[p]], explained[p])
    for number in range(n_classes):
        better = 0
        for other in range(n_classes):
            if best[other] > best[number] or (best[other] == best[number] and other < number):
                better += 1
        of_class = best[number]
        if better < refined:
            n = 0
            for _ in range(min(mixing, class_first[number + 1] - class_first[number])):
                chosen = -1
                for q in range(class_first[number], class_first[number + 1]):
                    p = class_patterns[q]
                    taken = False
                    for j in range(n):
                        taken = taken or mixed[j] == p
                    if not taken and (chosen < 0 or explained[p] > explained[chosen]):
                        chosen = p
                mixed[n] = chosen
                n += 1
            of_class = max(
                of_class,
                _mixture_explains(dense, norms_counts, mixed, n, square, force_weight, weight, dot, gram, share),
            )
        left[number] += max(square - of_class, np.float32(0.0))
    energy[0] += square
    for number in range(n_classes):
        residuals[number] = np.sqrt(left[number] / energy[0])
    return True


@kernel(fastmath=FASTMATH)
def weigh(residuals: NDArray[np.float32], others: NDArray[np.float32], weight: float) -> None:
    """Write the geometric mean of two classifiers' residuals, the other's weighted, into `residuals`.

    Of a geometric mean neither classifier can outvote what the other excludes.
    """
    for number in range(residuals.shape[0]):
        product = np.float64(residuals[number]) * np.float64(others[number]) ** weight
        residuals[number] = np.float32(product ** (1.0 / (1.0 + weight)))


class Model:
    """A library's patterns as `class_residuals` reads them.

    Parameters
    ----------
    patterns : np.ndarray [shape=(n_columns * n_levels, taxels), dtype=float32]
        All levels of a column follow one another. Of two taxels that one of them presses, the one pressed harder is
        pressed at every level at which the other is.
    norms_counts : np.ndarray [shape=(n_columns * n_levels,), dtype=float32]
    classes : np.ndarray [shape=(n_columns * n_levels,), dtype=int64]
    n_levels, n_classes : int
    """

    def __init__(
        self,
        patterns: NDArray[np.float32],
        norms_counts: NDArray[np.float32],
        classes: NDArray[np.int64],
        n_levels: int,
        n_classes: int,
    ) -> None:
        self.dense = np.ascontiguousarray(patterns)
        column_first, first, taxel, value = [0], [0], [], []
        for column in self.dense.reshape(-1, n_levels, self.dense.shape[1]):
            # What is pressed at the deepest cut comes first.
            order = np.argsort(-(column > 0).sum(axis=0), kind="stable")
            for pattern in column[:, order]:
                pressed = int(np.count_nonzero(pattern))
                value.append(pattern[:pressed])
                first.append(first[-1] + pressed)
            most = int((column > 0).any(axis=0).sum())
            taxel.append(order[:most])
            column_first.append(column_first[-1] + most)
        self.column_first = np.array(column_first, dtype=np.int64)
        self.taxel = np.concatenate(taxel).astype(np.int32)
        self.first = np.array(first, dtype=np.int64)
        self.value = np.concatenate(value)
        self.norms_counts = norms_counts
        self.classes = classes
        self.class_first, self.class_patterns = by_class(classes, n_classes)

    def arrays(self) -> tuple[NDArray, ...]:
        """The arrays in the order in which `class_residuals` takes them."""
        return (
            self.dense,
            self.column_first,
            self.taxel,
            self.first,
            self.value,
            self.norms_counts,
            self.classes,
            self.class_first,
            self.class_patterns,
        )


class State:
    """Buffers and memory of `class_residuals`.

    Parameters
    ----------
    n_taxels, n_patterns, n_classes : int
    """

    def __init__(self, n_taxels: int, n_patterns: int, n_classes: int) -> None:
        def floats(*shape: int) -> NDArray[np.float32]:
            return np.zeros(shape, dtype=np.float32)

        self.weight = floats(n_taxels)
        self.weighted = floats(n_taxels)
        self.near_weight = floats(n_taxels)
        self.near_weighted = floats(n_taxels)
        self.dot = floats(n_patterns)
        self.explained = floats(n_patterns)
        self.best = floats(n_classes)
        self.mixed = np.zeros(n_patterns, dtype=np.int64)
        side = min(n_patterns, 64)
        self.gram = floats(side, side)
        self.share = floats(side)
        self.left = np.zeros(n_classes)
        self.energy = np.zeros(1)
        self.residuals = np.ones(n_classes, dtype=np.float32)

    def arrays(self) -> tuple[NDArray, ...]:
        """The arrays in the order in which `class_residuals` takes them."""
        return (
            self.weight,
            self.weighted,
            self.near_weight,
            self.near_weighted,
            self.dot,
            self.explained,
            self.best,
            self.mixed,
            self.gram,
            self.share,
            self.left,
            self.energy,
            self.residuals,
        )
