# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is told of one step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Step:
    """A foot that was set down, carried, and was lifted again.

    Attributes
    ----------
    strike_s, strike_sd_s : float
        When the load rose above the setting `lifted_share`, and its standard deviation [s].
    toe_off_s, toe_off_sd_s : float
        When the load fell below it again, likewise [s].
    swing_s : float or None
        How long the foot was lifted before [s]; None where that is not known.
    peak_force : float
        Above that under the lifted foot, in the unit that was given.
    time_s, force : np.ndarray [shape=(n,), dtype=float64]
        From strike to toe off, of a stance of minutes the last one; the force likewise.
    x_m, y_m : np.ndarray [shape=(n,), dtype=float64]
        Path of the centre of pressure across and along the foot [m]; what presses the lifted foot is taken off.
    """

    strike_s: float
    strike_sd_s: float
    toe_off_s: float
    toe_off_sd_s: float
    swing_s: float | None
    peak_force: float
    time_s: Array
    force: Array
    x_m: Array
    y_m: Array

    @property
    def stance_s(self) -> float:
        """From strike to toe off [s]."""
        return self.toe_off_s - self.strike_s

    @property
    def progress_m(self) -> float:
        """How far along the foot the centre of pressure came, from the first to the last of the path [m]."""
        return float(self.y_m[-1] - self.y_m[0])

    @property
    def path_m(self) -> float:
        """Length of the path of the centre of pressure [m]; noise makes it longer."""
        return float(np.hypot(np.diff(self.x_m), np.diff(self.y_m)).sum())
