# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts in image after image: told when they begin, and again when they are over or become a part of another."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, Response
from acts_recon.contacts import BlobConfig, BlobTracker, TrackedBlob
from acts_recon.images import LEAST_NOISE_COUNTS, LONGEST_PAUSE_S, Borders, borders_of, require_recovered
from acts_recon.impacts.config import ImpactConfig
from acts_recon.impacts.footprint_fit import FORCE_SD, Footprint
from acts_recon.impacts.impact import UNKNOWN_DIRECTION_SD_RAD, Impact, Kind
from acts_recon.impacts.onset_fit import follow_back, follow_back_impact
from acts_recon.impacts.samples import RecentSamples
from acts_recon.impacts.touch import Force, Touch, area_of, impulse_of, lies_along, reach_m_of

Array = NDArray[np.float64]

# For how long a touch goes on that no sample speaks of: this, or so many frames.
_UNSEEN_S, _UNSEEN_FRAMES = 0.02, 2.5
_UNSURE_S = 0.001
_NUMBERS = 2**32


def _covers(blob: TrackedBlob, x_m: float, y_m: float) -> bool:
    return math.hypot(blob.x_m - x_m, blob.y_m - y_m) <= reach_m_of(blob)


def _with_direction(impact: Impact, fitted: Footprint) -> Impact:
    """The same impact, with the way that its footprint went."""
    vx, vy = fitted.velocity_m_s.tolist()
    sd_x, sd_y = np.sqrt(np.diag(fitted.covariance)).tolist()
    return replace(
        impact,
        direction_rad=math.atan2(vy, vx),
        direction_sd_rad=min(fitted.direction_sd_rad, UNKNOWN_DIRECTION_SD_RAD),
        velocity_m_s=(vx, vy),
        velocity_sd_m_s=(sd_x, sd_y),
    )


