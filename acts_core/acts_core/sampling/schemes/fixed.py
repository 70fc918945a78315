# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fixed sampling: the same few taxels in every frame, down to a single one that is measured over and over."""

from __future__ import annotations

from acts_core.array import MAX_SIDE
from acts_core.sampling.basis import CommonSettings, Measure, OwnSetting, Samples, SamplingScheme, SkinMap

ROW = OwnSetting(
    "fixed_row", "row of the taxel that fixed frames begin with", 0, 0, MAX_SIDE - 1, number=14, below="rows"
)
COL = OwnSetting("fixed_col", "column of that taxel", 0, 0, MAX_SIDE - 1, number=15, below="cols")
TAXELS = OwnSetting(
    "fixed_taxels",
    "taxels of a fixed frame, measured in turns until there are m samples; 0: m, each once",
    0,
    0,
    MAX_SIDE**2,
    number=16,
)


class Fixed(SamplingScheme):
    """Measures a taxel and those nearest to it on the skin, in every frame in the same order.

    With `fixed_taxels` below `m` a frame has them several times, in turns: with 1, all `m` samples are of one taxel.
    Taxels on the same patch of skin come first, then the nearer ones, then the earlier ones row by row.
    """

    name = "fixed"
    number = 7
    description = "a chosen taxel and those around it, the same in every frame"
    own_settings = (ROW, COL, TAXELS)
    repeats = True

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        super().__init__(config, skin_map)
        first = skin_map.taxels.index(config.own(ROW) * config.cols + config.own(COL))
        row, col = divmod(first, skin_map.cols)

        def remoteness(place: int) -> tuple[bool, int, int]:
            place_row, place_col = divmod(place, skin_map.cols)
            return not skin_map.joined(first, place), (place_row - row) ** 2 + (place_col - col) ** 2, place

        nearest = sorted(range(len(skin_map.taxels)), key=remoteness)[: config.own(TAXELS) or config.m]
        self._taxels = [skin_map.taxels[place] for place in nearest]

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        return self.measured(measure, (self._taxels[k % len(self._taxels)] for k in range(self.config.m)))
