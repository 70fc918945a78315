# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Force response of a taxel: newtons to ADC counts and back."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import SettingsError
from acts_core.skin.force_file import read_force_points

_SMALLEST_COUNTS = 1e-9
_SMALLEST_N = 1e-9


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


@dataclass(frozen=True, eq=False)
class MeasuredForceResponse:
    """Response of a taxel through measured points, linear between them.

    Above the last point the last piece goes on, to the ADC's full scale; a real taxel saturates, so forces up there are
    estimated too low rather than too high. Below the first point that is no 0 nothing is known but the largest force
    that reads 0: forces are interpolated from there.

    Attributes
    ----------
    newtons : np.ndarray [shape=(n,), dtype=float64]
        Forces on one taxel, growing [N].
    counts_at : np.ndarray [shape=(n,), dtype=float64]
        What it reads there; growing, but for zeros at the beginning [counts].
    """

    newtons: NDArray[np.float64]
    counts_at: NDArray[np.float64]

    @classmethod
    def from_file(cls, path: Path) -> MeasuredForceResponse:
        """A response measured by a lab, from a csv or npz file of newtons and counts; see `read_force_points`.

        Raises
        ------
        SettingsError
            When the file cannot be read or does not hold a response.
        """
        return cls(*read_force_points(path))

    def __post_init__(self) -> None:
        newtons, counts = self.newtons, self.counts_at
        # The last of the leading zeros is where the response begins.
        first = max(int(np.count_nonzero(counts == 0)) - 1, 0)
        newtons, counts = newtons[first:], counts[first:]
        if counts[0] > 0 and newtons[0] > 0:
            newtons, counts = np.insert(newtons, 0, 0.0), np.insert(counts, 0, 0.0)
        if counts[-1] < COUNT_MAX:
            slope = (newtons[-1] - newtons[-2]) / (counts[-1] - counts[-2])
            newtons = np.append(newtons, newtons[-1] + slope * (COUNT_MAX - counts[-1]))
            counts = np.append(counts, float(COUNT_MAX))
        object.__setattr__(self, "newtons", newtons)
        object.__setattr__(self, "counts_at", counts)

    def counts(self, force_n: ArrayLike) -> NDArray[np.float64]:
        """Counts (fractional, before noise and rounding) of forces on single taxels [N]; same shape."""
        return np.interp(np.asarray(force_n, dtype=np.float64), self.newtons, self.counts_at)

    def force_n(self, counts: ArrayLike) -> NDArray[np.float64]:
        """Force on single taxels [N] that explains these counts; same shape. 0 counts give 0 N."""
        values = np.asarray(counts, dtype=np.float64)
        return np.where(values > 0, np.interp(values, self.counts_at, self.newtons), 0.0)


Response: TypeAlias = ForceResponse | MeasuredForceResponse
"""What a taxel reads at a force, by a formula or by measured points."""


def force_table(response: Response) -> NDArray[np.float64]:
    """Force of a pressed taxel by its counts, for kernels that look it up and interpolate.

    Returns
    -------
    np.ndarray [shape=(COUNT_MAX + 2,), dtype=float64]
        Newtons at 0 to `COUNT_MAX` counts; at 0 the limit from above. The last value stands twice, so that there is a
        next entry for every count. All are above 0, since centres are means weighted by force: a measured response may
        say 0 N up to any number of counts.
    """
    counts = np.minimum(np.arange(COUNT_MAX + 2, dtype=np.float64), float(COUNT_MAX))
    return np.maximum(response.force_n(np.maximum(counts, _SMALLEST_COUNTS)), _SMALLEST_N)
