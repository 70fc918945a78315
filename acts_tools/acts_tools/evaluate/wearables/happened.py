# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is told of scenes, beside what really happened."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from acts_recon.impacts import Impact, Kind
from acts_sim.wearables import WornScene
from acts_tools.evaluate.statistics import distribution_with_max, mean

WITHIN_MS = 2.0

# Told at most so far from the truth, it is that event.
_SAME_S = 0.05
_AT_ONCE_S = 0.005


@dataclass
class Tally:
    """Events of the scenes of one name, and what was told of them.

    Attributes
    ----------
    scenes, events, missed : int
    as_expected : int
        Events that were told as what `SceneKind` says.
    parts, false : int
        Further touches that were told while something touched: fingers, the forefoot; and while nothing did.
    onset_ms, first_onset_ms : list of float
        Errors with sign: of the onset when it was over, and when it was told at first.
    within_sd : list of bool
        Whether the onset was off by at most its standard deviation.
    delay_ms : list of float
        From the onset to the first message.
    interval_ms : list of float
        Errors of the times between events of a scene.
    """

    name: str
    scenes: int = 0
    events: int = 0
    missed: int = 0
    as_expected: int = 0
    parts: int = 0
    false: int = 0
    onset_ms: list[float] = field(default_factory=list)
    first_onset_ms: list[float] = field(default_factory=list)
    within_sd: list[bool] = field(default_factory=list)
    delay_ms: list[float] = field(default_factory=list)
    interval_ms: list[float] = field(default_factory=list)

    def add(self, shown: WornScene, told: Sequence[tuple[float, Impact]]) -> None:
        """Take what was told of a scene, each with the end of the frame that told it [s]."""
        self.scenes += 1
        first = {impact.number: (at_s, impact) for at_s, impact in told if not (impact.is_over or impact.joined)}
        over = [impact for _, impact in told if impact.is_over]
        errors_ms = []
        for event in shown.events:
            self.events += 1
            nearest = min(over, key=lambda one: abs(one.onset_s - event.onset_s), default=None)
            if nearest is None or abs(nearest.onset_s - event.onset_s) > _SAME_S:
                self.missed += 1
                continue
            over.remove(nearest)
            error_ms = 1e3 * (nearest.onset_s - event.onset_s)
            errors_ms.append(error_ms)
            expected = Kind[shown.kind.told_as.upper()], shown.kind.rebounds
            self.as_expected += (nearest.kind, nearest.bounced) == expected
            self.within_sd.append(abs(error_ms) <= 1e3 * nearest.onset_sd_s)
            at_s, begun = first[nearest.number]
            self.first_onset_ms.append(1e3 * (begun.onset_s - event.onset_s))
            self.delay_ms.append(1e3 * (at_s - event.onset_s))
        self.onset_ms += errors_ms
        if len(errors_ms) == len(shown.events):
            self.interval_ms += np.diff(errors_ms).tolist()
        for impact in over:
            is_part = shown.is_touched(impact.onset_s - _AT_ONCE_S, impact.onset_s + _AT_ONCE_S)
            self.parts += is_part
            self.false += not is_part

    def summary(self) -> dict[str, Any]:
        """Plain numbers of the report."""
        onset_ms = np.array(self.onset_ms)
        near = int((np.abs(onset_ms) <= WITHIN_MS).sum())
        return {
            "scenes": self.scenes,
            "events": self.events,
            "missed": self.missed,
            "false": self.false,
            "parts": self.parts,
            "as_expected": self.as_expected,
            "onset_error_ms": distribution_with_max(np.abs(onset_ms)),
            "onset_bias_ms": mean(onset_ms),
            "onset_within_2_ms": near,
            "onset_within_2_ms_share": near / self.events if self.events else None,
            "onset_within_1_sigma": mean(self.within_sd),
            "first_onset_error_ms": distribution_with_max(np.abs(self.first_onset_ms)),
            "delay_ms": distribution_with_max(self.delay_ms),
            "interval_error_ms": distribution_with_max(np.abs(self.interval_ms)),
        }
