"""An act of the demonstration: a scenario of the evaluation, played by a hand whose processes really run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_sim.hand import HandTruth, HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome
from acts_tools.live_hand.recording import HandRecording


@dataclass(frozen=True)
class Moment:
    """How things stood at a time.

    Attributes
    ----------
    time_s : float
    truth : HandTruth
    counts : np.ndarray [shape=(taxels,)]
        What the taxels read.
    """

    time_s: float
    truth: HandTruth
    counts: NDArray[np.float64]


@dataclass(frozen=True)
class Act:
    """What is left of it.

    Attributes
    ----------
    name : str
        Of the scenario.
    title : str
    world : HandWorldConfig
        What was in the hand.
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
        """When the hand began to close [s]."""
        return self.recording.marks[0][0] if self.recording.marks else self.recording.truth_between()[0][0]

    def moment(self, time_s: float) -> Moment | None:
        """How things stood at a time or up to a tenth of a second beside it; None where nothing is known."""
        if not self.recording.fields:
            return None
        at_s, counts = min(self.recording.fields, key=lambda one: abs(one[0] - time_s))
        times_s, rows = self.recording.truth_between(at_s - 0.05, at_s + 0.05)
        if not len(times_s):
            return None
        row = rows[int(np.argmin(np.abs(times_s - at_s)))]
        return Moment(at_s, HandTruth.from_row(row, self.recording.patches), counts)
