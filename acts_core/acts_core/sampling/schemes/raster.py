# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Raster sampling: every taxel."""

from __future__ import annotations

from acts_core.sampling.basis import Measure, Samples, SamplingScheme


class Raster(SamplingScheme):
    """All taxels, row by row."""

    name = "raster"
    number = 4
    description = "every taxel, row by row"
    measures_all = True

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        return self.measured(measure, range(self.config.rows * self.config.cols))
