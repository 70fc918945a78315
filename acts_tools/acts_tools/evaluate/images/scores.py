# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Scores of recovered images by comparison with the truth. `docs/recovery.md` explains them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_tools.evaluate.statistics import distribution, mean

_ERROR, _SUPPORT, _COP, _TOUCH_COP, INVENTED = range(5)
FRAME_SCORES = 5
"""Number of scores that `score_image` writes."""


@kernel
def score_image(
    image: NDArray[np.float32],
    truth: NDArray[np.float32],
    live: NDArray[np.bool_],
    cols: int,
    threshold: float,
    out: NDArray[np.float64],
) -> bool:
    """Compare one image with the truth.

    Parameters
    ----------
    image, truth : np.ndarray [shape=(taxels,), dtype=float32]
        Counts.
    live : np.ndarray [shape=(taxels,), dtype=bool]
        Only these taxels are scored.
    cols : int
        Columns of the array.
    threshold : float
        A taxel above it is pressed [counts].
    out : np.ndarray [shape=(FRAME_SCORES,), dtype=float64]
        Overwritten. If the truth has a contact: relative error; support accuracy; error of the centre of pressure
        over all counts, and over pressed taxels [taxels], NaN where the image has none. Always: of the taxels at or
        below half the threshold, the share that the image shows as pressed.

    Returns
    -------
    bool
        Whether the truth has a contact.
    """
    n = 0
    agree = 0
    untouched = 0
    invented = 0
    error = 0.0
    norm = 0.0
    # Sums of weight, weight * row, weight * col: truth and image, over all counts and over pressed taxels.
    sums = np.zeros((4, 3))
    for t in range(image.size):
        if not live[t]:
            continue
        n += 1
        x = np.float64(truth[t])
        e = np.float64(image[t])
        error += (e - x) * (e - x)
        norm += x * x
        pressed, seen = x > threshold, e > threshold
        agree += 1 if pressed == seen else -1
        if x <= threshold / 2:
            untouched += 1
            invented += 1 if seen else 0
        row, col = t // cols, t % cols
        for which in range(4):
            if (which == 2 and not pressed) or (which == 3 and not seen):
                continue
            weight = e if which % 2 else x
            sums[which, 0] += weight
            sums[which, 1] += weight * row
            sums[which, 2] += weight * col
    out[INVENTED] = invented / untouched if untouched else 0.0
    if sums[2, 0] == 0.0:
        return False
    out[_ERROR] = math.sqrt(error / norm)
    out[_SUPPORT] = agree / n
    for which, place in ((0, _COP), (2, _TOUCH_COP)):
        if sums[which + 1, 0] > 0.0:
            row = sums[which, 1] / sums[which, 0] - sums[which + 1, 1] / sums[which + 1, 0]
            col = sums[which, 2] / sums[which, 0] - sums[which + 1, 2] / sums[which + 1, 0]
            out[place] = math.sqrt(row * row + col * col)
        else:
            out[place] = math.nan
    return True


class FrameScores:
    """The scores of many frames, and their summary."""

    def __init__(self) -> None:
        self._table = np.empty((256, FRAME_SCORES))
        self._n = 0

    def add(self, scores: NDArray[np.float64]) -> None:
        """Add the scores of `score_image`."""
        if self._n == len(self._table):
            self._table = np.concatenate((self._table, np.empty_like(self._table)))
        self._table[self._n] = scores
        self._n += 1

    def summary(self) -> dict[str, Any]:
        """Summary for the report; numbers are None where there is no frame."""
        table = self._table[: self._n]
        cop, touch = table[:, _COP], table[:, _TOUCH_COP]
        return {
            "frames": len(table),
            "relative_error": mean(table[:, _ERROR]),
            "support_accuracy": mean(table[:, _SUPPORT]),
            "cop_error_taxels": distribution(cop[~np.isnan(cop)]),
            "touch_cop_error_taxels": distribution(touch[~np.isnan(touch)]),
            "missed": mean(np.isnan(touch)),
            "invented_rate": mean(table[:, INVENTED]),
        }
