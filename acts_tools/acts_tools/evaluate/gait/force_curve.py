# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The steps that the force curve of a whole recording shows, without anything of `acts_recon.gait`.

The foot is loaded above half of the way between two plateaus, and lifted below 30 % of it; these are the 5th and the
95th percentile of all forces. Each rise from lifted to loaded is a step.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PLATEAUS = (5.0, 95.0)
_LIFTED, _LOADED = 0.3, 0.5
# A plateau that is lower is no swing, but a foot that stands.
_LOWEST = 0.5
_GAP_S = 0.5


def rises_s(time_s: Array, force: Array) -> Array:
    """When each step begins [s]; of one that began in a gap of more than half a second nothing is known."""
    low, high = np.percentile(force, _PLATEAUS)
    if high - low <= _LOWEST * abs(high):
        return np.zeros(0)
    share = (force - low) / (high - low)
    found = []
    is_lifted, before_s = False, time_s[0]
    for at_s, value in zip(time_s.tolist(), share.tolist(), strict=True):
        if at_s - before_s > _GAP_S:
            is_lifted = False
        if value > _LOADED:
            if is_lifted:
                found.append(at_s)
            is_lifted = False
        elif value < _LIFTED:
            is_lifted = True
        before_s = at_s
    return np.array(found)


def cadence_per_min(rises: Array, longest_stride_s: float) -> float | None:
    """Steps of both feet a minute, from those of one.

    From step to step is a stride, but longer [s] is a pause, and so is more than twice the median.
    """
    strides_s = np.diff(rises)
    strides_s = strides_s[strides_s <= longest_stride_s]
    if not strides_s.size:
        return None
    return 120.0 / float(strides_s[strides_s <= 2 * np.median(strides_s)].mean())
