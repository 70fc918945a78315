# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Random taxels, the same as the board draws."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.sampling.basis import CommonSettings, Measure, Pcg32, Samples, SamplingScheme, SkinMap

RANDOM_STREAM = 1
"""PCG32 stream that draws random taxels; the virtual board's noise has another."""


_NONE = np.empty(0, dtype=np.uint16)


class RandomTaxels(SamplingScheme):
    """Draws distinct taxels, frame after frame (the first steps of a Fisher-Yates shuffle that is never undone)."""

    name = "random"
    number = 2
    description = "M random taxels, drawn on the board"

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        super().__init__(config, skin_map)
        self._taxels = np.arange(config.rows * config.cols, dtype=np.uint16)
        self._random = Pcg32(config.seed, RANDOM_STREAM)

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        return self.measured(measure, self.draw(self.config.m))

    def draw(self, m: int, *, measured: NDArray[np.uint16] = _NONE) -> NDArray[np.uint16]:
        """`m` distinct taxel indices, none of those in `measured`; shape (m,), uint16."""
        taxels = self._taxels
        # Those that are not to be drawn go to the front, in their order, where the shuffle begins behind them.
        for i, index in enumerate(measured):
            self._swap(i, int(np.flatnonzero(taxels == index)[0]))
        first = len(measured)
        for i in range(first, first + m):
            self._swap(i, i + self._random.below(len(taxels) - i))
        return taxels[first : first + m].copy()

    def _swap(self, i: int, j: int) -> None:
        taxels = self._taxels
        taxels[i], taxels[j] = taxels[j], taxels[i]
