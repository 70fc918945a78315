# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sparse-representation classification (SRC) of a whole image, among the classes that a comparison ranks first.

The paper's SRC (`classification`) chooses columns out of the whole library by a pursuit. Here `image_classification`
has ranked the classes already. Columns A of the best classes, from each those that alone explain most, are fitted to
the image y by ridge regression: ``x = (A'A + r I)^-1 A'y``. The residual of class c uses its own columns only:
``|y - A_c x_c| / |y|``.

Only taxels whose sigma is small take part. The kernels know A'A of the whole library, and subtract the other taxels.

`src_residuals` is the reference implementation, `image_src_kernels` the one that runs.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_recon.objects.object_library import ObjectLibrary
from acts_recon.sparse import REGULARISATION

PROPOSED_CLASSES = 5
"""Classes that the comparison proposes."""

PROPOSED_COLUMNS = 12
"""Library columns of each of them at most."""

KNOWN_COUNTS = 200.0
"""Standard deviation up to which a taxel is a sample for SRC, which knows no uncertainty."""


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
