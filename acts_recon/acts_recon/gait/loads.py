# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The forces under a foot when it is lifted and when it carries, learnt from what has been measured."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_recon.gait.config import GaitConfig

_LEAST_S = 2.0
_LEAST_COUNT = 12
# A foot is not taken to lift where fewer samples say so; docs/gait.md, Limits.
_SWING_COUNT = 3
_EVERY_S = 0.5
# Of the forces of the time that is learnt from.
_LOWEST, _HIGHEST = 1.0, 99.0
# Mean square of the differences of successive forces over twice their variance: 1 for noise, with a standard deviation
# of 1 over the root of their number, and near 0 for what is slow.
_ROUGHEST, _SURE = 0.85, 3.5
# From the lifted to the loaded foot over the standard deviation of all forces: 2 where a foot is as often here as there
# and nowhere else, 4.6 for noise. With few samples a second a quick walk is rough, too, but keeps to the two.
_TWO_SIDED, _TWO_SIDED_COUNT = 3.0, 24


@dataclass(frozen=True)
class Loads:
    """Forces in the unit that was given.

    Attributes
    ----------
    lifted, loaded : float
        Under the lifted foot, and under the foot that carries most.
    noise : float
        Standard deviation of a force; with few samples a second what the foot does in between is in it.
    """

    lifted: float
    loaded: float
    noise: float

    @property
    def span(self) -> float:
        """From the lifted to the loaded foot."""
        return self.loaded - self.lifted

    def share(self, force: float) -> float:
        """How much of its load a foot carries: 0 lifted, 1 loaded."""
        return (force - self.lifted) / self.span


class LoadLearner:
    """Learns the loads of one foot.

    A foot that never lifts, or only sways, and one whose forces are noise teach nothing: then the loads stay as they
    were, or None.

    Parameters
    ----------
    config : GaitConfig

    Attributes
    ----------
    loads : Loads or None
    """

    def __init__(self, config: GaitConfig) -> None:
        self.loads: Loads | None = None
        self._config = config
        self._forces: deque[tuple[float, float]] = deque()
        self._due_s = -np.inf

    def add(self, time_s: float, force: float) -> None:
        """Take a force."""
        self._forces.append((time_s, force))
        while self._forces[0][0] < time_s - self._config.learning_s:
            self._forces.popleft()
        if time_s < self._due_s or len(self._forces) < _LEAST_COUNT or time_s - self._forces[0][0] < _LEAST_S:
            return
        forces = np.array([force for _, force in self._forces])
        loads = _loads_of(forces, self._config.least_change)
        if loads is None or self.loads is not None:
            self._due_s = time_s + _EVERY_S
        # The first time, not before the foot carries again: while it is lifted, its lowest force is still to come.
        if loads is not None and (self.loads is not None or loads.share(force) > self._config.loaded_share):
            self.loads = loads


def _loads_of(forces: NDArray[np.float64], least_change: float) -> Loads | None:
    lifted, loaded = np.percentile(forces, (_LOWEST, _HIGHEST)).tolist()
    # Fewer samples as low as that are noise of a foot that stands.
    low = max(lifted, float(np.partition(forces, _SWING_COUNT - 1)[_SWING_COUNT - 1]))
    if loaded - low <= least_change * max(abs(low), abs(loaded)):
        return None
    roughness = np.square(np.diff(forces)).mean() / (2 * forces.var())
    is_two_sided = loaded - lifted < _TWO_SIDED * forces.std() and forces.size >= _TWO_SIDED_COUNT
    if roughness > (_ROUGHEST if is_two_sided else min(_ROUGHEST, 1.0 - _SURE / forces.size**0.5)):
        return None
    # The median of second differences, which of noise alone are sqrt(6) times as large as it.
    noise = float(np.median(np.abs(np.diff(forces, 2)))) / (0.6745 * 6**0.5)
    return Loads(lifted, loaded, noise)
