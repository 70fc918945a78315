# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Both feet, sample by sample."""

from __future__ import annotations

from collections import deque

from acts_core.errors import ArrayError
from acts_recon.gait.config import GaitConfig
from acts_recon.gait.foot import FootTracker
from acts_recon.gait.loads import Loads
from acts_recon.gait.step import Step
from acts_recon.gait.summary import Gait, summarise

FEET = ("left", "right")
"""Names of the feet, in the order of their numbers."""

# A foot whose load changes by less than this share of the other's is not walked on.
_LEAST_OF_OTHER = 0.1


class GaitTracker:
    """Finds the steps of both feet, and what the walk of the last time is like.

    The samples of a foot come in order; of the two they may come at any times and rates. A foot that is missing is
    one that never comes.

    Parameters
    ----------
    config : GaitConfig, optional
    """

    def __init__(self, config: GaitConfig | None = None) -> None:
        self._config = config or GaitConfig()
        self._feet = tuple(FootTracker(self._config) for _ in FEET)
        self._steps: tuple[deque[Step], ...] = tuple(deque() for _ in FEET)

    @property
    def loads(self) -> tuple[Loads | None, ...]:
        """What has been learnt of each foot."""
        return tuple(foot.loads for foot in self._feet)

    @property
    def carries_since_s(self) -> tuple[float | None, ...]:
        """See `FootTracker.carries_since_s`; of each foot."""
        return tuple(foot.carries_since_s for foot in self._feet)

    def step(self, foot: int, time_s: float, force: float, x_m: float = 0.0, y_m: float = 0.0) -> tuple[Step, ...]:
        """Take a sample of a foot, 0 left or 1 right; the rest as of `FootTracker.step`.

        Raises
        ------
        ArrayError
            When the foot is neither.
        """
        if foot not in (0, 1):
            raise ArrayError(f"foot = {foot}: allowed are 0 (left) and 1 (right)")
        return self._keep(foot, self._feet[foot].step(time_s, force, x_m, y_m))

    def finish(self) -> tuple[tuple[Step, ...], ...]:
        """The last steps of each foot, where the recording ends right after them."""
        return tuple(self._keep(number, foot.finish()) for number, foot in enumerate(self._feet))

    def gait(self) -> Gait:
        """What the walk was like in the setting `summary_s` before the newest step."""
        left, right = (tuple(steps) for steps in self._steps)
        return summarise(left, right, longest_stride_s=self._config.longest_stride_s)

    def _keep(self, foot: int, told: tuple[Step, ...]) -> tuple[Step, ...]:
        loads = self._feet[foot].loads
        # A foot that has no load any more, as after a recording in another unit, measures the other no longer.
        self._feet[1 - foot].least_span = 0.0 if loads is None else _LEAST_OF_OTHER * loads.span
        if told:
            kept = self._steps[foot]
            if kept and told[0].strike_s < kept[-1].strike_s:
                # The clock was set back, or a recording began anew.
                for steps in self._steps:
                    steps.clear()
            kept.extend(told)
            oldest_s = told[-1].toe_off_s - self._config.summary_s
            for steps in self._steps:
                while steps and steps[0].toe_off_s < oldest_s:
                    steps.popleft()
        return told
