# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The samples of the last frames, each with the time at which it was measured."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, MeasuredForceResponse, force_table
from acts_recon.images import slope_table
from acts_recon.impacts.footprint_fit import Footprint, fit_footprint

Array = NDArray[np.float64]

_MARGIN_TAXELS = 2.0
# What lies nearer than this to where it first touches is soon touched, too.
_AROUND_TAXELS = 2.5


class RecentSamples:
    """Keeps the samples of the last frames, and finds out of them how a footprint moved.

    Parameters
    ----------
    geometry : ArrayGeometry
    response : ForceResponse or MeasuredForceResponse
    touch_counts : float
        A sample above is of a pressed taxel.
    noise_counts : float
        Standard deviation of a reading.
    memory_s : float
        For how long they are kept.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: ForceResponse | MeasuredForceResponse,
        touch_counts: float,
        noise_counts: float,
        memory_s: float,
    ) -> None:
        self._geometry = geometry
        self._touch_counts = touch_counts
        self._memory_s = memory_s
        self._force_n = force_table(response)
        self._slope_n = slope_table(self._force_n)
        self._noise_counts = noise_counts
        place = np.arange(geometry.size)
        self._x_m, self._y_m = geometry.x_m(place % geometry.cols), geometry.y_m(place // geometry.cols)
        self._frames: deque[tuple[float, Array, NDArray[np.intp], Array]] = deque()

    def reset(self) -> None:
        """Forget all samples."""
        self._frames.clear()

    def add(self, time_s: float, duration_s: float, measured: NDArray[np.float32], age_s: NDArray[np.float32]) -> None:
        """Keep what was measured in one frame; parameters as of `ImpactDetector.step`."""
        ages_s = age_s.ravel()
        taxel = np.flatnonzero(ages_s <= duration_s)
        self._frames.append(
            (time_s, time_s - ages_s[taxel].astype(float), taxel, measured.ravel()[taxel].astype(float))
        )
        while self._frames[0][0] < time_s - self._memory_s:
            self._frames.popleft()

    def near(self, x_m: float, y_m: float, reach_m: float) -> tuple[Array, Array]:
        """When samples of the newest frame near a place were measured pressed, and when not [s]."""
        _, time_s, taxel, counts = self._frames[-1]
        near = np.hypot(self._x_m[taxel] - x_m, self._y_m[taxel] - y_m) <= reach_m
        pressed = counts > self._touch_counts
        return time_s[near & pressed], time_s[near & ~pressed]

    def untouched_s(self, x_m: float, y_m: float, first_s: float, last_s: float) -> Array:
        """When the taxels around a place were measured and not pressed, between two times [s]."""
        found = []
        for end_s, time_s, taxel, counts in self._frames:
            if end_s < first_s:
                continue
            around = np.hypot(self._x_m[taxel] - x_m, self._y_m[taxel] - y_m) <= _AROUND_TAXELS * self._geometry.pitch_m
            free = around & (counts <= self._touch_counts) & (time_s > first_s) & (time_s < last_s)
            found.append(time_s[free])
        return np.concatenate(found) if found else np.zeros(0)

    def footprint(self, first_s: float, last_s: float, x_m: float, y_m: float, spread_m: float) -> Footprint | None:
        """The footprint that was pressed between two frames, both with; None where it cannot be told.

        Parameters
        ----------
        first_s, last_s : float
            Ends of the frames.
        x_m, y_m, spread_m : float
            Middle of all it has touched, and root mean square distance of the force from there.
        """
        frames = [one for one in self._frames if first_s <= one[0] <= last_s]
        if not frames:
            return None
        time_s, counts = (np.concatenate([one[k] for one in frames]) for k in (1, 3))
        taxel = np.concatenate([one[2] for one in frames])
        reach_m = 3.0 * spread_m + _MARGIN_TAXELS * self._geometry.pitch_m
        near = np.hypot(self._x_m[taxel] - x_m, self._y_m[taxel] - y_m) <= reach_m
        pressed = near & (counts > self._touch_counts)
        if not pressed.any():
            return None
        near &= (time_s >= time_s[pressed].min()) & (time_s <= time_s[pressed].max())
        time_s, taxel, counts = time_s[near], taxel[near], counts[near]
        whole = np.clip(np.rint(counts), 0, self._force_n.size - 2).astype(np.intp)
        # What is no more than noise is no force.
        force_n = np.where(counts > 5.0 * self._noise_counts, self._force_n[whole], 0.0)
        noise_n = self._noise_counts * self._slope_n[whole]
        area_m2 = self._geometry.taxel_area_m2
        return fit_footprint(time_s, self._x_m[taxel], self._y_m[taxel], force_n, noise_n, taxel, len(frames), area_m2)
