# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is told of the vibration of one contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Peak:
    """One tone.

    Attributes
    ----------
    frequency_hz, frequency_sd_hz : float
        And its standard deviation.
    amplitude_n, amplitude_sd_n : float
        Amplitude of the normal force: half of the way between its largest and its smallest, and the standard deviation.
    """

    frequency_hz: float
    frequency_sd_hz: float
    amplitude_n: float
    amplitude_sd_n: float


@dataclass(frozen=True)
class Spectrum:
    """The spectrum of one contact.

    Attributes
    ----------
    begin_s, end_s : float
        Time of the first sample and of the last [s].
    x_m, y_m : float
        Centre of pressure, mean over that time [m].
    force_n : float
        Mean force [N].
    taxels : int
        Of which samples were used.
    sample_rate_hz : float
        Samples of a taxel a second: at most one a frame, with `fixed` sampling also more. What vibrates faster than
        half of it appears at another frequency.
    step_hz : float
        From one value of `amplitude_n` to the next; the first is of 0 Hz.
    amplitude_n : np.ndarray [shape=(n,), dtype=float64]
        Amplitude of the force up to half that rate. The mean is taken off.
    peaks : tuple of Peak
        The largest first.
    """

    begin_s: float
    end_s: float
    x_m: float
    y_m: float
    force_n: float
    taxels: int
    sample_rate_hz: float
    step_hz: float
    amplitude_n: NDArray[np.float64]
    peaks: tuple[Peak, ...]

    @property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Of each value of `amplitude_n`; np.ndarray [shape=(n,), dtype=float64]."""
        return self.step_hz * np.arange(self.amplitude_n.size, dtype=np.float64)
