# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sampling that follows what is pressed and goes on searching everywhere else.

ACTS' own, beyond the paper, whose discussion asks for combinations of sampling schemes. Adaptive sampling begins every
frame anew: a contact between the first taxels of the search is found in no frame, and one that is large uses up a frame
before the others are found. Here frames remember: a part of each goes to the taxels that were pressed and to those
around them, the rest to a search that is taken up where the last frame left it. What the search finds is looked at from
all sides in the same frame; what is known to be pressed is measured last, so that the image shows it as it is.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from acts_core.array import MAX_SIDE
from acts_core.sampling.basis import (
    CommonSettings,
    Measure,
    OwnSetting,
    Samples,
    SamplingScheme,
    Share,
    SkinMap,
    dither_order,
)

SEARCH_QUOTA = OwnSetting(
    "search_quota",
    "taxels of a tracking frame that are kept for the search, 1 to m there",
    default=11,
    minimum=0,
    maximum=MAX_SIDE**2,
    number=7,
    share=Share("search_share", "share of a tracking frame that is kept for the search", 0.2),
)


class Tracking(SamplingScheme):
    """Chooses the taxels of tracking sampling, frame after frame (in C++: ``acts::Tracking``).

    A taxel is flagged as pressed when it was above the threshold the last time it was measured. Candidates are the
    flagged taxels and their eight neighbours on the same patch of skin, as they stand when the frame begins. Of the `m`
    taxels of a frame, up to ``m - search_quota`` are candidates: row by row, cyclically from the first one that the
    frame before left out. They are measured at the end of the frame: an image is of that moment, and what is pressed is
    what changes.

    Before them `search_quota` or more follow the order of search from where it stopped, without the candidates of this
    frame and what it has measured already. What exceeds the quota goes to the neighbours of the taxels that the search
    found newly pressed, breadth first, and where there are none (any more) to the search.

    So in every frame `m` taxels are measured, none twice, and

    - every taxel at least once in any ``ceil(rows * cols / search_quota)`` frames,
    - every taxel that stays a candidate at least once in any ``ceil(c / (m - search_quota))`` frames, where c taxels
      were candidates in that time.
    """

    name = "tracking"
    number = 6
    description = "a search continued from the last frame, then what was pressed when last measured, and its neighbours"
    own_settings = (SEARCH_QUOTA,)

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        super().__init__(config, skin_map)
        self._order: list[int] = dither_order(skin_map.rows, skin_map.cols).tolist()
        self._search_quota = config.own(SEARCH_QUOTA)
        self._pressed = np.zeros((skin_map.rows, skin_map.cols), dtype=bool)
        self._patches = np.array(skin_map.patches).reshape(self._pressed.shape)
        self._cursor = 0
        self._walk = 0

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        rows, cols = self._pressed.shape
        skin = self.skin_map
        followed = self._follow()
        others = self.config.m - len(followed)
        reserved = set(followed)
        measured: dict[int, int] = {}
        found: deque[tuple[int, int]] = deque()

        def take(place: int) -> None:
            row, col = divmod(place, cols)
            measured[place] = measure(*divmod(skin.taxels[place], self.config.cols))
            pressed = measured[place] > self.config.threshold_counts and skin.has_skin(place)
            if pressed and not self._pressed[row, col]:
                found.append((row, col))
            self._pressed[row, col] = pressed

        def is_free(place: int) -> bool:
            return place not in measured and place not in reserved

        searched = 0
        while len(measured) < others:
            if found and searched >= self._search_quota:
                row, col = found.popleft()
                for near_row in range(max(row - 1, 0), min(row + 2, rows)):
                    for near_col in range(max(col - 1, 0), min(col + 2, cols)):
                        near = near_row * cols + near_col
                        if skin.joined(row * cols + col, near) and is_free(near) and len(measured) < others:
                            take(near)
                continue
            place = self._order[self._walk]
            self._walk = (self._walk + 1) % len(self._order)
            if is_free(place):
                take(place)
                searched += 1
        for place in followed:
            take(place)
        taxels = [skin.taxels[place] for place in measured]
        return np.array(taxels, dtype=np.uint16), np.array(list(measured.values()), dtype=np.uint16)

    def _follow(self) -> list[int]:
        """The candidates that this frame measures; moves the cursor to the first that it leaves out."""
        rows, cols = self._pressed.shape
        padded = np.pad(self._pressed, 1)
        patches = np.pad(self._patches, 1, constant_values=-1)
        near = np.zeros_like(self._pressed)
        for row in range(3):
            for col in range(3):
                there = np.s_[row : row + rows, col : col + cols]
                near |= padded[there] & (patches[there] == self._patches)
        candidates = np.flatnonzero(near)
        from_cursor = np.roll(candidates, -int(np.searchsorted(candidates, self._cursor))).tolist()
        limit = self.config.m - self._search_quota
        self._cursor = from_cursor[limit] if limit < len(from_cursor) else 0
        return from_cursor[:limit]
