# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The samples of the last frames, each with the time at which it was measured."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import Response, force_table
from acts_recon.images import Borders, borders_of, slope_table
from acts_recon.impacts.footprint_fit import Footprint, fit_footprint
from acts_recon.impacts.onset_fit import Rise

Array = NDArray[np.float64]

_MARGIN_TAXELS = 2.0
# What lies nearer than this to where it first touches is soon touched, too.
_AROUND_TAXELS = 2.5
# A sample of more than this many standard deviations of the noise is no noise. With 3, noise began 2 of 200 touches,
# 15 ms early.
_NOISES = 4.0
_LEAST_SLOPE_N = 1e-7  # a count, where a measured response is flat
# Share of its largest force in the first sample of a taxel that was measured early.
_EARLY = 0.4
# Until this share of the largest force, a touch rises.
_RISEN = 0.9
# A reading has risen from an earlier one where it is higher by so many standard deviations of the noise, or by this
# share of what a touch is, whichever is less.
_RISE_NOISES, _RISE_SHARE = 5.0, 0.5
# With so many samples per taxel, what touches has been found. The search of `tracking`, which takes longest, gets a
# fifth of them.
_SEARCHED = 5
# Fingers that touch together are further apart than this from middle to middle.
_WIDEST_M = 0.013


class RecentSamples:
    """Keeps the samples of the last frames, and finds out of them how a footprint moved.

    Of what lies around a place only taxels of the same patch count, whose number its methods are given: that of the
    rectangle of `borders`.

    Parameters
    ----------
    geometry : ArrayGeometry
    response : Response
    touch_counts : float
        A sample above is of a pressed taxel.
    noise_counts : float
        Standard deviation of a reading.
    memory_s : float
        For how long they are kept.
    borders : Borders, optional
        What lies behind one is not near.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response,
        touch_counts: float,
        noise_counts: float,
        memory_s: float,
        borders: Borders | None = None,
    ) -> None:
        self._geometry = geometry
        self._touch_counts = touch_counts
        self._memory_s = memory_s
        self._force_n = force_table(response)
        self._slope_n = slope_table(self._force_n)
        self._noise_counts = noise_counts
        place = np.arange(geometry.size)
        self._patch_of = (borders or borders_of(geometry.rows, geometry.cols)).rectangle_of
        self._x_m, self._y_m = geometry.x_m(place % geometry.cols), geometry.y_m(place // geometry.cols)
        self._frames: deque[tuple[float, Array, NDArray[np.intp], Array]] = deque()
        # Since the last reset: of each taxel in all frames but the newest, and how many samples these have.
        self._least_counts = np.full(geometry.size, np.inf)
        self._samples = 0

    def reset(self) -> None:
        """Forget all samples."""
        self._frames.clear()
        self._least_counts.fill(np.inf)
        self._samples = 0

    def add(self, time_s: float, duration_s: float, measured: NDArray[np.float32], age_s: NDArray[np.float32]) -> None:
        """Keep what was measured in one frame; parameters as of `ImpactDetector.step`."""
        if self._frames:
            _, _, taxel, counts = self._frames[-1]
            self._least_counts[taxel] = np.minimum(self._least_counts[taxel], counts)
            self._samples += taxel.size
        ages_s = age_s.ravel()
        taxel = np.flatnonzero(ages_s <= duration_s)
        self._frames.append(
            (time_s, time_s - ages_s[taxel].astype(float), taxel, measured.ravel()[taxel].astype(float))
        )
        while self._frames[0][0] < time_s - self._memory_s:
            self._frames.popleft()

    def near(self, x_m: float, y_m: float, reach_m: float, patch: int) -> tuple[Array, Array]:
        """When samples of the newest frame near a place were measured pressed, and when not [s]."""
        _, time_s, taxel, counts = self._frames[-1]
        near = self._lies_near(taxel, x_m, y_m, reach_m, patch)
        pressed = counts > self._touch_counts
        return time_s[near & pressed], time_s[near & ~pressed]

    def has_come(self, x_m: float, y_m: float, reach_m: float, patch: int) -> bool:
        """Whether what presses near a place in the newest frame has come since the last reset.

        So it is where a taxel there reads more than before, and in the end anywhere: what was there would have been
        found. Until then nobody knows of a taxel that was not measured before.
        """
        _, _, taxel, counts = self._frames[-1]
        if self._samples >= _SEARCHED * self._geometry.size:
            return True
        least = self._least_counts[taxel]
        # At the edge of what rests, noise alone goes up and down through the threshold.
        rise = min(_RISE_NOISES * self._noise_counts, _RISE_SHARE * self._touch_counts)
        risen = (least <= self._touch_counts) & (counts - least >= rise)
        return bool((risen & self._lies_near(taxel, x_m, y_m, reach_m, patch)).any())

    def _lies_near(
        self, taxel: NDArray[np.intp] | slice, x_m: float, y_m: float, reach_m: float, patch: int
    ) -> NDArray[np.bool_]:
        """Which of these taxels of a patch lie near a place."""
        is_near: NDArray[np.bool_] = np.hypot(self._x_m[taxel] - x_m, self._y_m[taxel] - y_m) <= reach_m
        return is_near & (self._patch_of[taxel] == patch)

    def untouched_s(self, x_m: float, y_m: float, patch: int, first_s: float, last_s: float) -> Array:
        """When the taxels around a place were measured and not pressed, between two times [s]."""
        geometry = self._geometry
        # So many taxels along the rows as along the columns, however far these are apart.
        square = geometry.pitch_m / geometry.pitch_y_m
        found = []
        for end_s, time_s, taxel, counts in self._frames:
            if end_s < first_s:
                continue
            away_m = np.hypot(self._x_m[taxel] - x_m, square * (self._y_m[taxel] - y_m))
            around = (away_m <= _AROUND_TAXELS * geometry.pitch_m) & (self._patch_of[taxel] == patch)
            free = around & (counts <= self._touch_counts) & (time_s > first_s) & (time_s < last_s)
            found.append(time_s[free])
        return np.concatenate(found) if found else np.zeros(0)

    def rise(
        self,
        first_s: float,
        last_s: float,
        x_m: float,
        y_m: float,
        patch: int,
        image: NDArray[np.float32],
        spread_m: float,
    ) -> Rise | None:
        """How the force rose at the taxel near a place that is pressed most; None where none is.

        Parameters
        ----------
        first_s, last_s : float
            From the time before the first pressed sample that is looked at, to the last [s].
        x_m, y_m : float
            Where it first touched [m].
        patch : int
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            When the force was largest until then.
        spread_m : float
            Standard deviation of the sideways spread of pressure in the foam [m].
        """
        geometry = self._geometry
        if not self._frames:  # of images that say nothing of single samples
            return None
        time_s, counts = (np.concatenate([one[k] for one in self._frames]) for k in (1, 3))
        taxel = np.concatenate([one[2] for one in self._frames])
        everywhere = slice(None)
        reach_m = _AROUND_TAXELS * max(geometry.pitch_m, geometry.pitch_y_m)
        around = self._lies_near(everywhere, x_m, y_m, reach_m, patch)
        seen = around[taxel] & (time_s >= first_s) & (time_s <= last_s)
        if not seen.any():
            return None
        least = _NOISES * self._noise_counts
        most = self._most_pressed(
            taxel[seen], time_s[seen], self._force(counts[seen]), counts[seen] > self._touch_counts
        )
        if most is None:
            return None
        seen &= taxel == most
        order = np.argsort(time_s[seen])
        time_s, counts = time_s[seen][order], counts[seen][order]
        pressed = counts > least
        # From the last reading of no more than noise before it was pressed enough.
        enough = int(np.argmax(counts > self._touch_counts))
        begin = enough
        while begin and pressed[begin - 1]:
            begin -= 1
        risen = begin + int(np.argmax(self._force(counts[begin:]) >= _RISEN * self._force(counts).max())) + 1
        whole = np.clip(np.rint(counts[begin:risen]), 0, self._force_n.size - 2).astype(np.intp)
        shown = self._force(np.where(image.ravel() > least, image.ravel(), 0.0))
        near = self._lies_near(everywhere, self._x_m[most], self._y_m[most], _WIDEST_M, patch)
        # Taxels at half of the force, each as far as it is above: the area is finer than a taxel.
        share = np.clip((shown[near] / max(float(shown[most]), 1e-9) - 0.5) / 0.25 + 0.5, 0.0, 1.0)
        blur_m2 = spread_m**2 + (geometry.pitch_m**2 + geometry.pitch_y_m**2) / 24
        return Rise(
            time_s[begin:risen],
            self._force(counts[begin:risen]),
            self._noise_counts * np.maximum(self._slope_n[whole], _LEAST_SLOPE_N),
            time_s[:begin],
            float(self._force(np.array([least]))[0]),
            float(share.sum()) * geometry.taxel_area_m2,
            blur_m2,
        )

    def _most_pressed(
        self, taxel: NDArray[np.intp], time_s: Array, force_n: Array, pressed: NDArray[np.bool_]
    ) -> int | None:
        """The taxel that is pressed most, of those that were measured early in their rise; None where there is none."""
        largest_n, first_n = np.zeros((2, self._geometry.size))
        np.maximum.at(largest_n, taxel, force_n)
        # Later samples first: the first pressed one of each taxel stays.
        order = np.argsort(-time_s)
        order = order[pressed[order]]
        first_n[taxel[order]] = force_n[order]
        early = (first_n > 0) & (first_n <= _EARLY * largest_n)
        return int(np.where(early, largest_n, 0.0).argmax()) if early.any() else None

    def _force(self, counts: Array | NDArray[np.float32]) -> Array:
        force_n: Array = np.where(counts > 0, np.interp(counts, np.arange(self._force_n.size), self._force_n), 0.0)
        return force_n

    def footprint(
        self, first_s: float, last_s: float, x_m: float, y_m: float, patch: int, spread_m: float
    ) -> Footprint | None:
        """The footprint that was pressed between two frames, both with; None where it cannot be told.

        Parameters
        ----------
        first_s, last_s : float
            Ends of the frames.
        x_m, y_m : float
            Middle of all it has touched [m].
        patch : int
        spread_m : float
            Root mean square distance of the force from there [m].
        """
        frames = [one for one in self._frames if first_s <= one[0] <= last_s]
        if not frames:
            return None
        time_s, counts = (np.concatenate([one[k] for one in frames]) for k in (1, 3))
        taxel = np.concatenate([one[2] for one in frames])
        reach_m = 3.0 * spread_m + _MARGIN_TAXELS * self._geometry.pitch_m
        near = self._lies_near(taxel, x_m, y_m, reach_m, patch)
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
