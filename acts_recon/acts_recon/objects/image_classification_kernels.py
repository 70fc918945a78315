# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Classification of images in numba, with memory and without allocation; `image_classification` says how it works."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.objects.classification_kernels import by_class
from acts_recon.sparse import FASTMATH

_ROUNDS = 40
"""Rounds of coordinate descent for the non-negative least squares; it stops earlier once nothing changes."""

_SETTLED = np.float32(1e-4)
_TINY = np.float32(1e-12)


class Model(NamedTuple):
    """A library's patterns as `class_residuals` reads them.

    Attributes
    ----------
    dense : np.ndarray [shape=(n_patterns, n_taxels), dtype=float32]
        All levels of a column follow one another.
    column_first : np.ndarray [shape=(n_columns + 1,), dtype=int64]
        Where the taxels of each column begin in `taxel`, and their end.
    taxel : np.ndarray [dtype=int32]
        Which taxels a column presses, the one first that is pressed at most of its levels.
    first : np.ndarray [shape=(n_patterns + 1,), dtype=int64]
        Where the values of each pattern begin in `value`, and their end.
    value : np.ndarray [dtype=float32]
        What a pattern presses, on the first so many taxels of its column.
    norms_counts : np.ndarray [shape=(n_patterns,), dtype=float32]
    classes : np.ndarray [shape=(n_patterns,), dtype=int64]
    class_first, class_patterns : np.ndarray [dtype=int64]
        The patterns class by class, see `by_class`.
    """

    dense: NDArray[np.float32]
    column_first: NDArray[np.int64]
    taxel: NDArray[np.int32]
    first: NDArray[np.int64]
    value: NDArray[np.float32]
    norms_counts: NDArray[np.float32]
    classes: NDArray[np.int64]
    class_first: NDArray[np.int64]
    class_patterns: NDArray[np.int64]

    @classmethod
    def of(
        cls,
        patterns: NDArray[np.float32],
        norms_counts: NDArray[np.float32],
        classes: NDArray[np.int64],
        n_levels: int,
        n_classes: int,
    ) -> Model:
        """Of the columns of a library at several levels.

        Parameters
        ----------
        patterns : np.ndarray [shape=(n_columns * n_levels, n_taxels), dtype=float32]
            All levels of a column follow one another. Of two taxels that one of them presses, the one pressed harder is
            pressed at every level at which the other is.
        norms_counts : np.ndarray [shape=(n_columns * n_levels,), dtype=float32]
        classes : np.ndarray [shape=(n_columns * n_levels,), dtype=int64]
        n_levels, n_classes : int
        """
        dense = np.ascontiguousarray(patterns)
        column_first, first, taxel, value = [0], [0], [], []
        for column in dense.reshape(-1, n_levels, dense.shape[1]):
            # What is pressed at the deepest cut comes first.
            order = np.argsort(-(column > 0).sum(axis=0), kind="stable")
            for pattern in column[:, order]:
                pressed = int(np.count_nonzero(pattern))
                value.append(pattern[:pressed])
                first.append(first[-1] + pressed)
            most = int((column > 0).any(axis=0).sum())
            taxel.append(order[:most])
            column_first.append(column_first[-1] + most)
        class_first, class_patterns = by_class(classes, n_classes)
        return cls(
            dense=dense,
            column_first=np.array(column_first, dtype=np.int64),
            taxel=np.concatenate(taxel).astype(np.int32),
            first=np.array(first, dtype=np.int64),
            value=np.concatenate(value),
            norms_counts=norms_counts,
            classes=classes,
            class_first=class_first,
            class_patterns=class_patterns,
        )


class Settings(NamedTuple):
    """Settings of `class_residuals`; `acts_recon.objects.image_classification` has the formulae.

    Attributes
    ----------
    touch_counts, noise_counts, relative_error : float
        As in `acts_recon.objects.image_classification.ImageClassifierConfig`.
    force_weight : float
        Scale of the penalty of a force.
    refined, mixing : int
        How many classes may mix their patterns, and how many patterns each of them.
    """

    touch_counts: float
    noise_counts: float
    relative_error: float
    force_weight: float
    refined: int
    mixing: int


