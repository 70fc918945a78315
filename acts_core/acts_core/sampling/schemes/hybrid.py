# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Hybrid sampling: an adaptive frame for a part of M, random taxels for the rest.

The paper's discussion: adaptive sampling is best for small objects and random sampling for large ones.
"""

from __future__ import annotations

import numpy as np

from acts_core.array import MAX_SIDE
from acts_core.sampling.basis import CommonSettings, Measure, OwnSetting, Samples, SamplingScheme, Share, SkinMap
from acts_core.sampling.schemes.adaptive import Adaptive
from acts_core.sampling.schemes.random_taxels import RandomTaxels

ADAPTIVE_QUOTA = OwnSetting(
    "adaptive_quota",
    "taxels of a hybrid frame that are chosen adaptively, 1 to m there",
    default=28,
    minimum=0,
    maximum=MAX_SIDE**2,
    number=8,
    share=Share("adaptive_share", "share of a hybrid frame that is chosen adaptively", 0.5),
)


class Hybrid(SamplingScheme):
    """Adaptive sampling for its quota, then random taxels among those that the frame has not measured."""

    name = "hybrid"
    number = 5
    description = "an adaptive frame for a part of M, random taxels for the rest"
    own_settings = (ADAPTIVE_QUOTA,)

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        super().__init__(config, skin_map)
        self._adaptive = Adaptive(config, skin_map)
        self._random = RandomTaxels(config, skin_map)

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        found, found_counts = self._adaptive.search(measure, self.config.own(ADAPTIVE_QUOTA))
        drawn = self._random.draw(self.config.m - len(found), measured=found)
        _, drawn_counts = self.measured(measure, drawn)
        return np.concatenate((found, drawn)), np.concatenate((found_counts, drawn_counts))