class ImpactDetector:
    """Tells each touch of the skin when it begins, and what it was when it is over; or that it has joined another.

    What touches already when frames begin to come, for the first time or after a `reset`, is not told, because nobody
    knows when it began. Images without samples do not say what was measured, so there it is.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the images.
    response : Response, optional
        From counts to newtons.
    blobs : BlobConfig, optional
        What is a contact in an image, and the noise of a reading.
    config : ImpactConfig, optional
    borders : Borders, optional
        No contact reaches over one, and contacts on its two sides are never one impact.
    stood_on : bool or None, optional
        Whether somebody steps on the skin; see `ImpactConfig.on`.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response | None = None,
        blobs: BlobConfig | None = None,
        config: ImpactConfig | None = None,
        borders: Borders | None = None,
        *,
        stood_on: bool | None = None,
    ) -> None:
        self.config = (config or ImpactConfig()).on(stood_on=stood_on)
        blobs = blobs or BlobConfig()
        response = response or ForceResponse()
        self._geometry = geometry
        self._touch_counts = blobs.touch_counts
        self._borders = borders or borders_of(geometry.rows, geometry.cols)
        self._tracker = BlobTracker(geometry, response, blobs, self._borders)
        memory_s = self.config.impact_longest_s + self.config.impact_quiet_s + 0.1
        noise_counts = max(blobs.noise_counts, LEAST_NOISE_COUNTS)
        self._samples = RecentSamples(
            geometry, response, float(blobs.touch_counts), noise_counts, memory_s, self._borders
        )
        self._touches: list[Touch] = []
        self._next_number = 1
        self._before_s: float | None = None
        self._frame_s = 0.0
        self._period_s = 0.0
        # Which taxels the image of the frame before shows pressed.
        self._shown = np.zeros(geometry.size, dtype=bool)

    def reset(self) -> None:
        """Forget all touches, without telling of them again; numbers go on."""
        self._tracker.reset()
        self._samples.reset()
        self._touches.clear()
        self._before_s = None
        self._shown[:] = False

    def step(
        self,
        time_s: float,
        duration_s: float,
        image: NDArray[np.float32],
        sigma: NDArray[np.float32] | None = None,
        age_s: NDArray[np.float32] | None = None,
        measured: NDArray[np.float32] | None = None,
    ) -> tuple[Impact, ...]:
        """Look at the image of the next frame.

        Parameters
        ----------
        time_s, duration_s : float
            When the frame's last measurement ended, and how long all of them took [s]. Where the time goes back, or on
            by more than half a second, all touches are forgotten.
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts; C-contiguous.
        sigma : np.ndarray [shape=(rows, cols), dtype=float32], optional
            Standard deviation of each taxel [counts]; without it those of forces are 0.
        age_s, measured : np.ndarray [shape=(rows, cols), dtype=float32], optional
            How long before `time_s` each taxel was measured [s], and what [counts]. Without them directions are not
            known, and a frame has seen what its image shows.

        Returns
        -------
        tuple of Impact
            What has begun with this frame, what has become a part of another touch, and what is over.

        Raises
        ------
        ArrayError
            When an image is of another kind or size, or what is given not finite (but `age_s`), or a time negative.
        """
        shape = self._geometry.rows, self._geometry.cols
        require_recovered(shape, time_s, duration_s, image=image, sigma=sigma, age_s=age_s, measured=measured)
        if self._before_s is not None and not 0.0 <= time_s - self._before_s <= LONGEST_PAUSE_S:
            self.reset()
        before_s = time_s - duration_s if self._before_s is None or self._before_s == time_s else self._before_s
        self._before_s = time_s
        self._frame_s = duration_s
        self._period_s = time_s - before_s
        if age_s is not None and measured is not None:
            self._samples.add(time_s, duration_s, measured, age_s)
            is_sampled = True
        else:
            is_sampled = False
        found = self._tracker.step(image, time_s, sigma)
        told = self._follow(found, time_s, before_s, is_sampled, image) if found else []
        if self._touches:
            told += self._end(time_s, time_s - before_s, image)
        np.greater(image.ravel(), self._touch_counts, out=self._shown)
        return tuple(told)

    def _follow(
        self,
        found: tuple[TrackedBlob, ...],
        time_s: float,
        before_s: float,
        is_sampled: bool,
        image: NDArray[np.float32],
    ) -> list[Impact]:
        """Give each contact to the touch that it belongs to; tell of the touches that begin."""
        parts: dict[int, list[TrackedBlob]] = {}
        for blob in sorted(found, key=lambda one: -one.force_n):
            patch = self._patch(blob)
            touch = self._nearest(blob, patch)
            if touch is None:
                touch = Touch(self._next_number, patch, time_s, before_s)
                touch.x_m, touch.y_m = blob.x_m, blob.y_m
                self._next_number = self._next_number % (_NUMBERS - 1) + 1
                self._touches.append(touch)
            parts.setdefault(touch.number, []).append(blob)
        begun = []
        for touch in list(self._touches):
            blobs = parts.get(touch.number, [])
            if blobs and self._is_felt(touch, blobs, time_s, is_sampled):
                is_first = not len(touch.rows)
                touch.add(time_s, blobs, image, self.config)
                if is_first:
                    if not is_sampled or self._samples.has_come(area_of(blobs), touch.patch):
                        begun.append(self._so_far(touch))
                    else:
                        touch.is_told = True  # all there is to tell: nothing
            elif not touch.frames_seen:
                # The image goes on showing what was measured before: that is no new touch.
                self._touches.remove(touch)
        # After those that are no touch have gone: none joins one of them.
        return self._joined(parts, time_s, image) + begun

    def _joined(self, parts: dict[int, list[TrackedBlob]], time_s: float, image: NDArray[np.float32]) -> list[Impact]:
        """Tell of touches whose contacts have grown into that of another, and forget them."""
        told = []
        for touch in [one for one in self._touches if one.number not in parts]:
            for other in self._touches:
                blobs = parts.get(other.number, [])
                if other.patch == touch.patch and any(self._has_taken(blob, touch, image) for blob in blobs):
                    self._touches.remove(touch)
                    if not touch.is_told:
                        told.append(self._so_far(touch, joined=other.number, until_s=time_s))
                    break
        return told

    def _has_taken(self, blob: TrackedBlob, touch: Touch, image: NDArray[np.float32]) -> bool:
        """Whether a contact lies where a touch was."""
        if _covers(blob, touch.x_m, touch.y_m):
            return True
        return lies_along(blob, touch.x_m, touch.y_m) and self._is_pressed_at(touch, image)

    def _is_felt(self, touch: Touch, blobs: list[TrackedBlob], time_s: float, is_sampled: bool) -> bool:
        """Whether this frame's own samples show the touch, or say nothing of it."""
        if not is_sampled:
            touch.see(np.array([time_s]))
            return True
        # What bounces is gone before many of its taxels were measured: there each free sample counts. But not about a
        # long one, which need not be straight.
        area = area_of(blobs)
        is_short = time_s - touch.began_s <= self.config.impact_longest_s and not area.is_long
        pressed_s, is_left = self._samples.near(area, touch.patch, None if is_short else self._shown)
        if pressed_s.size:
            touch.see(pressed_s)
        # Where a frame has measured nothing that speaks against it, it says nothing; but not for long.
        unseen_s = max(_UNSEEN_S, _UNSEEN_FRAMES * self._period_s)
        is_unseen = not is_left and time_s - touch.last_sample_s <= unseen_s
        return bool(pressed_s.size) or bool(touch.frames_seen and is_unseen)

    def _patch(self, blob: TrackedBlob) -> int:
        row, col = self._place(blob.x_m, blob.y_m)
        return int(self._borders.rectangle_of[row * self._geometry.cols + col])

    def _place(self, x_m: float, y_m: float) -> tuple[int, int]:
        """Row and column of a place."""
        return round(float(self._geometry.row_of(y_m))), round(float(self._geometry.col_of(x_m)))

    def _nearest(self, blob: TrackedBlob, patch: int) -> Touch | None:
        nearest, nearest_m = None, math.inf
        for touch in self._touches:
            distance_m = math.hypot(blob.x_m - touch.x_m, blob.y_m - touch.y_m)
            is_there = distance_m <= self._reach_m(touch)
            # Of a long contact a piece may lie far from its centre.
            is_there = is_there or (touch.area is not None and bool(touch.area.holds(blob.x_m, blob.y_m)))
            if touch.patch == patch and is_there and distance_m < nearest_m:
                nearest, nearest_m = touch, distance_m
        return nearest

    def _reach_m(self, touch: Touch) -> float:
        """How far from its centre a touch may be met [m]: of a large contact the centre may be far away."""
        return max(self.config.impact_join_m, touch.reach_m)

    def _so_far(self, touch: Touch, *, joined: int = 0, until_s: float | None = None) -> Impact:
        """What is known of a touch that has begun, or now becomes a part of another."""
        onset_s, onset_sd_s = touch.onset(self._untouched_before(touch))
        return Impact(
            number=touch.number,
            is_over=False,
            kind=Kind.UNKNOWN,
            joined=joined,
            onset_s=onset_s,
            onset_sd_s=onset_sd_s,
            duration_s=0.0 if until_s is None else max(float(until_s - onset_s), 0.0),
            frames=touch.frames_seen,
            x_m=touch.x_m,
            y_m=touch.y_m,
            peak_n=touch.peak_n,
            peak_sd_n=touch.peak_sd_n,
        )

    def _untouched_before(self, touch: Touch) -> NDArray[np.float64]:
        first_s = 2 * touch.before_s - touch.began_s
        return self._samples.untouched_s(*touch.start_m, touch.patch, first_s, touch.first_sample_s)

    def _end(self, time_s: float, period_s: float, image: NDArray[np.float32]) -> list[Impact]:
        """Tell of the touches that are over, and of impacts that stay on the skin."""
        config = self.config
        told, still = [], []
        for touch in self._touches:
            gone_s = time_s - touch.last_s
            if gone_s > 0 and gone_s >= config.impact_quiet_s:
                if not touch.is_told:
                    whole = self._whole_of(touch, image)
                    told.append(
                        self._over(touch, period_s)
                        if whole is None
                        else self._so_far(touch, joined=whole.number, until_s=time_s)
                    )
                continue
            still.append(touch)
            is_late = time_s - touch.began_s > config.impact_longest_s
            if is_late and not touch.is_followed_back:
                touch.is_followed_back = True
                touch.slow_onset = self._followed_back(touch, time_s)
            rose = touch.peak_s - touch.began_s <= config.impact_rise_s
            if not touch.is_told and is_late and rose and touch.stays_after_impact():
                touch.is_told = True
                told.append(self._over(touch, period_s, stays=True))
        self._touches = still
        return told

    def _whole_of(self, touch: Touch, image: NDArray[np.float32]) -> Touch | None:
        """The touch that one which is not felt any more has become a part of: the skin there is still pressed."""
        if not self._is_pressed_at(touch, image):
            return None
        others = (
            other
            for other in self._touches
            if other.patch == touch.patch
            and other.last_s > touch.last_s
            and math.dist((other.x_m, other.y_m), (touch.x_m, touch.y_m)) <= self._reach_m(other)
        )
        return max(others, key=lambda other: other.last_s, default=None)

    def _is_pressed_at(self, touch: Touch, image: NDArray[np.float32]) -> bool:
        row, col = self._place(touch.x_m, touch.y_m)
        top, bottom, left, right = self._borders.rectangles[touch.patch].tolist()
        around = image[max(row - 1, top) : min(row + 2, bottom), max(col - 1, left) : min(col + 2, right)]
        return bool(around.max() > self._touch_counts)

    def _over(self, touch: Touch, period_s: float, *, stays: bool = False) -> Impact:
        """What a touch was that is over, or an impact that stays on the skin."""
        is_short = stays or touch.last_s - touch.began_s <= self.config.impact_longest_s
        course = touch.path()
        found = self._footprint(touch, *course) if is_short else None
        x_m, y_m, peak_n, peak_sd_n = touch.peak_x_m, touch.peak_y_m, touch.peak_n, touch.peak_sd_n
        fitted = found if found is not None and found.is_better_than_images(peak_n, peak_sd_n) else None
        if fitted is not None:
            # Between taxels that were just measured an image is a guess, which is far off where taxels saturate.
            course = fitted.time_s, fitted.force_n, *fitted.path(fitted.time_s)
            top = int(fitted.force_n.argmax())
            peak_n, x_m, y_m = (float(one[top]) for one in course[1:])
            peak_sd_n = FORCE_SD * peak_n
        time_s, force_n, path_x_m, path_y_m = course
        force = time_s, force_n
        onset_s, onset_sd_s = self._onset(touch, force, found, is_short)
        end_s = touch.last_s if stays else self._last_touched(touch, force if is_short else None, period_s)
        kind = Kind.IMPACT if stays else touch.kind(onset_s, end_s, self._frame_s, self.config)
        impulse_n_s = impulse_of(force, onset_s, end_s if is_short else float(time_s[-1]))
        told = Impact(
            number=touch.number,
            is_over=True,
            kind=kind,
            onset_s=onset_s,
            onset_sd_s=onset_sd_s,
            duration_s=max(end_s - onset_s, 0.0),
            frames=touch.frames_seen,
            x_m=x_m,
            y_m=y_m,
            peak_n=peak_n,
            peak_sd_n=peak_sd_n,
            bounced=kind is Kind.IMPACT and not stays,
            impulse_n_s=impulse_n_s,
            impulse_sd_n_s=FORCE_SD * impulse_n_s if fitted is not None else impulse_n_s * peak_sd_n / peak_n,
            time_s=time_s,
            force_n=force_n,
            path_x_m=path_x_m,
            path_y_m=path_y_m,
        )
        # Along something long no motion is seen.
        if fitted is None or fitted.is_long or kind is not Kind.IMPACT:
            return told
        return _with_direction(told, fitted)

    def _onset(self, touch: Touch, force: Force, fitted: Footprint | None, is_short: bool) -> tuple[float, float]:
        """When a touch that is over first touched, and the standard deviation [s]."""
        followed = None if fitted is None else follow_back_impact(fitted)
        of_images = force if is_short and fitted is None else None
        onset_s, onset_sd_s = touch.onset(self._untouched_before(touch), of_images, followed)
        # What taps for long may look like an impact that stays; the onset of one that is none is hardly known so.
        if touch.slow_onset is not None and (not is_short or onset_sd_s > _UNSURE_S):
            return touch.slow_onset
        return onset_s, onset_sd_s

    def _last_touched(self, touch: Touch, force: Force | None, period_s: float) -> float:
        """When a touch that is over was last touched [s]."""
        free_s = self._samples.untouched_s(touch.x_m, touch.y_m, touch.patch, touch.last_sample_s, math.inf)
        return touch.end(free_s, touch.last_sample_s + 1.5 * period_s, force)[0]

    def _followed_back(self, touch: Touch, time_s: float) -> tuple[float, float] | None:
        """When a touch that is no impact began, and the standard deviation [s]."""
        first_s = touch.first_sample_s - self.config.impact_longest_s
        rise = self._samples.rise(
            first_s, time_s, *touch.start_m, touch.patch, touch.peak_image, self.config.impact_foam_spread_m
        )
        return None if rise is None else follow_back(rise)

    def _footprint(self, touch: Touch, time_s: Array, force_n: Array, x_m: Array, y_m: Array) -> Footprint | None:
        total = float(force_n.sum())
        middle_m = float(force_n @ x_m) / total, float(force_n @ y_m) / total
        away_m2 = (x_m - middle_m[0]) ** 2 + (y_m - middle_m[1]) ** 2
        spread_m = math.sqrt(float(force_n @ away_m2) / total + touch.spread_m**2)
        before_s = touch.began_s - self.config.impact_longest_s  # what begins later may be a piece of the same
        others = [one.area for one in self._touches if one.began_s < before_s and one.patch == touch.patch and one.area]
        return self._samples.footprint(float(time_s[0]), float(time_s[-1]), *middle_m, touch.patch, spread_m, others)
