# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An act of the demonstration: a scenario of the evaluation with a hand that runs in real processes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_sim.hand import HandTruth, HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome
from acts_tools.hand_rigs.recording import HandRecording


@dataclass(frozen=True)
class Moment:
    """State at one time.

    Attributes
    ----------
    time_s : float
    truth : HandTruth
    counts : np.ndarray [shape=(taxels,)]
        Counts of the taxels.
    """

    time_s: float
    truth: HandTruth
    counts: NDArray[np.float64]


@dataclass(frozen=True)
class Act:
    """Recorded data of an act.

    Attributes
    ----------
    name : str
        Name of the scenario.
    title : str
    world : HandWorldConfig
        Settings of the world, with the object in the hand.
    recording : HandRecording
    outcome : Outcome
    """

    name: str
    title: str
    world: HandWorldConfig
    recording: HandRecording
    outcome: Outcome

    @property
    def begin_s(self) -> float:
        """Time at which the hand began to close [s]."""
        grasps = [time_s for time_s, name in self.recording.marks if name == "grasp"]
        return grasps[0] if grasps else self.recording.truth_between()[0][0]

    def moment(self, time_s: float) -> Moment | None:
        """State at a time, or up to 0.1 s before or after it; None where there is none."""
        if not self.recording.fields:
            return None
        at_s, counts = min(self.recording.fields, key=lambda one: abs(one[0] - time_s))
        times_s, rows = self.recording.truth_between(at_s - 0.05, at_s + 0.05)
        if not len(times_s):
            return None
        row = rows[int(np.argmin(np.abs(times_s - at_s)))]
        return Moment(at_s, HandTruth.from_row(row, self.recording.patches), counts)
