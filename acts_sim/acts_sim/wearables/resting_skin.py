# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the taxels of an untouched skin read: an offset each, which drifts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.settings import setting, validate

_TONES = 3
_PERIOD_S = (120.0, 1200.0)


@dataclass(frozen=True)
class RestConfig:
    """Offsets and their drift. The numbers are ours: nothing was published of them."""

    offset_counts: float = setting(8.0, "root mean square of the offsets [counts]", minimum=0.0, maximum=200.0)
    drift_counts_per_min: float = setting(
        3.0, "standard deviation of the drift that all taxels share, as by warming up", minimum=0.0, maximum=100.0
    )
    taxel_drift_counts_per_min: float = setting(
        1.0, "standard deviation of the drift of each taxel for itself", minimum=0.0, maximum=100.0
    )

    def __post_init__(self) -> None:
        validate(self)


class RestingSkin:
    """An untouched skin that drifts, in slow tones of two to twenty minutes.

    Parameters
    ----------
    size : int
        Taxels.
    rng : np.random.Generator
    config : RestConfig, optional
    """

    def __init__(self, size: int, rng: np.random.Generator, config: RestConfig | None = None) -> None:
        config = config or RestConfig()
        self._offset = config.offset_counts * np.abs(rng.standard_normal(size))
        self._rate = 2 * np.pi / rng.uniform(*_PERIOD_S, _TONES)
        self._phase = rng.uniform(0, 2 * np.pi, (_TONES, size))
        shared = rng.uniform(0, 2 * np.pi, _TONES)
        self._shared_phase = shared[:, None]
        # The speeds of the tones add up to that of the drift.
        share = np.sqrt(2 / _TONES) / (60 * self._rate)
        self._shared = config.drift_counts_per_min * share
        self._own = config.taxel_drift_counts_per_min * share

    def counts(self, time_s: float) -> NDArray[np.float64]:
        """What the taxels read at this time, before noise and rounding; np.ndarray [shape=(size,), dtype=float64]."""
        angle = (self._rate * time_s)[:, None]
        drift = self._shared @ (np.sin(angle + self._shared_phase) - np.sin(self._shared_phase))
        drift = drift + self._own @ (np.sin(angle + self._phase) - np.sin(self._phase))
        read: NDArray[np.float64] = np.maximum(self._offset + drift, 0.0)
        return read
