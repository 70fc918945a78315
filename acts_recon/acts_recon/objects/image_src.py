"""SRC on a whole image, among the few classes that the comparison of images proposes.

The paper's SRC (`classification`) lets a pursuit choose, out of the whole library, the columns that explain
some samples together. Here the comparison (`image_classification`) has chosen already: the columns of the
classes that it ranks first, of each those that alone explain most. All of them together explain the image, by least
squares, and a class is judged, as in SRC, by what its own share leaves of the image.

So few columns need no pursuit, and nothing of the size of the image but one product with each of them: the rest is done
with the products of columns among each other, which are known beforehand. What taxels that are not known take part in
is taken off them.

`explain_among` is the plain version, `acts_recon.objects.image_src_kernels` the one that runs.
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
        What each class leaves of the image, by the comparison.
    explained : np.ndarray [shape=(n_columns,), dtype=float]
        What each column alone explains of it.
    """
    proposed = []
    for number in np.argsort(residuals, kind="stable")[:PROPOSED_CLASSES]:
        own = np.flatnonzero(library.classes == number)
        proposed.append(own[np.argsort(-explained[own], kind="stable")[:PROPOSED_COLUMNS]])
    return np.concatenate(proposed).astype(np.int64)


def explain_among(
    library: ObjectLibrary,
    proposed: NDArray[np.int64],
    image: NDArray[np.floating],
    doubt: NDArray[np.floating],
) -> NDArray[np.float64] | None:
    """What each class leaves of an image when all `proposed` columns explain it together.

    Parameters
    ----------
    library : ObjectLibrary
    proposed : np.ndarray [shape=(n,), dtype=int64]
        Columns, none twice.
    image, doubt : np.ndarray [shape=(taxels,), dtype=float]
        Counts, 0 where not pressed, and how far they may be off, a standard deviation [counts].

    Returns
    -------
    np.ndarray [shape=(n_classes,), dtype=float64] or None
        Norms relative to that of the image's known part: 0 explained, 1 not at all, or not proposed. None where nothing
        known is pressed.
    """
    known = np.asarray(doubt) <= KNOWN_COUNTS
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
