# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Confidence from the residuals of a classification, the same for board and host."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def confidence_of(residuals: NDArray[np.floating]) -> float:
    """How far the second smallest residual is behind the smallest: ``1 - smallest / second smallest``.

    Parameters
    ----------
    residuals : np.ndarray [shape=(n_classes,), dtype=float]
        0 or more, finite.

    Returns
    -------
    float
        0 undecided, 1 sure; 0 where there is only one residual, or both are 0.
    """
    if residuals.size < 2:
        return 0.0
    smallest, second = np.partition(residuals, 1)[:2].tolist()
    return 1.0 - smallest / second if second > 0 else 0.0
