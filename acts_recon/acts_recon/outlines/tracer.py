# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines of all contacts, frame by frame."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS, ArrayGeometry
from acts_core.skin import ForceResponse, Layout, Response, force_table
from acts_recon.images import LONGEST_PAUSE_S, NOISE_COUNTS, PlacedSamples, borders_of, require_recovered
from acts_recon.outlines.config import OutlinesConfig
from acts_recon.outlines.contours import area, contours
from acts_recon.outlines.edge_filter import EdgeFilter
from acts_recon.outlines.outline import Outline

Array = NDArray[np.float64]

MOST_OUTLINES = 16
"""In one frame; of the largest contacts."""

# What is pressed further from the contacts of the last look is new, or has moved fast [taxels].
_BESIDE = 2
_LEAST_TAXELS = 3
# A reading above so many standard deviations is of a pressed taxel.
_NOISE = 4.0
# Samples further outside of an edge say nothing of it [taxels].
_OUTSIDE = 4.0
# From a force of the edge over this to one times this a taxel changes from outside to inside.
_BAND = 3.0
# Of the taxels of a contact this share press less than what the level is a share of: not the largest of an image,
# which is a guess where taxels saturate.
_TOP = 0.6
_LEAST_AREA = 0.3
_NUMBERS = 2**32


def load() -> None:
    """Import what `OutlineTracer.step` uses, so that the first frame does not wait for it, up to a second."""
    import scipy.ndimage  # noqa: F401


class _Track:
    """One contact while it lasts."""

    def __init__(self, number: int, began_s: float) -> None:
        self.number, self.began_s = number, began_s
        self.mask: NDArray[np.bool_] = np.zeros((0, 0), dtype=np.bool_)
        self.edge: EdgeFilter | None = None
        self.is_felt = False
        self.last: Outline | None = None


class _Frame(NamedTuple):
    """One frame, as the outlines of all contacts are found in it.

    Attributes
    ----------
    labels : np.ndarray [shape=(rows, cols), dtype=intp]
        The number of the contact of each taxel, 0: none.
    force_n : np.ndarray [shape=(rows, cols), dtype=float64]
        Of the image, where taxels of this frame have what was measured.
    row, col : np.ndarray [shape=(m,), dtype=uint16]
        Where each sample was measured in the picture.
    sampled_n : np.ndarray [shape=(m,), dtype=float64]
        Its force, 0 for noise.
    since_ms : np.ndarray [shape=(m,), dtype=float64]
        When it was measured, from the frame's middle on [ms].
    middle_s, duration_s : float
        When the middle of the frame was, and how long it took [s].
    """

    labels: NDArray[np.intp]
    force_n: Array
    row: NDArray[np.uint16]
    col: NDArray[np.uint16]
    sampled_n: Array
    since_ms: Array
    middle_s: float
    duration_s: float


