# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Memory of a process over time, and the growth that counts as a leak."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

GROWTH_MAX_MB_PER_H = 10.0
"""Growth of a process's memory that counts as a leak; checked in runs of `JUDGED_S` or more."""

JUDGED_S = 300.0
"""Shortest run in which memory is judged: in shorter ones buffers still fill [s]."""


@dataclass
class Memory:
    """Resident memory of a process over time.

    Attributes
    ----------
    time_s, mb : list of float
        Time since the start of the measurement, and memory at that time (1 MB is 1e6 bytes).
    """

    time_s: list[float] = field(default_factory=list)
    mb: list[float] = field(default_factory=list)

    def at(self, time_s: float) -> float:
        """The value nearest to a time [MB]."""
        return self.mb[int(np.argmin(np.abs(np.array(self.time_s) - time_s)))]

    def growth_mb_per_h(self) -> float:
        """Slope of a line fitted to the values after the first tenth [MB/h]; 0 where there is only one."""
        time_s = np.array(self.time_s)
        behind = time_s >= 0.1 * time_s[-1]
        if behind.sum() < 2:
            return 0.0
        return float(np.polyfit(time_s[behind], np.array(self.mb)[behind], 1)[0] * 3600.0)
