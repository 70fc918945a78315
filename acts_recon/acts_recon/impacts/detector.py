# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts in image after image: told when they begin, and again when they are over or become a part of another."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, Response
from acts_recon.contacts import BlobConfig, BlobTracker, TrackedBlob
from acts_recon.images import (
    LEAST_NOISE_COUNTS,
    LONGEST_PAUSE_S,
    Borders,
    borders_of,
    require_image,
    require_recovered,
)
from acts_recon.impacts.config import ImpactConfig
from acts_recon.impacts.impact import Impact
from acts_recon.impacts.reports import Reports
from acts_recon.impacts.samples import RecentSamples
from acts_recon.impacts.touch import Touch, area_of, lies_along, reach_m_of

# For how long a touch goes on that no sample speaks of: this, or so many frames.
_UNSEEN_S, _UNSEEN_FRAMES = 0.02, 2.5
_NUMBERS = 2**32


def _covers(blob: TrackedBlob, x_m: float, y_m: float) -> bool:
    return math.hypot(blob.x_m - x_m, blob.y_m - y_m) <= reach_m_of(blob)


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
        self._reports = Reports(self._samples, self.config)
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
        # Here, before anything is kept of the frame: the tracker would refuse them later.
        require_image("image", image, shape, must_be_contiguous=True)
        if sigma is not None:
            require_image("sigma", sigma, shape, must_be_contiguous=True)
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
                        begun.append(self._reports.so_far(touch))
                    else:
                        # All there is to tell: nothing.
                        touch.is_told = True
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
                        told.append(self._reports.so_far(touch, joined=other.number, until_s=time_s))
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
                        self._reports.over(touch, self._touches, period_s, self._frame_s)
                        if whole is None
                        else self._reports.so_far(touch, joined=whole.number, until_s=time_s)
                    )
                continue
            still.append(touch)
            is_late = time_s - touch.began_s > config.impact_longest_s
            if is_late and not touch.is_followed_back:
                touch.is_followed_back = True
                touch.slow_onset = self._reports.slow_onset(touch, time_s)
            rose = touch.peak_s - touch.began_s <= config.impact_rise_s
            if not touch.is_told and is_late and rose and touch.stays_after_impact():
                touch.is_told = True
                told.append(self._reports.over(touch, self._touches, period_s, self._frame_s, stays=True))
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
