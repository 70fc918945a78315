# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Adaptive sampling: from coarse to fine, and around what is pressed first (the paper's)."""

from __future__ import annotations

import numpy as np

from acts_core.sampling.basis import NEIGHBOURS, Measure, Samples, SamplingScheme, SkinMap, division_order


class Adaptive(SamplingScheme):
    """Begins every frame anew with the search of `adaptive`."""

    name = "adaptive"
    number = 3
    description = "a search from coarse to fine, around what is pressed first (the paper's)"

    def frame(self, measure: Measure) -> Samples:
        """See `SamplingScheme.frame`."""
        return self.search(measure, self.config.m)

    def search(self, measure: Measure, m: int) -> Samples:
        """Measure `m` taxels."""
        config = self.config
        return adaptive(
            measure,
            config.rows,
            config.cols,
            m,
            threshold_counts=config.threshold_counts,
            neighbour_order=config.neighbour_order,
            skin_map=self.skin_map,
        )


def adaptive(
    measure: Measure,
    rows: int,
    cols: int,
    m: int,
    *,
    threshold_counts: int = 180,
    neighbour_order: str = "columns",
    skin_map: SkinMap | None = None,
) -> Samples:
    """Walk the division order; around a taxel above the threshold search the neighbours first, depth first.

    Paper, Supplemental Algorithm 1, with the two points in which the published firmware differs from it: exactly `m`
    taxels are measured, and the threshold itself does not count as a touch. Order and neighbours are those of the skin
    where there is a `skin_map`, and no neighbour is on another patch.

    Returns
    -------
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
        As in `Sampler.frame`.
    """
    skin = skin_map or SkinMap.of_matrix(rows, cols)
    steps = NEIGHBOURS[neighbour_order]
    measured = np.zeros((skin.rows, skin.cols), dtype=bool)
    indices: list[int] = []
    counts: list[int] = []

    def touched(row: int, col: int) -> bool:
        place = row * skin.cols + col
        count = measure(*divmod(skin.taxels[place], cols))
        measured[row, col] = True
        indices.append(skin.taxels[place])
        counts.append(count)
        return count > threshold_counts and skin.has_skin(place)

    for place in division_order(skin.rows, skin.cols).tolist():
        if len(indices) == m:
            break
        row, col = divmod(place, skin.cols)
        if measured[row, col] or not touched(row, col):
            continue
        # A stack instead of recursion, here and on the board: a palm on the skin is a thousand levels deep.
        stack = [(row, col, iter(steps))]
        while stack and len(indices) < m:
            row, col, remaining = stack[-1]
            step = next(remaining, None)
            if step is None:
                stack.pop()
                continue
            near_row, near_col = row + step[0], col + step[1]
            outside = not (0 <= near_row < skin.rows and 0 <= near_col < skin.cols)
            if outside or measured[near_row, near_col]:
                continue
            if not skin.joined(row * skin.cols + col, near_row * skin.cols + near_col):
                continue
            if touched(near_row, near_col):
                stack.append((near_row, near_col, iter(steps)))
    return np.array(indices, dtype=np.uint16), np.array(counts, dtype=np.uint16)
