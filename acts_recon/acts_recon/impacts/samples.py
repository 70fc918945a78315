# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The samples of the last frames, each with the time at which it was measured."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import Response, force_table
from acts_recon.images import Borders, borders_of, slope_table
from acts_recon.impacts.footprint_fit import Footprint, fit_footprint
from acts_recon.impacts.onset_fit import Rise
from acts_recon.impacts.touch import Area

Array = NDArray[np.float64]

_MARGIN_TAXELS = 2.0
# Of a contact the taxels nearer than this to its middle, four to six, tell when it began.
_MIDDLE_TAXELS = 1.13
# What lies nearer than this to where it first touches is soon touched, too.
_AROUND_TAXELS = 2.5
# A sample of more than this many standard deviations of the noise is no noise. With 3, noise began 2 of 200 touches,
# 15 ms early.
_NOISES = 4.0
_LEAST_SLOPE_N = 1e-7  # a count, where a measured response is flat
# Samples of a taxel that tell how a touch rose: at some thousand frames a second all would take too long.
_MOST_OF_A_RISE = 100
# Until this share of the largest force, a touch rises.
_RISEN = 0.9
# A reading has risen from an earlier one where it is higher by so many standard deviations of the noise, or by this
# share of what a touch is, whichever is less.
_RISE_NOISES, _RISE_SHARE = 5.0, 0.5
# With so many samples per taxel, what touches has been found. The search of `tracking`, which takes longest, gets a
# fifth of them.
_SEARCHED = 5
# From the taxel that is pressed most down to the foot of a contact the force may go up by this share, as sensitivities
# differ; beyond that the next finger begins.
_UPHILL = 1.15
# Where the stamps of frames stand still none becomes too old: so many samples are kept at most. Of a frame at least so
# many count, for what it takes besides. At the rate of any board these are the samples of some seconds.
_MOST_SAMPLES, _FRAME_SAMPLES = 2**20, 32
# Of the largest force: a contact ends at half of it, and a taxel counts in part from the first to the second, so that
# its area is finer than a taxel.
_FOOT, _WHOLE = 0.375, 0.625


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
        borders = borders or borders_of(geometry.rows, geometry.cols)
        self._patch_of, self._rectangles = borders.rectangle_of, borders.rectangles
        self._x_m, self._y_m = geometry.x_m(place % geometry.cols), geometry.y_m(place // geometry.cols)
        self._frames: deque[tuple[float, Array, NDArray[np.intp], Array]] = deque()
        # Since the last reset: of each taxel in all frames but the newest, and how many samples these have.
        self._least_counts = np.full(geometry.size, np.inf)
        self._samples = 0
        # In `_frames`, as `_MOST_SAMPLES` counts them.
        self._kept = 0

    def reset(self) -> None:
        """Forget all samples."""
        self._frames.clear()
        self._least_counts.fill(np.inf)
        self._samples = self._kept = 0

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
        self._kept += _FRAME_SAMPLES + taxel.size
        while self._frames[0][0] < time_s - self._memory_s or self._kept > _MOST_SAMPLES:
            self._kept -= _FRAME_SAMPLES + self._frames.popleft()[2].size

    def near(self, area: Area, patch: int, shown: NDArray[np.bool_] | None = None) -> tuple[Array, bool]:
        """When samples of the newest frame in an area were measured pressed [s], and whether others were free.

        Parameters
        ----------
        area : Area
        patch : int
        shown : np.ndarray [shape=(size,), dtype=bool], optional
            Which taxels an earlier image shows pressed: others do not count as free. Around a contact that stays, there
            are taxels that are never pressed.
        """
        _, time_s, taxel, counts = self._frames[-1]
        near = area.holds(self._x_m[taxel], self._y_m[taxel]) & (self._patch_of[taxel] == patch)
        pressed = counts > self._touch_counts
        free = near & ~pressed if shown is None else near & ~pressed & shown[taxel]
        return time_s[near & pressed], bool(free.any())

    def has_come(self, area: Area, patch: int) -> bool:
        """Whether what presses in an area in the newest frame has come since the last reset.

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
        is_near = area.holds(self._x_m[taxel], self._y_m[taxel]) & (self._patch_of[taxel] == patch)
        return bool((risen & is_near).any())

    def _lies_near(
        self, taxel: NDArray[np.intp] | slice, x_m: float, y_m: float, reach_m: float, patch: int
    ) -> NDArray[np.bool_]:
        """Which of these taxels of a patch lie near a place."""
        is_near: NDArray[np.bool_] = np.hypot(self._x_m[taxel] - x_m, self._y_m[taxel] - y_m) <= reach_m
        return is_near & (self._patch_of[taxel] == patch)

    def reach_of(self, patch: int) -> tuple[tuple[float, float], tuple[float, float]]:
        """From where to where a patch reaches along x and along y: what lies beyond is another one, or nothing [m]."""
        top, bottom, left, right = self._rectangles[patch].tolist()
        geometry = self._geometry
        return (
            (float(geometry.x_m(left - 0.5)), float(geometry.x_m(right - 0.5))),
            (float(geometry.y_m(bottom - 0.5)), float(geometry.y_m(top - 0.5))),
        )

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
        """How the force rose at the taxels around the middle of what presses near a place; None where none does.

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
        reach_m = _AROUND_TAXELS * max(geometry.pitch_m, geometry.pitch_y_m)
        around = self._lies_near(slice(None), x_m, y_m, reach_m, patch)
        pressing = self._pressing(around, patch, image)
        if pressing is None:
            return None
        share, middle_x_m, middle_y_m = pressing
        dx_m, dy_m = self._x_m - middle_x_m, self._y_m - middle_y_m
        middle = (np.hypot(dx_m / geometry.pitch_m, dy_m / geometry.pitch_y_m) <= _MIDDLE_TAXELS) & (share > 0)
        begun = (time_s >= first_s) & (time_s <= last_s)
        parts, felt_s = [], []
        for place in np.flatnonzero(middle):
            own = np.flatnonzero(begun & (taxel == place))
            own = own[np.argsort(time_s[own])][:: 1 + own.size // _MOST_OF_A_RISE]
            rising, first = self._rising(counts[own])
            if rising:
                parts.append(own[:rising])
                felt_s.append(float(time_s[own[first]]))
        if not parts:
            return None
        least = _NOISES * self._noise_counts
        kept = np.concatenate(parts)
        counts, number = counts[kept], np.repeat(np.arange(len(parts)), [part.size for part in parts])
        whole = np.clip(np.rint(np.maximum(counts, least)), 0, self._force_n.size - 2).astype(np.intp)
        unread_n, free_n = self._force(np.array([1.0, least])).tolist()
        return Rise(
            time_s=time_s[kept],
            force_n=self._force(counts),
            noise_n=self._noise_counts * np.maximum(self._slope_n[whole], _LEAST_SLOPE_N),
            is_pressed=counts > least,
            taxel=number,
            away_m2=np.array([dx_m[place] ** 2 + dy_m[place] ** 2 for place in (taxel[part[0]] for part in parts)]),
            felt_s=min(felt_s),
            unread_n=unread_n,
            free_n=free_n,
            area_m2=float(share.sum()) * geometry.taxel_area_m2,
            blur_m2=spread_m**2 + (geometry.pitch_m**2 + geometry.pitch_y_m**2) / 24,
        )

    def _pressing(
        self, around: NDArray[np.bool_], patch: int, image: NDArray[np.float32]
    ) -> tuple[Array, float, float] | None:
        """What presses near a place: the share of each taxel that belongs to it, and x and y of its middle [m].

        None where nothing does. `around` are the taxels near the place.
        """
        least = _NOISES * self._noise_counts
        shown_n = np.where(
            self._patch_of == patch, self._force(np.where(image.ravel() > least, image.ravel(), 0.0)), 0.0
        )
        most = int(np.where(around, shown_n, 0.0).argmax())
        if not around[most] or shown_n[most] <= 0:
            return None
        share = _hill((shown_n / shown_n[most]).reshape(image.shape), most).ravel()
        x_m, y_m = (float(share @ at) / float(share.sum()) for at in (self._x_m, self._y_m))
        if not share[self._nearest(x_m, y_m)]:  # of a ring
            x_m, y_m = float(self._x_m[most]), float(self._y_m[most])
        return share, x_m, y_m

    def _rising(self, counts: Array) -> tuple[int, int]:
        """How many of a taxel's samples, in order of time, are of the rise, and which is the first that is pressed.

        No sample is of the rise where none is pressed.
        """
        pressed = counts > self._touch_counts
        if not pressed.any():
            return 0, 0
        first = int(pressed.argmax())
        force_n = self._force(counts)
        return first + int(np.argmax(force_n[first:] >= _RISEN * force_n.max())) + 1, first

    def _nearest(self, x_m: float, y_m: float) -> int:
        """The taxel nearest to a place."""
        return int(np.hypot(self._x_m - x_m, self._y_m - y_m).argmin())

    def _force(self, counts: Array | NDArray[np.float32]) -> Array:
        force_n: Array = np.where(counts > 0, np.interp(counts, np.arange(self._force_n.size), self._force_n), 0.0)
        return force_n

    def footprint(
        self, first_s: float, last_s: float, x_m: float, y_m: float, patch: int, spread_m: float, others: Sequence[Area]
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
        others : sequence of Area
            Where what pressed before it goes on pressing: what was measured there is not of this one.
        """
        frames = [one for one in self._frames if first_s <= one[0] <= last_s]
        if not frames:
            return None
        time_s, counts = (np.concatenate([one[k] for one in frames]) for k in (1, 3))
        taxel = np.concatenate([one[2] for one in frames])
        reach_m = 3.0 * spread_m + _MARGIN_TAXELS * self._geometry.pitch_m
        near = self._lies_near(taxel, x_m, y_m, reach_m, patch)
        for other in others:
            near &= ~other.holds(self._x_m[taxel], self._y_m[taxel])
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


def _hill(force: Array, most: int) -> Array:
    """How far each taxel belongs to the contact of the taxel that is pressed most: 0 to 1, half where its edge is.

    Parameters
    ----------
    force : np.ndarray [shape=(rows, cols), dtype=float64]
        As a share of the force on that taxel.
    most : int
        Its place.
    """
    grown = np.zeros(force.shape, dtype=bool)
    grown.flat[most] = True
    while True:
        above = np.pad(np.where(grown, _UPHILL * force, 0.0), 1)
        beside = np.maximum.reduce([above[:-2, 1:-1], above[2:, 1:-1], above[1:-1, :-2], above[1:-1, 2:]])
        wider = grown | ((beside >= force) & (force > _FOOT))
        if (wider == grown).all():
            break
        grown = wider
    return np.where(grown, np.clip((force - _FOOT) / (_WHOLE - _FOOT), 0.0, 1.0), 0.0)