class State(NamedTuple):
    """Buffers and memory of `class_residuals`.

    Attributes
    ----------
    weight, weighted : np.ndarray [shape=(n_taxels,), dtype=float32]
        Squared weight w^2 of each taxel, and the image times that.
    near_weight, near_weighted : np.ndarray [shape=(n_taxels,), dtype=float32]
        The same on the taxels of one column.
    dot, explained : np.ndarray [shape=(n_patterns,), dtype=float32]
        Weighted inner product of image and pattern, and what the pattern alone explains of the image.
    best : np.ndarray [shape=(n_classes,), dtype=float32]
        What the best pattern of a class alone explains.
    mixed : np.ndarray [shape=(n_patterns,), dtype=int64]
        Patterns that a class mixes.
    gram : np.ndarray [shape=(side, side), dtype=float32]
    share : np.ndarray [shape=(side,), dtype=float32]
        Their weighted inner products, and their coefficients.
    left : np.ndarray [shape=(n_classes,), dtype=float64]
    energy : np.ndarray [shape=(1,), dtype=float64]
        Memory: what each class has left unexplained, and the energy of the images; both fade.
    residuals : np.ndarray [shape=(n_classes,), dtype=float32]
        Result.
    """

    weight: NDArray[np.float32]
    weighted: NDArray[np.float32]
    near_weight: NDArray[np.float32]
    near_weighted: NDArray[np.float32]
    dot: NDArray[np.float32]
    explained: NDArray[np.float32]
    best: NDArray[np.float32]
    mixed: NDArray[np.int64]
    gram: NDArray[np.float32]
    share: NDArray[np.float32]
    left: NDArray[np.float64]
    energy: NDArray[np.float64]
    residuals: NDArray[np.float32]

    @classmethod
    def empty(cls, n_taxels: int, n_patterns: int, n_classes: int) -> State:
        """At the start."""

        def floats(*shape: int) -> NDArray[np.float32]:
            return np.zeros(shape, dtype=np.float32)

        side = min(n_patterns, 64)
        return cls(
            weight=floats(n_taxels),
            weighted=floats(n_taxels),
            near_weight=floats(n_taxels),
            near_weighted=floats(n_taxels),
            dot=floats(n_patterns),
            explained=floats(n_patterns),
            best=floats(n_classes),
            mixed=np.zeros(n_patterns, dtype=np.int64),
            gram=floats(side, side),
            share=floats(side),
            left=np.zeros(n_classes),
            energy=np.zeros(1),
            residuals=np.ones(n_classes, dtype=np.float32),
        )


@kernel(fastmath=FASTMATH, inline="always")
def _weigh_taxels(
    image: NDArray[np.float32], sigma: NDArray[np.float32], settings: Settings, state: State
) -> np.float32:
    """Write the weight of every taxel; returns the squared norm of the weighted image."""
    weight, weighted = state.weight, state.weighted
    noise = np.float32(settings.noise_counts) ** 2
    error = np.float32(settings.relative_error) ** 2
    square = np.float32(0.0)
    for t in range(image.shape[0]):
        x = image[t] if image[t] > settings.touch_counts else np.float32(0.0)
        weight[t] = np.float32(1.0) / (noise + error * x * x + sigma[t] * sigma[t])
        weighted[t] = weight[t] * x
        square += weighted[t] * x
    return square


@kernel(fastmath=FASTMATH, inline="always")
def _compare_patterns(square: np.float32, force_weight: float, model: Model, state: State) -> None:
    """Write what each pattern alone explains of the image, and what the best one of each class does."""
    column_first, taxel, first, value = model.column_first, model.taxel, model.first, model.value
    norms_counts, classes = model.norms_counts, model.classes
    weight, weighted, near_weight, near_weighted = state.weight, state.weighted, state.near_weight, state.near_weighted
    dot, explained, best = state.dot, state.explained, state.best
    n_columns = column_first.shape[0] - 1
    levels = classes.shape[0] // n_columns
    for number in range(best.shape[0]):
        best[number] = np.float32(0.0)
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


@kernel(fastmath=FASTMATH, inline="always")
def _choose_patterns(number: int, mixing: int, model: Model, state: State) -> int:
    """Write the patterns of a class that alone explain most into ``state.mixed``; returns how many there are."""
    explained, mixed = state.explained, state.mixed
    begin, end = model.class_first[number], model.class_first[number + 1]
    n = min(mixing, end - begin)
    for place in range(n):
        chosen = -1
        for q in range(begin, end):
            p = model.class_patterns[q]
            taken = False
            for j in range(place):
                taken = taken or mixed[j] == p
            if not taken and (chosen < 0 or explained[p] > explained[chosen]):
                chosen = p
        mixed[place] = chosen
    return n


@kernel(fastmath=FASTMATH, inline="always")
def _mixture_explains(n: int, square: np.float32, force_weight: float, model: Model, state: State) -> float:
    """Squared norm of the weighted image that the first `n` of ``state.mixed`` explain by non-negative least squares.

    Less the penalty of its force; see `acts_recon.objects.image_classification`.
    """
    dense, norms_counts = model.dense, model.norms_counts
    mixed, weight, dot, gram, share = state.mixed, state.weight, state.dot, state.gram, state.share
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
    model: Model,
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    settings: Settings,
    kept: float,
    state: State,
) -> bool:
    """Average the residual of every class over this image and those before; return whether something presses.

    Parameters
    ----------
    model : Model
    image, sigma : np.ndarray [shape=(n_taxels,), dtype=float32]
        Counts, and the standard deviation of each.
    settings : Settings
    kept : float
        What is kept of the images before.
    state : State
        Written: `residuals`, all 1 where nothing presses.
    """
    best, left, energy, residuals = state.best, state.left, state.energy, state.residuals
    n_classes = residuals.shape[0]
    square = _weigh_taxels(image, sigma, settings, state)
    energy[0] *= kept
    for number in range(n_classes):
        left[number] *= kept
        residuals[number] = np.float32(1.0)
    if square <= 0:
        return False
    _compare_patterns(square, settings.force_weight, model, state)
    for number in range(n_classes):
        better = 0
        for other in range(n_classes):
            if best[other] > best[number] or (best[other] == best[number] and other < number):
                better += 1
        of_class = best[number]
        if better < settings.refined:
            n = _choose_patterns(number, settings.mixing, model, state)
            of_class = max(of_class, _mixture_explains(n, square, settings.force_weight, model, state))
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
