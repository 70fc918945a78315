# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which object presses: sparse representation-based classification (SRC) on the samples of one frame.

FastOMP (`acts_recon.sparse`) chooses few columns A of a library of known objects, restricted to the measured taxels, so
that ``y = A x`` for the samples y. The residual of class c uses its own columns only: ``|y - A_c x_c| / |y|``. The
object is the class with the smallest residual. This is the paper's method ("Sparse Recovery and Tactile
Reconstruction", Fig. 4F and 9) with the details of the published analysis: a quarter as many columns as samples (two on
the board), columns not re-normalised after the measured rows are picked.

`classify` is the reference implementation, in double precision; `Classifier` runs `classification_kernels`, the same in
single precision and without allocation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, TOUCH_COUNTS, ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.settings import setting, validate
from acts_recon.images import PlacedSamples
from acts_recon.objects import classification_kernels as kernels
from acts_recon.objects.object_library import ObjectLibrary
from acts_recon.sparse import SPARSITY_RATIO, Problems, in_blocks, sparsity

BOARD_COLUMNS = 2
"""Library columns that FastOMP may choose on the board, as in the published sketch."""


@dataclass(frozen=True)
class ClassifierConfig:
    """Settings of the classification; the defaults are the paper's."""

    touch_counts: int = setting(
        TOUCH_COUNTS, "counts above which a taxel is pressed; others are 0", minimum=0, maximum=COUNT_MAX
    )
    max_columns: int = setting(
        0, "library columns that explain a frame at most; 0: a quarter as many as samples", minimum=0, maximum=1024
    )

    def __post_init__(self) -> None:
        validate(self)

    def columns_for(self, m: int, library: ObjectLibrary) -> int:
        """Columns for a frame of `m` samples: never more than there are."""
        wanted = min(self.max_columns, m) if self.max_columns else sparsity(m, SPARSITY_RATIO)
        return min(wanted, library.n_columns)


@dataclass(frozen=True)
class Classification:
    """Which object presses.

    Attributes
    ----------
    touched : bool
        Whether any sample was pressed; else there is no object.
    best : int
        Class of the smallest residual, the first of equal ones; 0 without touch.
    residuals : np.ndarray [shape=(n_classes,), dtype=float]
        Norm of the residual of each class relative to that of the samples: 0 explained, 1 not at all; 1 for all
        without touch.
    confidence : float
        ``1 - smallest / second smallest residual``: 0 undecided, 1 sure. 0 without touch, and where there is one class.
    """

    touched: bool
    best: int
    residuals: NDArray[np.floating]
    confidence: float


class Classifier:
    """Classifies frame after frame without allocating; everything is compiled before the first one.

    Parameters
    ----------
    library : ObjectLibrary
    config : ClassifierConfig
    """

    def __init__(self, library: ObjectLibrary, config: ClassifierConfig | None = None) -> None:
        self.library = library
        self.config = config or ClassifierConfig()
        taxels = library.rows * library.cols
        self._model = kernels.Model(
            in_blocks(library.columns), np.ascontiguousarray(library.columns.T), library.classes
        )
        columns = self.config.columns_for(taxels, library)
        self._problems = Problems.empty(1, taxels, columns)
        self._samples = PlacedSamples(ArrayGeometry(library.rows, library.cols), None)
        self._residuals = np.ones(library.n_classes, dtype=np.float32)
        # Compile, or load from the cache, what the first frame would otherwise wait seconds for.
        first = np.zeros(1, dtype=np.uint16)
        self.step(first, np.full(1, COUNT_MAX, dtype=np.uint16))

    def step(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> Classification:
        """Classify one frame.

        Parameters
        ----------
        indices : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices, none twice; at least one.
        counts : np.ndarray [shape=(m,), dtype=uint16]
            What was measured there, 0 to 1023.

        Returns
        -------
        Classification
            Its `residuals` are overwritten by the next frame: copy what is to be kept.

        Raises
        ------
        ArrayError
            When the frame does not fit the array or holds impossible values. Everything is left as it was.
        """
        taxels = self.library.rows * self.library.cols
        if np.size(indices) > taxels:
            raise ArrayError(f"{np.size(indices)} indices: needed are 1 to {taxels} of them")
        indices, counts = self._samples.of(indices, counts)
        touched = kernels.class_residuals(
            self._model,
            indices,
            counts,
            self.config.touch_counts,
            self.config.columns_for(indices.size, self.library),
            self._problems,
            self._residuals,
        )
        if not touched:
            return Classification(False, 0, self._residuals, 0.0)
        best, confidence = kernels.decide(self._residuals)
        return Classification(True, best, self._residuals, confidence)