class OutlineTracer:
    """Follows contacts, and finds the outline of each in every frame.

    Young contacts are followed by their edge (see `edge_filter`), older ones have the contour of the image.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the images.
    response : Response, optional
        From counts to newtons.
    touch_counts : float
        A taxel above is pressed.
    noise_counts : float
        Standard deviation of a reading.
    config : OutlinesConfig, optional
    layout : Layout, optional
        No outline reaches over a border of its patches.
    dead : np.ndarray [shape=(rows, cols), dtype=bool], optional
        Which taxels of the picture are dead, so that no sample is of them.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response | None = None,
        touch_counts: float = TOUCH_COUNTS,
        noise_counts: float = NOISE_COUNTS,
        config: OutlinesConfig | None = None,
        layout: Layout | None = None,
        dead: NDArray[np.bool_] | None = None,
    ) -> None:
        self.config = config or OutlinesConfig()
        self._dead = dead
        self._geometry = geometry
        self._shape = geometry.rows, geometry.cols
        self._samples = PlacedSamples(geometry, layout)
        self._borders = borders_of(geometry.rows, geometry.cols, layout)
        self._rectangles: list[list[int]] = self._borders.rectangles.tolist()
        self._rectangle_of = self._borders.rectangle_of.reshape(self._shape)
        self._force_n = force_table(response or ForceResponse())
        self._touch_counts = touch_counts
        self._least_n = float(np.interp(touch_counts, np.arange(self._force_n.size), self._force_n))
        self._noise_counts = _NOISE * noise_counts
        self._tracks: list[_Track] = []
        self._next_number = 1
        self._before_s: float | None = None
        self._known = np.zeros(self._shape, dtype=np.bool_)

    def reset(self) -> None:
        """Forget all contacts; numbers go on."""
        self._tracks.clear()
        self._before_s = None

    def skip(self, end_s: float, image: NDArray[np.float32]) -> bool:
        """Pass over a frame that shows only contacts whose outlines hardly change from frame to frame.

        Parameters
        ----------
        end_s, image
            As of `step`.

        Returns
        -------
        bool
            False where the frame is one for `step`: a contact is young, one has begun, ended or moved fast, or there
            was none.

        Raises
        ------
        ArrayError
            When the time or the image is not finite, or the image of another size.
        """
        require_recovered(self._shape, end_s, 0.0, image=image)
        if not self._tracks or not self._follows(end_s):
            return False
        pressed = image > self._touch_counts
        oldest_s = end_s - self.config.outlines_fast_s
        if any(
            track.began_s >= oldest_s or track.edge is not None or not pressed[track.mask].any()
            for track in self._tracks
        ):
            return False
        if (pressed & ~self._known).any():
            return False
        self._before_s = end_s
        return True

    def _follows(self, end_s: float) -> bool:
        """Whether a time lies soon after that of the frame before."""
        return self._before_s is None or 0.0 <= end_s - self._before_s <= LONGEST_PAUSE_S

    def step(
        self,
        indices: NDArray[np.uint16],
        counts: NDArray[np.uint16],
        end_s: float,
        duration_s: float,
        image: NDArray[np.float32],
    ) -> tuple[Outline, ...]:
        """Look at the next frame.

        Parameters
        ----------
        indices, counts, end_s, duration_s
            Of the frame, as of `FusionEstimator.step`. Where the time goes back, or on by more than half a second, all
            contacts are forgotten.
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts, recovered from it.

        Returns
        -------
        tuple of Outline
            One of each contact that has one.

        Raises
        ------
        ArrayError
            When frame or image are of another kind or size, or not finite.
        """
        require_recovered(self._shape, end_s, duration_s, image=image)
        places, placed_counts = self._samples.of(indices, counts)
        if not self._follows(end_s):
            self.reset()
        self._before_s = end_s
        if not (image > self._touch_counts).any():
            self._tracks.clear()
            return ()
        labels, number = self._labels(image)
        frame = self._frame(labels, image, places, placed_counts, end_s, duration_s)
        tracks = self._match(labels, number, frame.middle_s)
        found = []
        sizes = np.bincount(labels.ravel(), minlength=number + 1)
        for label, track in sorted(tracks, key=lambda one: -int(sizes[one[0]]))[:MOST_OUTLINES]:
            outline = self._outline(track, self._corners(track, label, frame), frame.middle_s)
            if outline is not None:
                found.append(outline)
            track.last = outline
        return tuple(sorted(found, key=lambda outline: outline.number))

    def _frame(
        self,
        labels: NDArray[np.intp],
        image: NDArray[np.float32],
        places: NDArray[np.uint16],
        counts: NDArray[np.uint16],
        end_s: float,
        duration_s: float,
    ) -> _Frame:
        values = np.arange(self._force_n.size)
        # The image predicts what was measured to the end of the frame, too far where a touch rises within a few frames.
        # An outline is of the frame's middle, and its samples are compared with forces: those of the same samples.
        measured = image.copy()
        measured.ravel()[places] = counts
        force_n = np.where(measured > 0, np.interp(measured, values, self._force_n), 0.0)
        sampled_n = np.where(counts > self._noise_counts, np.interp(counts, values, self._force_n), 0.0)
        # The last sample ends with the frame; they are evenly spaced.
        before_end = np.arange(places.size)[::-1] / max(places.size, 1)
        row, col = places // self._shape[1], places % self._shape[1]
        since_ms = 1e3 * duration_s * (0.5 - before_end)
        return _Frame(labels, force_n, row, col, sampled_n, since_ms, end_s - duration_s / 2, duration_s)

    def _labels(self, image: NDArray[np.float32]) -> tuple[NDArray[np.intp], int]:
        """The number of the contact of each taxel, 0: none, and how many there are."""
        from scipy import ndimage

        pressed = image > self._touch_counts
        self._known[:] = False
        for first_row, end_row, first_col, end_col in self._rectangles:
            there = np.s_[first_row:end_row, first_col:end_col]
            if pressed[there].any():
                self._known[there] = ndimage.maximum_filter(pressed[there], size=2 * _BESIDE + 1)
        return self._borders.labelled(pressed)

    def _match(self, labels: NDArray[np.intp], number: int, time_s: float) -> list[tuple[int, _Track]]:
        """Give each contact of the image to the track that covered most of it; the others begin."""
        shared = []
        for track in self._tracks:
            covered = np.bincount(labels[track.mask], minlength=number + 1)
            shared += [(int(covered[label]), label, track) for label in range(1, number + 1) if covered[label]]
        matched: dict[int, _Track] = {}
        for _, label, track in sorted(shared, key=lambda one: (-one[0], one[2].number)):
            if label not in matched and track not in matched.values():
                matched[label] = track
        for label in range(1, number + 1):
            if label not in matched:
                matched[label] = _Track(self._next_number, time_s)
                self._next_number = self._next_number % (_NUMBERS - 1) + 1
            matched[label].mask = labels == label
        self._tracks = list(matched.values())
        return sorted(matched.items())

    def _corners(self, track: _Track, label: int, frame: _Frame) -> Array:
        """Rows and columns of the outline of a contact, shape (n, 2); empty where there is none."""
        inside, row, col, sampled_n = track.mask, frame.row, frame.col, frame.sampled_n
        level_n = max(self.config.outlines_level * float(np.quantile(frame.force_n[inside], _TOP)), self._least_n)
        age_s = frame.middle_s - track.began_s
        # Between what was measured an image is a guess, which may show contacts that are none.
        track.is_felt = track.is_felt or bool((sampled_n[inside[row, col]] > self._least_n).any())
        if not track.is_felt:
            return np.zeros((0, 2))
        if age_s > self.config.outlines_fast_s:
            if track.edge is not None:
                # Found in another way, the outline has not grown by what the two differ.
                track.edge = track.last = None
            return self._contour(frame, label, level_n)
        if track.edge is None:
            edge = self._begun(frame, inside, level_n, 1e3 * age_s)
            if edge is None:
                return np.zeros((0, 2))
            track.edge = edge
        else:
            edge = track.edge
            edge.predict(1e3 * age_s)
        patch = self._rectangle_of[inside][0]
        on_patch = self._rectangle_of == patch
        edge.round_off(on_patch if self._dead is None else on_patch & ~self._dead)
        other = (frame.labels > 0) & (frame.labels != label) | ~on_patch
        near = ~other[row, col] & (np.hypot(row - edge.row, col - edge.col) < edge.radius + _OUTSIDE)
        share = np.log(np.maximum(sampled_n[near] / level_n, 1e-6)) / (2 * np.log(_BAND))
        share = np.clip(0.5 + share, 0.0, 1.0)
        edge.update(row[near].astype(float), col[near].astype(float), frame.since_ms[near], share)
        first_row, end_row, first_col, end_col = self._rectangles[patch]
        return np.clip(edge.corners(), (first_row - 0.5, first_col - 0.5), (end_row - 0.5, end_col - 0.5))

    def _begun(self, frame: _Frame, inside: NDArray[np.bool_], level_n: float, since_ms: float) -> EdgeFilter | None:
        rows, cols = np.nonzero(inside)
        if rows.size < _LEAST_TAXELS:
            return None
        weights = frame.force_n[inside]
        whole = float(weights.sum())
        # The image may show what this frame has measured to be nothing.
        if whole <= 0:
            return None
        radius = math.sqrt(max(int(np.count_nonzero(weights > level_n)), 1) / math.pi)
        row, col = float(rows @ weights) / whole, float(cols @ weights) / whole
        return EdgeFilter(row, col, radius, radius / (1e3 * frame.duration_s + 1e-3), since_ms)

    def _contour(self, frame: _Frame, label: int, level_n: float) -> Array:
        """The largest contour of one contact in the image."""
        from scipy import ndimage

        mine = frame.labels == label
        first_row, end_row, first_col, end_col = self._rectangles[self._rectangle_of[mine][0]]
        there = np.s_[first_row:end_row, first_col:end_col]
        # Its own taxels and those beside it; between taxels the root of the force is nearer to a straight line.
        field = np.where(ndimage.maximum_filter(mine[there], size=3), np.sqrt(frame.force_n[there]), 0.0)
        loops = contours(field, float(np.sqrt(level_n)))
        largest = max(loops, key=area, default=np.zeros((0, 2)))
        if len(largest) < 3 or area(largest) < _LEAST_AREA:
            return np.zeros((0, 2))
        # At a border the field ends with 0, so that a hard pressed taxel's level lies up to a taxel beyond it.
        shifted = largest + np.array([first_row, first_col])
        return np.clip(shifted, (first_row - 0.5, first_col - 0.5), (end_row - 0.5, end_col - 0.5))

    def _outline(self, track: _Track, corners: Array, time_s: float) -> Outline | None:
        # Of an edge that is followed beyond its patch, little or nothing is left within it.
        if not len(corners) or abs(area(corners)) < _LEAST_AREA:
            return None
        x_m = np.asarray(self._geometry.x_m(corners[:, 1]), dtype=np.float64)
        y_m = np.asarray(self._geometry.y_m(corners[:, 0]), dtype=np.float64)
        outline = Outline(track.number, time_s, x_m, y_m)
        if outline.area_m2 < 0:
            outline = Outline(track.number, time_s, x_m[::-1].copy(), y_m[::-1].copy())
        before = track.last
        if before is None:
            return outline
        passed_s = time_s - before.time_s
        # Of two frames of one time nobody knows how fast it grew in between.
        growth = (outline.area_m2 - before.area_m2) / passed_s if passed_s > 0 else before.growth_m2_s
        return Outline(track.number, time_s, outline.x_m, outline.y_m, growth)
