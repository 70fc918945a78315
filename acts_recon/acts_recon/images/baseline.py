# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Raw counts less the baseline of their taxels, without allocation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, check_untouched
from acts_core.kernels import as_compiled, kernel
from acts_recon.images.frame_check import require_rows


@kernel
def _subtract(
    indices: NDArray[np.uint16], counts: NDArray[np.uint16], baseline: NDArray[np.float32], result: NDArray[np.uint16]
) -> None:
    for i in range(counts.shape[0]):
        # What does not fit is left for the reconstructor to refuse.
        if i < indices.shape[0] and indices[i] < baseline.shape[0] and counts[i] <= COUNT_MAX:
            less = np.float32(counts[i]) - baseline[indices[i]] + np.float32(0.5)
            result[i] = np.uint16(less) if less > 0 else np.uint16(0)
        else:
            result[i] = counts[i]


class BaselineSubtraction:
    """Subtracts a baseline from one frame after another; from none while there is no baseline.

    Parameters
    ----------
    size : int
        Number of taxels.
    """

    def __init__(self, size: int) -> None:
        self._baseline = np.zeros(size, dtype=np.float32)
        self._result = np.zeros(size, dtype=np.uint16)
        self.is_set = False
        """Whether there is a baseline."""
        one = np.zeros(1, dtype=np.uint16)
        _subtract(one, one, self._baseline, self._result)

    def set(self, baseline: NDArray[np.float32], valid: NDArray[np.bool_]) -> NDArray[np.float32]:
        """Take over a baseline; nothing is subtracted where it is not valid, and where it is nowhere there is none.

        Parameters
        ----------
        baseline : np.ndarray [shape=(size,), dtype=float32]
            Counts.
        valid : np.ndarray [shape=(size,), dtype=bool]

        Returns
        -------
        np.ndarray [shape=(size,), dtype=float32]
            By how much the baseline of each taxel has changed [counts].

        Raises
        ------
        ArrayError
            See `acts_core.array.check_untouched`.
        """
        check_untouched("baseline", baseline, valid, self._baseline.size)
        # Put in place as a whole: a frame may be worked on by another thread.
        before, self._baseline = self._baseline, np.where(valid, baseline, np.float32(0.0)).astype(np.float32)
        self.is_set = bool(valid.any())
        return self._baseline - before

    def are_above(self, counts: NDArray[np.uint16], threshold: int) -> NDArray[np.bool_]:
        """Which taxels are above a threshold where these are the raw counts of all, in the order of their indices."""
        return np.floor(counts - self._baseline + np.float32(0.5)) > threshold

    def apply(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> NDArray[np.uint16]:
        """Counts less the baseline, rounded, at least 0; overwritten by the next call.

        Parameters
        ----------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Samples of one frame. Samples that do not fit the array come back as they are.

        Raises
        ------
        ArrayError
            When these are not two rows of uint16.
        """
        require_rows(indices, counts)
        m = counts.shape[0]
        if not self.is_set:
            return counts
        # A frame with more samples than there are taxels has some several times.
        result = self._result[:m] if m <= self._result.size else np.empty(m, dtype=np.uint16)
        _subtract(as_compiled(indices), as_compiled(counts), self._baseline, result)
        return result
