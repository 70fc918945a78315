# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference implementations of the classifiers of `acts_recon.objects`: NumPy, in double precision."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from acts_core.skin import Response
from acts_core.wire import confidence_of
from acts_recon.objects import Classification, ClassifierConfig, ImageClassifierConfig, ObjectLibrary
from acts_recon.objects.image_classification import (
    LEVELS,
    MIXED_COLUMNS,
    REFINED_CLASSES,
    shallower_patterns,
    src_weight,
)
from acts_recon.objects.image_src_kernels import KNOWN_COUNTS, PROPOSED_CLASSES, PROPOSED_COLUMNS
from acts_recon.sparse import REGULARISATION, fast_omp


def classify(
    library: ObjectLibrary, indices: NDArray[np.integer], counts: NDArray[np.integer], config: ClassifierConfig
) -> Classification:
    """Classify the samples of one frame."""
    y = np.where(counts > config.touch_counts, counts, 0).astype(np.float64)
    residuals = np.ones(library.n_classes)
    if not y.any():
        return Classification(False, 0, residuals, 0.0)
    A = library.columns[indices].astype(np.float64)
    chosen, coefficients = fast_omp(A, y, config.columns_for(y.size, library))
    for number in np.unique(library.classes[chosen]):
        own = library.classes[chosen] == number
        residuals[number] = np.linalg.norm(y - A[:, chosen[own]] @ coefficients[own]) / np.linalg.norm(y)
    return Classification(True, int(np.argmin(residuals)), residuals, confidence_of(residuals))


def classify_image(
    library: ObjectLibrary,
    image: NDArray[np.floating],
    sigma: NDArray[np.floating],
    config: ImageClassifierConfig | None = None,
    response: Response | None = None,
) -> Classification:
    """Classify one image of a skin at rest, without earlier images; see `ImageClassifier.step`."""
    config = config or ImageClassifierConfig()
    patterns, norms_counts, classes = shallower_patterns(library, response)
    x = np.asarray(image, dtype=np.float64).ravel()
    x = np.where(x > config.touch_counts, x, 0.0)
    residuals = np.ones(library.n_classes)
    if not x.any():
        return Classification(False, 0, residuals, 0.0)
    spread = np.asarray(sigma, dtype=np.float64).ravel()
    root = 1 / np.sqrt(config.noise_counts**2 + (config.relative_error * x) ** 2 + spread**2)
    y, A = root * x, root[:, None] * patterns.T.astype(np.float64)
    square = y @ y
    dots, norms = y @ A, np.einsum("ij,ij->j", A, A)
    left = np.full(library.n_classes, square)
    # What each pattern alone explains of the image, less the penalty of its force.
    explained = np.zeros(classes.size)
    for p in np.flatnonzero((dots > 0) & (norms > 0)):
        force = dots[p] / norms[p] / norms_counts[p]
        explained[p] = max(dots[p] ** 2 / norms[p] - square * force_penalty(force, config), 0.0)
    best = np.array([explained[classes == number].max() for number in range(library.n_classes)])
    left -= best
    for number in np.argsort(-best, kind="stable")[:REFINED_CLASSES]:
        own = np.flatnonzero(classes == number)
        mixed = own[np.argsort(-explained[own], kind="stable")[:MIXED_COLUMNS]]
        shares, unexplained = nnls(A[:, mixed], y)
        force = float((shares / norms_counts[mixed]).sum())
        if force > 0:
            left[number] = min(left[number], unexplained**2 + square * force_penalty(force, config))
    residuals = np.sqrt(np.maximum(left, 0) / square)
    src = src_residuals(library, proposed_columns(library, residuals, explained[:: len(LEVELS)]), x, spread)
    if src is not None:
        weight = src_weight(0.0, config)
        residuals = (residuals * src**weight) ** (1 / (1 + weight))
    return Classification(True, int(np.argmin(residuals)), residuals, confidence_of(residuals))


def force_penalty(force: float, config: ImageClassifierConfig) -> float:
    """Penalty of a force that differs from the library's, relative to the image's squared norm.

    ``(relative_error / force_error * log(force))^2``

    Parameters
    ----------
    force : float
        Of the image in relation to the pattern as it was pressed; above 0.
    config : ImageClassifierConfig
    """
    return (config.relative_error / config.force_error * math.log(force)) ** 2


def proposed_columns(
    library: ObjectLibrary, residuals: NDArray[np.floating], explained: NDArray[np.floating]
) -> NDArray[np.int64]:
    """Columns of the classes that a comparison ranks first.

    Parameters
    ----------
    library : ObjectLibrary
    residuals : np.ndarray [shape=(n_classes,), dtype=float]
        Residual of each class, by the comparison.
    explained : np.ndarray [shape=(n_columns,), dtype=float]
        Energy of the image's projection on each column alone.
    """
    proposed = []
    for number in np.argsort(residuals, kind="stable")[:PROPOSED_CLASSES]:
        own = np.flatnonzero(library.classes == number)
        proposed.append(own[np.argsort(-explained[own], kind="stable")[:PROPOSED_COLUMNS]])
    return np.concatenate(proposed).astype(np.int64)


def src_residuals(
    library: ObjectLibrary,
    proposed: NDArray[np.int64],
    image: NDArray[np.floating],
    sigma: NDArray[np.floating],
) -> NDArray[np.float64] | None:
    """Residual of each class, where all `proposed` columns are fitted to the image together.

    Parameters
    ----------
    library : ObjectLibrary
    proposed : np.ndarray [shape=(n,), dtype=int64]
        Columns, none twice.
    image, sigma : np.ndarray [shape=(taxels,), dtype=float]
        Counts, 0 where not pressed, and their standard deviation [counts].

    Returns
    -------
    np.ndarray [shape=(n_classes,), dtype=float64] or None
        Norms relative to that of the image: 0 explained, 1 not at all or not proposed. None where no taxel with a small
        sigma is pressed.
    """
    known = np.asarray(sigma) <= KNOWN_COUNTS
    y = np.asarray(image, dtype=np.float64)[known]
    if not y.any():
        return None
    A = library.columns[known][:, proposed].astype(np.float64)
    shares = np.linalg.solve(A.T @ A + REGULARISATION * np.eye(proposed.size), A.T @ y)
    residuals = np.ones(library.n_classes)
    for number in np.unique(library.classes[proposed]):
        own = library.classes[proposed] == number
        residuals[number] = np.linalg.norm(y - A[:, own] @ shares[own]) / np.linalg.norm(y)
    return residuals
