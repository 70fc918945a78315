"""Force response of a taxel: newtons to ADC counts and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import SettingsError


@dataclass(frozen=True)
class ForceResponse:
    """Saturating response of a piezoresistive taxel.

    ``counts = full_scale * (f - dead) / (f - dead + half)`` for a force ``f`` above the dead band, else 0.

    The default follows the shape of the measured response (paper, Fig. S9: 30 g give 63 counts, 100 g 208, 400 g 443,
    800 g 647; little below 20 g) within 50 counts. The figure gives the weight but not the area it stood on; the
    default assumes 16 taxels, a foot of about 18 mm. A lab replaces it by its own calibration.

    Attributes
    ----------
    full_scale_counts : float
        Counts at infinite force.
    dead_n : float
        Largest force on one taxel that still reads 0 [N].
    half_n : float
        Force above the dead band that reads half of full scale [N].
    """

    full_scale_counts: float = float(COUNT_MAX)
    dead_n: float = 0.005
    half_n: float = 0.30

    def __post_init__(self) -> None:
        if not 0 < self.full_scale_counts <= COUNT_MAX:
            raise SettingsError(f"full_scale_counts = {self.full_scale_counts}: allowed is above 0 to {COUNT_MAX}")
        if not (np.isfinite(self.dead_n) and self.dead_n >= 0):
            raise SettingsError(f"dead_n = {self.dead_n}: allowed is 0 N or more")
        if not (np.isfinite(self.half_n) and self.half_n > 0):
            raise SettingsError(f"half_n = {self.half_n}: allowed is above 0 N")

    def counts(self, force_n: ArrayLike) -> NDArray[np.float64]:
        """Counts (fractional, before noise and rounding) of forces on single taxels [N]; same shape."""
        above = np.maximum(np.asarray(force_n, dtype=np.float64) - self.dead_n, 0.0)
        return self.full_scale_counts * above / (above + self.half_n)

    def force_n(self, counts: ArrayLike) -> NDArray[np.float64]:
        """Force on single taxels [N] that explains these counts; same shape.

        0 counts give 0 N. The inverse is steep near full scale, so counts above 99 % of it are read as 99 %.
        """
        share = np.clip(np.asarray(counts, dtype=np.float64) / self.full_scale_counts, 0.0, 0.99)
        return np.where(share > 0, self.dead_n + self.half_n * share / (1.0 - share), 0.0)
