# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Comb sampling: every n-th taxel, from where the last frame stopped."""

from __future__ import annotations

from acts_core.sampling.basis import CommonSettings, Measure, OwnSetting, Samples, SamplingScheme, SkinMap

STEP = OwnSetting(
    "comb_step", "taxels from one of a comb frame to the next", default=5, minimum=1, maximum=64, number=17
)


class Comb(SamplingScheme):
    """Every `comb_step`-th taxel, row by row; at the end of the array, again from one taxel further on."""

    name = "comb"
    number = 8
    description = "every n-th taxel, from where the last frame stopped"
    own_settings = (STEP,)

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        super().__init__(config, skin_map)
        step, taxels = config.own(STEP), config.rows * config.cols
        self._order = [taxel for first in range(step) for taxel in range(first, taxels, step)]
        self._next = 0

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        places = range(self._next, self._next + self.config.m)
        self._next = places.stop % len(self._order)
        return self.measured(measure, (self._order[place % len(self._order)] for place in places))
