"""How fast the skin changes at this moment, and so how little an old measurement is worth.

An object that comes down presses many taxels at once. Those not measured since still read untouched; their own past
gives no reason to doubt them, only what the others do does.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_KEPT = 0.6
"""Part of the rate of change that is kept from frame to frame."""

_SHORTEST_S = 0.0005
_LONGEST_S = 1.0
"""Changes within less are not taken for faster, older measurements not for worse."""


class Unrest:
    """Follows the rate at which pressed taxels change from one measurement to the next.

    Parameters
    ----------
    rows, cols : int
    touch_counts : float
        Above it a taxel is pressed.
    noise_counts : float
        Changes up to it are none.

    Attributes
    ----------
    rate_counts_per_s : float
        Root mean square over the pressed taxels measured in the last frames.
    """

    def __init__(self, rows: int, cols: int, touch_counts: float, noise_counts: float = 10.0) -> None:
        self._touch_counts = touch_counts
        self._noise_counts = noise_counts
        self._values = np.zeros((rows, cols), dtype=np.float32)
        self._age_s = np.full((rows, cols), _LONGEST_S, dtype=np.float32)
        self.rate_counts_per_s = 0.0

    def reset(self) -> None:
        """Forget everything."""
        self._values.fill(0)
        self._age_s.fill(_LONGEST_S)
        self.rate_counts_per_s = 0.0

    def step(self, image: NDArray[np.float32], age_s: NDArray[np.float32], period_s: float) -> NDArray[np.float32]:
        """Take the next image.

        Parameters
        ----------
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts; measured taxels have their measured value.
        age_s : np.ndarray [shape=(rows, cols), dtype=float32]
            Time since each was measured [s]; inf: never.
        period_s : float
            Time since the last image [s].

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=float32]
            How far each taxel may have changed since it was measured, a standard deviation [counts].
        """
        before_s = self._age_s + np.float32(period_s)
        fresh = age_s < np.minimum(before_s, np.float32(period_s))
        pressed = fresh & (np.maximum(image, self._values) > self._touch_counts)
        change = np.abs(image[pressed] - self._values[pressed])
        since_s = np.clip(before_s[pressed] - age_s[pressed], _SHORTEST_S, _LONGEST_S)
        rates = np.where(change > self._noise_counts, change / since_s, 0)
        rate = float(np.sqrt(np.mean(np.square(rates, dtype=np.float64)))) if rates.size else 0.0
        self.rate_counts_per_s = _KEPT * self.rate_counts_per_s + (1 - _KEPT) * rate
        self._values[fresh] = image[fresh]
        self._age_s = np.minimum(age_s, np.float32(_LONGEST_S))
        return self._age_s * np.float32(self.rate_counts_per_s)
