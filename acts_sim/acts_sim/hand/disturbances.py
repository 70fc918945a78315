# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Disturbances: forces on the object, and shaking of the hand."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


class Disturbances:
    """Pulls the object and shakes the hand.

    Parameters
    ----------
    weight_n : float
        Weight of the object [N].
    down : np.ndarray [shape=(3,)]
        Direction of gravity in the palm's frame, a unit vector.

    Attributes
    ----------
    load_n : np.ndarray [shape=(3,)]
        Present force on the object, in the palm's frame [N].
    """

    def __init__(self, weight_n: float, down: NDArray[np.float64]) -> None:
        self.load_n = np.zeros(3)
        self._weight_n = weight_n
        self._down = down
        self._goal_n = np.zeros(3)
        self._rate_n_s = 0.0
        self._shake_direction = np.zeros(3)
        self._amplitude_m = self._omega_rad_s = 0.0
        self._shaken_s = self._shake_s = 0.0

    def pull(self, force_n: NDArray[np.float64], ramp_s: float) -> None:
        """Pull the object with a force that rises within `ramp_s` and then is constant.

        Parameters
        ----------
        force_n : np.ndarray [shape=(3,), dtype=float64]
            In the palm's frame [N].
        ramp_s : float
            [s]
        """
        self._goal_n = force_n.copy()
        self._rate_n_s = float(np.linalg.norm(self._goal_n - self.load_n)) / max(ramp_s, 1e-6)

    def stop_pulling(self) -> None:
        """Pull no more, at once."""
        self.load_n = self._goal_n = np.zeros(3)
        self._rate_n_s = 0.0

    def pull_down(self, times_weight: float, ramp_s: float) -> None:
        """Pull the object downwards with a multiple of its weight, which rises within `ramp_s`."""
        self.pull(times_weight * self._weight_n * self._down, ramp_s)

    def shake(self, direction: NDArray[np.float64], amplitude_m: float, frequency_hz: float, duration_s: float) -> None:
        """Shake the whole hand along a direction (a sine).

        Parameters
        ----------
        direction : np.ndarray [shape=(3,), dtype=float64]
            In the palm's frame, of any length but 0.
        amplitude_m, frequency_hz, duration_s : float
        """
        self._shake_direction = direction / np.linalg.norm(direction)
        self._amplitude_m, self._omega_rad_s = amplitude_m, math.tau * frequency_hz
        self._shaken_s, self._shake_s = 0.0, duration_s

    def load(self, dt_s: float) -> NDArray[np.float64]:
        """Advance by `dt_s`; return the force on the object [N], np.ndarray [shape=(3,)]."""
        if self._rate_n_s:
            missing = self._goal_n - self.load_n
            distance = float(np.linalg.norm(missing))
            step = self._rate_n_s * dt_s
            if distance <= step:
                self.load_n, self._rate_n_s = self._goal_n, 0.0
            else:
                self.load_n = self.load_n + missing * (step / distance)
        return self.load_n

    @property
    def is_shaking(self) -> bool:
        """Whether the hand is being shaken."""
        return self._shaken_s < self._shake_s

    def shaking(self, dt_s: float) -> NDArray[np.float64]:
        """Advance by `dt_s`; return the acceleration of the hand [m/s^2], np.ndarray [shape=(3,)]."""
        self._shaken_s += dt_s
        # The amplitude rises and falls within a tenth of a second, so that the hand ends where it started.
        left_s = self._shake_s - self._shaken_s
        strength = min(1.0, self._shaken_s / 0.1, max(left_s, 0.0) / 0.1)
        swing = -self._amplitude_m * self._omega_rad_s**2 * math.sin(self._omega_rad_s * self._shaken_s)
        return strength * swing * self._shake_direction
