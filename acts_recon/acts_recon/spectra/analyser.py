# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spectra of what touches the skin, out of the samples of the last second."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS, ArrayGeometry
from acts_core.skin import ForceResponse, Layout, Response, force_table
from acts_recon.images import (
    LEAST_NOISE_COUNTS,
    LONGEST_PAUSE_S,
    NOISE_COUNTS,
    DeadTaxels,
    PlacedSamples,
    borders_of,
    require_times,
    slope_table,
)
from acts_recon.spectra.config import SpectraConfig
from acts_recon.spectra.spectrum import Spectrum
from acts_recon.spectra.tones import Tones

Array = NDArray[np.float64]

# Of a window: with less there is no spectrum yet.
_LEAST_SHARE = 0.5
_LEAST_SLOPE_N = 1e-7  # a count, where a measured response is flat
# A window is looked at in so many parts: whether the contact was there.
_PARTS = 20
# The strongest of a contact; a palm is a thousand.
_MOST_TAXELS = 64
# Of the values of a spectrum every second is told: a tone is as wide as eight.
_TOLD_EVERY = 2
# Where the stamps of frames stand still none becomes too old: so many samples are kept at most. Of a frame at least so
# many count, for what it takes besides. They are more than a board measures in the longest window.
_MOST_SAMPLES, _FRAME_SAMPLES = 2**23, 32


class PlacedFrame(NamedTuple):
    """The samples of one frame: when it ended and how long it took [s], places in the picture, and counts there."""

    end_s: float
    duration_s: float
    places: NDArray[np.uint16]
    counts: NDArray[np.float32]


class _Window(NamedTuple):
    """Samples in the order of measurement, with the time of each; the time from one of a taxel to its next [s]."""

    time_s: Array
    places: NDArray[np.uint16]
    counts: NDArray[np.float32]
    step_s: float


