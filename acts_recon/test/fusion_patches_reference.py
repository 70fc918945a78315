# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference implementation of the fusion on a skin with borders: one `FusionReference` for each patch."""

from __future__ import annotations

import numpy as np
from fusion_reference import Floats, FusionReference, lags
from numpy.typing import NDArray

from acts_recon.fusion.fusion_state import Tuning
from acts_recon.images import Borders


class PatchesReference:
    """A skin with borders: one `FusionReference` for each of its rectangles.

    Parameters
    ----------
    rows, cols : int
    borders : Borders
    tuning : Tuning
    noise : float
    is_known : bool, optional
        As of `FusionReference`.
    """

    def __init__(
        self, rows: int, cols: int, borders: Borders, tuning: Tuning, noise: float, *, is_known: bool = False
    ) -> None:
        self._shape = (rows, cols)
        self._rectangles = borders.rectangles.tolist()
        self.parts = [
            FusionReference(r1 - r0, c1 - c0, tuning, noise, is_known=is_known) for r0, r1, c0, c1 in self._rectangles
        ]

    def step(
        self, indices: NDArray[np.integer], counts: NDArray[np.integer], period_s: float, duration_s: float
    ) -> None:
        """As `FusionReference.step`, every sample for the rectangle that holds it."""
        lag = lags(indices.size, duration_s)
        row, col = np.unravel_index(indices.astype(np.intp), self._shape)
        for part, (r0, r1, c0, c1) in zip(self.parts, self._rectangles, strict=True):
            own = (row >= r0) & (row < r1) & (col >= c0) & (col < c1)
            part.update((row[own] - r0) * (c1 - c0) + col[own] - c0, counts[own], lag[own], period_s)

    def forget(self) -> None:
        """See `FusionReference.forget`."""
        for part in self.parts:
            part.forget()

    def round_to_single(self) -> None:
        """See `FusionReference.round_to_single`."""
        for part in self.parts:
            part.round_to_single()

    def field(self, name: str) -> Floats:
        """One of the arrays of `FusionReference`, of the whole skin."""
        whole = np.zeros(self._shape)
        for part, (r0, r1, c0, c1) in zip(self.parts, self._rectangles, strict=True):
            whole[r0:r1, c0:c1] = getattr(part, name)
        return whole