class SpectrumAnalyser:
    """Keeps the samples of the last frames; makes spectra of them.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the picture.
    response : Response, optional
        From counts to newtons.
    touch_counts : float
        A taxel is touched whose mean is above, or half of whose readings are.
    noise_counts : float
        Standard deviation of a reading.
    config : SpectraConfig, optional
    layout : Layout, optional
        No contact reaches over a border of its patches.
    dead : DeadTaxels, optional
        Those of the skin: a contact across them is one, if what the taxels around say of them is touched, too.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response | None = None,
        touch_counts: float = TOUCH_COUNTS,
        noise_counts: float = NOISE_COUNTS,
        config: SpectraConfig | None = None,
        layout: Layout | None = None,
        dead: DeadTaxels | None = None,
    ) -> None:
        self.config = config or SpectraConfig()
        self._dead = dead
        self._geometry = geometry
        self._shape = geometry.rows, geometry.cols
        self._samples = PlacedSamples(geometry, layout)
        self._borders = borders_of(geometry.rows, geometry.cols, layout)
        self._force_n = force_table(response or ForceResponse())
        # Below it there is no force.
        self._force_n[0] = 0.0
        self._slope_n = slope_table(self._force_n)
        self._touch_counts = touch_counts
        self._noise_counts = max(noise_counts, LEAST_NOISE_COUNTS)
        self._frames: deque[PlacedFrame] = deque()
        # In these frames, as `_MOST_SAMPLES` counts them.
        self._kept = 0

    def reset(self) -> None:
        """Forget all samples."""
        self._frames.clear()
        self._kept = 0

    def add(
        self,
        indices: NDArray[np.uint16],
        counts: NDArray[np.uint16],
        end_s: float,
        duration_s: float,
        *,
        may_repeat: bool = False,
    ) -> None:
        """Keep the samples of the next frame; parameters and errors as of `FusionEstimator.step`.

        With `may_repeat` a frame may have a taxel several times: then faster vibrations are found. Where the time goes
        back, or on by more than half a second, those before are forgotten.
        """
        require_times(end_s, duration_s)
        placed, counts = self._samples.of(indices, counts, may_repeat=may_repeat)
        if self._frames and not 0.0 <= end_s - self._frames[-1].end_s <= LONGEST_PAUSE_S:
            self.reset()
        self._frames.append(PlacedFrame(end_s, duration_s, placed.copy(), counts.astype(np.float32)))
        self._kept += _FRAME_SAMPLES + placed.size
        while self._frames[0].end_s < end_s - self.config.spectra_window_s or (
            self._kept > _MOST_SAMPLES and len(self._frames) > 1
        ):
            self._kept -= _FRAME_SAMPLES + self._frames.popleft().places.size

    def window(self) -> tuple[PlacedFrame, ...]:
        """The frames that are kept; none while they are of less than half of the time asked for."""
        frames = self._frames
        is_short = len(frames) < 3 or frames[-1].end_s - frames[0].end_s < _LEAST_SHARE * self.config.spectra_window_s
        return () if is_short else tuple(frames)

    def spectra(self, frames: tuple[PlacedFrame, ...] | None = None) -> tuple[Spectrum, ...]:
        """The spectrum of each contact, the strongest first; takes some ten milliseconds.

        Parameters
        ----------
        frames : tuple of PlacedFrame, optional
            What `window` returned, so that one thread can work while another adds; by default what there is now.
        """
        frames = self.window() if frames is None else frames
        if not frames:
            return ()
        window = _in_one(frames)
        size = self._geometry.size
        number = np.bincount(window.places, minlength=size)
        mean = self._mean_of_touch(window, number)
        labels = self._labels(mean)
        contacts = [np.flatnonzero((labels == label) & (number > 0)) for label in np.unique(labels[labels > 0])]
        found = [self._of(window, places, mean) for places in contacts]
        return tuple(sorted((one for one in found if one is not None), key=lambda one: -one.force_n))

    def _mean_of_touch(self, window: _Window, number: NDArray[np.intp]) -> Array:
        """What each taxel reads in the mean; of one that was touched for half of the window, while it was."""
        size = number.size
        mean = np.bincount(window.places, weights=window.counts, minlength=size) / np.maximum(number, 1)
        is_above = window.counts > self._touch_counts
        places, counts = window.places[is_above], window.counts[is_above]
        touched = np.bincount(places, minlength=size)
        while_touched = np.bincount(places, weights=counts, minlength=size) / np.maximum(touched, 1)
        # A light touch that began within the window is none in the mean.
        is_light = (mean <= self._touch_counts) & (touched > 0) & (touched >= _LEAST_SHARE * number)
        return np.where(is_light, while_touched, mean)

    def _labels(self, mean: Array) -> NDArray[np.intp]:
        """The number of the contact that each taxel belongs to, 0: none; shape (taxels,)."""
        from scipy import ndimage

        if self._dead is not None:
            # Only to tell contacts apart: what is estimated has no samples.
            filled = mean.astype(np.float32).reshape(self._shape)
            self._dead.fill(filled, None)
            mean = filled.astype(np.float64).ravel()
        pressed = mean > self._touch_counts
        if self.config.spectra_of == "patches":
            labels = np.where(pressed, self._borders.rectangle_of.astype(np.intp) + 1, 0).reshape(self._shape)
        else:
            labels, _ = self._borders.labelled(pressed.reshape(self._shape))
        for first_row, end_row, first_col, end_col in self._borders.rectangles.tolist():
            own = labels[first_row:end_row, first_col:end_col]
            if own.any():
                # What lies beside carries some of the force, too.
                own[:] = np.where(own > 0, own, ndimage.maximum_filter(own, size=3, mode="constant"))
        return labels.ravel()

    def _of(self, window: _Window, places: NDArray[np.intp], mean: Array) -> Spectrum | None:
        """The spectrum of what presses these taxels; None where there is no force for half of the window."""
        places = places[np.argsort(-mean[places], kind="stable")][:_MOST_TAXELS]
        slot_of = np.full(self._geometry.size, -1, dtype=np.intp)
        slot_of[places] = np.arange(places.size)
        mine = slot_of[window.places] >= 0
        begin_s, end_s = self._pressed(window, (mean > self._touch_counts)[window.places] & mine)
        mine &= (window.time_s >= begin_s) & (window.time_s <= end_s)
        if end_s - begin_s < _LEAST_SHARE * self.config.spectra_window_s or not mine.any():
            return None
        force_n = np.interp(window.counts[mine], np.arange(self._force_n.size), self._force_n)
        # Of a touch that few samples tell of, those of that time may all be of what lies beside it.
        if not force_n.any():
            return None
        whole = np.clip(np.rint(mean[places]), 0, self._slope_n.size - 1).astype(np.intp)
        time_s = window.time_s[mine]
        x_m = np.asarray(self._geometry.x_m(places % self._geometry.cols))
        y_m = np.asarray(self._geometry.y_m(places // self._geometry.cols))
        tones = Tones(
            time_s,
            slot_of[window.places[mine]],
            force_n,
            self._noise_counts * np.maximum(self._slope_n[whole], _LEAST_SLOPE_N),
            x_m,
            y_m,
            window.step_s,
        )
        total = float(tones.mean_n.sum())
        return Spectrum(
            begin_s=float(time_s[0]),
            end_s=float(time_s[-1]),
            x_m=float(tones.mean_n @ x_m) / total,
            y_m=float(tones.mean_n @ y_m) / total,
            force_n=total,
            taxels=places.size,
            sample_rate_hz=1.0 / window.step_s,
            step_hz=_TOLD_EVERY * tones.step_hz,
            amplitude_n=tones.amplitude_n()[::_TOLD_EVERY],
            peaks=tones.peaks(self.config.spectra_lowest_hz, self.config.spectra_peaks),
        )

    def _pressed(self, window: _Window, mine: NDArray[np.bool_]) -> tuple[float, float]:
        """From when to when a contact was there for longest; `mine`: the samples of its pressed taxels.

        A force that begins or ends within the window would be taken for tones: where it does, the part in which it
        rises or falls is left out, too.
        """
        first_s, last_s = float(window.time_s[0]), float(window.time_s[-1])
        edges_s = np.linspace(first_s, last_s, _PARTS + 1)
        part = np.clip(np.searchsorted(edges_s, window.time_s[mine], side="right") - 1, 0, _PARTS - 1)
        is_above = window.counts[mine] > self._touch_counts
        # Where nothing was measured nothing is known.
        measured, pressed = np.bincount(part, minlength=_PARTS), np.bincount(part[is_above], minlength=_PARTS)
        free = np.flatnonzero((measured > 0) & (pressed == 0))
        ends = np.concatenate(([-2], free, [_PARTS + 1]))
        longest = int(np.diff(ends).argmax())
        begin, end = int(ends[longest]) + 2, int(ends[longest + 1]) - 1
        return float(edges_s[begin]), float(edges_s[max(begin, end)])


def _in_one(frames: tuple[PlacedFrame, ...]) -> _Window:
    ends_s, durations_s = (np.array([frame[k] for frame in frames]) for k in (0, 1))
    sizes = np.array([frame.places.size for frame in frames])
    # The last sample ends with its frame; they are evenly spaced.
    before_end = np.repeat(np.cumsum(sizes), sizes) - 1 - np.arange(sizes.sum())
    time_s = np.repeat(ends_s, sizes) - before_end * np.repeat(durations_s / sizes, sizes)
    places, counts = (np.concatenate([frame[k] for frame in frames]) for k in (2, 3))
    # Of a frame that took no time, or does not say how long, each taxel was measured at one moment, however often.
    rounds = _rounds(sizes, places) if np.median(durations_s) > 0 else 1.0
    # Within frames that repeat the pace is even, also where frames are lost.
    steps_s = np.diff(ends_s)
    frame_s = float(np.median(durations_s if rounds > 1 else steps_s[steps_s > 0]))
    return _Window(time_s, places, counts, max(frame_s / rounds, 1e-6))


def _rounds(sizes: NDArray[np.intp], places: NDArray[np.uint16]) -> float:
    """How often a frame has each of its taxels, at least; of frames of these sizes."""
    frame = np.repeat(np.arange(sizes.size), sizes)
    # np.unique takes five times as long.
    ordered = np.sort(frame * 2**16 + places)
    distinct = np.bincount(ordered[np.diff(ordered, prepend=-1) > 0] // 2**16, minlength=sizes.size)
    return float((sizes / distinct).min())
