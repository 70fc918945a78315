# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sample recordings like a board, recover them by a method, and score every frame.

docs/recovery.md explains the scores.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.frames import last_samples
from acts_core.sampling import MEASUREMENT_US, SCHEMES, SamplingConfig, SkinMap
from acts_core.settings import SettingValue, setting, validate
from acts_core.skin import layout
from acts_recon.images import DeadTaxels
from acts_recon.methods import Method, SkinSetup
from acts_recon.sparse import Dictionary
from acts_tools.evaluate.broken_taxels import BrokenTaxels
from acts_tools.evaluate.estimators.methods import method_named
from acts_tools.evaluate.images import calibration
from acts_tools.evaluate.images.scores import FRAME_SCORES, INVENTED, FrameScores, score_image
from acts_tools.evaluate.images.truth import ContactStart, contact_starts, interpolate
from acts_tools.evaluate.statistics import mean
from acts_tools.firmware.board_sampler import sampler_of
from acts_tools.percentiles import percentiles

_IMAGES_BETWEEN_SHOWS = 500


@dataclass(frozen=True)
class Recording:
    """One continuous recording of the skin.

    Attributes
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts, 0 to 1023. Between them the truth is interpolated linearly.
    rate_hz : float
        Frames per second.
    live : np.ndarray [shape=(rows, cols), dtype=bool]
        Only these taxels are scored.
    """

    frames: NDArray[np.uint16]
    rate_hz: float
    live: NDArray[np.bool_]


@dataclass(frozen=True)
class Task(BrokenTaxels):
    """Settings of one line of the report.

    Attributes
    ----------
    sampling : SamplingConfig
        Settings of the sampling; its `threshold_counts` is that of the search.
    method : str
        See `acts_tools.evaluate.estimators.methods.method_names`.
    rate_hz, touch_counts, sample_us, noise_counts, onset_s, patch_step : see below
    settings : tuple of (str, value)
        Further settings of the method.
    """

    sampling: SamplingConfig
    method: str
    rate_hz: float = setting(1000.0, "largest frame rate; frames of many taxels take longer", minimum=0.1)
    touch_counts: int = setting(50, "a taxel above is pressed", minimum=0, maximum=COUNT_MAX)
    sample_us: float = setting(MEASUREMENT_US, "time of one measurement", minimum=0.01)
    noise_counts: float = setting(
        0.0, "standard deviation of noise that is added to every measurement", minimum=0, maximum=100
    )
    onset_s: float = setting(
        0.020, "time for which a contact counts as new, except in recordings of a single frame", minimum=0
    )
    patch_step: int = setting(4, "taxels between patches, for methods that use patches", minimum=1, maximum=64)
    settings: tuple[tuple[str, SettingValue], ...] = ()

    def __post_init__(self) -> None:
        validate(self)
        self.are_broken(*self._size)
        self.are_dead(*self._size)

    @property
    def _size(self) -> tuple[int, int]:
        return self.sampling.rows, self.sampling.cols

    @property
    def duration_s(self) -> float:
        """Time from the start of a frame's first measurement to the end of its last [s]."""
        return float(self.sampling.frame_size * self.sample_us * 1e-6)

    @property
    def period_s(self) -> float:
        """Time between frames [s]."""
        return max(1.0 / self.rate_hz, self.duration_s)


@dataclass(frozen=True)
class _Frame:
    """One recovered frame: its image, its end, and its scores."""

    image: NDArray[np.float32]
    end_s: float
    spent_us: float
    scores: NDArray[np.float64]
    errors: NDArray[np.float64]
    in_contact: bool
    since_s: float


class _Notices:
    """Delays after which the images show the new contacts of a recording."""

    def __init__(self, recording: Recording, touch_counts: int) -> None:
        self._waiting = contact_starts(recording.frames, recording.live, touch_counts)
        self._waiting.sort(key=lambda start: start.onset, reverse=True)
        self._rate_hz = recording.rate_hz
        self._touch_counts = touch_counts
        self._open: list[ContactStart] = []
        self._last_s = 0.0
        self.first_ms: list[float] = []
        self.further_ms: list[float] = []
        self.missed = 0

    def look(self, frame: _Frame) -> None:
        position = frame.end_s * self._rate_hz
        while self._waiting and self._waiting[-1].onset <= position:
            self._open.append(self._waiting.pop())
        flat = frame.image.ravel()
        still_open = []
        for start in self._open:
            noticed = bool(flat[start.taxels].max() > self._touch_counts)
            if not noticed and position <= start.end:
                still_open.append(start)
                continue
            self._count(start, frame.end_s, noticed)
        self._open = still_open
        self._last_s = frame.end_s

    def end(self) -> None:
        """Count the contacts that not even the last image shows."""
        for start in self._open:
            self._count(start, self._last_s, False)
        self._open = []

    def _count(self, start: ContactStart, end_s: float, noticed: bool) -> None:
        # For a contact that was never shown, this is a lower bound.
        (self.first_ms if start.alone else self.further_ms).append(1e3 * (end_s - start.onset / self._rate_hz))
        self.missed += not noticed


class _Scored:
    """The scores of all frames of a task: settled contacts, their onsets, and the untouched skin."""

    def __init__(self) -> None:
        self._settled, self._onset = FrameScores(), FrameScores()
        self._settled_errors, self._onset_errors = np.zeros(calibration.SUMS), np.zeros(calibration.SUMS)
        self._contact_us: list[float] = []
        self._untouched_us: list[float] = []
        self._untouched_invented: list[float] = []
        self._first_ms: list[float] = []
        self._further_ms: list[float] = []
        self._missed = 0

    def add(self, frame: _Frame, onset_s: float) -> None:
        """Add a frame; a contact counts as new for `onset_s` [s]."""
        if not frame.in_contact:
            self._untouched_us.append(frame.spent_us)
            self._untouched_invented.append(float(frame.scores[INVENTED]))
            return
        new = frame.since_s < onset_s
        (self._onset if new else self._settled).add(frame.scores)
        errors = self._onset_errors if new else self._settled_errors
        errors += frame.errors
        self._contact_us.append(frame.spent_us)

    def add_notices(self, notices: _Notices) -> None:
        """Add the delays of a recording."""
        self._first_ms += notices.first_ms
        self._further_ms += notices.further_ms
        self._missed += notices.missed

    def summary(self, period_s: float) -> dict[str, Any]:
        """Plain numbers of the report; `period_s` is the time between frames [s]."""
        notice_ms = self._first_ms + self._further_ms
        return {
            **self._settled.summary(),
            "sigma": calibration.summary(self._settled_errors),
            "notice_ms": percentiles(notice_ms, ("p50", "p99"), decimals=None),
            "notice_further_ms": percentiles(self._further_ms, ("p50", "p99"), decimals=None),
            "contacts": len(notice_ms),
            "contacts_missed": self._missed,
            "frame_us": percentiles(self._contact_us or self._untouched_us, ("median", "p99"), decimals=None),
            "rate_hz": 1.0 / period_s,
            "onset": {**self._onset.summary(), "sigma": calibration.summary(self._onset_errors)},
            "untouched": {
                "frames": len(self._untouched_invented),
                "invented_rate": mean(self._untouched_invented),
            },
        }


def _skin_of(task: Task) -> SkinSetup:
    """What is known of the skin: also the noise that is added, as by a calibration."""
    geometry = ArrayGeometry(rows=task.sampling.rows, cols=task.sampling.cols)
    dead = task.are_dead(geometry.rows, geometry.cols)
    skin = SkinSetup(geometry, touch_counts=task.touch_counts, dead_taxels=dead)
    # Without noise of ours nothing is known of the noise in a recording: the method's own setting holds.
    return replace(skin, noise_counts=task.noise_counts) if task.noise_counts > 0 else skin


def method_of(task: Task, dictionary: Dictionary) -> Method:
    """Make the recovery method of a task. It is told the noise that is added, as by a calibration.

    Raises
    ------
    ArrayError
        When patches do not fit the array.
    """
    settings = {"patch_step": task.patch_step, **dict(task.settings)}
    return method_named(task.method)(_skin_of(task), dictionary, settings)


def images(recordings: Iterable[Recording], task: Task) -> int:
    """Number of images that `evaluate` recovers, to within one per recording."""
    return sum(
        1 + max(0, int(((len(recording.frames) - 1) / recording.rate_hz - task.duration_s) / task.period_s))
        for recording in recordings
    )


def evaluate(
    recordings: Iterable[Recording], task: Task, dictionary: Dictionary, show: Callable[[int], None] = lambda _: None
) -> dict[str, Any]:
    """Score one task on recordings of one size; `show` is regularly called with the number of images so far.

    Returns
    -------
    dict
        An entry of the report's `results`: plain numbers, or None where there is no value.
    """
    method = method_of(task, dictionary)
    # The first call may compile kernels.
    nothing = np.zeros(task.sampling.m, dtype=np.uint16)
    method.step(np.arange(task.sampling.m, dtype=np.uint16), nothing, 0.0, task.duration_s)
    scored = _Scored()
    number = 0
    for which, recording in enumerate(recordings):
        notices = _Notices(recording, task.touch_counts)
        method.reset()
        its_task = _for_recording(task, which, recording)
        for frame in _play(recording, its_task, method):
            number += 1
            if number % _IMAGES_BETWEEN_SHOWS == 0:
                show(number)
            notices.look(frame)
            scored.add(frame, its_task.onset_s)
        notices.end()
        scored.add_notices(notices)
    if number == 0:
        raise SettingsError(
            f"in no frame other than dead taxels were measured: let {task.sampling.scheme} measure others, or correct "
            "dead_taxels"
        )
    return {
        "scheme": task.sampling.scheme,
        "m": task.sampling.m,
        "method": task.method,
        **scored.summary(task.period_s),
    }


def _for_recording(task: Task, which: int, recording: Recording) -> Task:
    """The task of a recording: a single frame has no onset, and a seed of its own, so not all are sampled alike."""
    if len(recording.frames) > 1:
        return task
    sampling = replace(task.sampling, seed=(task.sampling.seed + which) % 2**64)
    return replace(task, sampling=sampling, onset_s=0.0)


def _play(recording: Recording, task: Task, method: Method) -> Iterator[_Frame]:
    """Sample and recover a recording; at least one frame, with the last image held constant.

    Frames of dead taxels alone are left out, as the node leaves them out.
    """
    size = recording.frames.shape[1:]
    are_dead = task.are_dead(*size)
    # As a driver tells its board.
    skin_map = None if are_dead is None else SkinMap.of(layout("square", *size), are_dead)
    sampler = sampler_of(task.sampling, task.noise_counts, skin_map)
    frames = np.ascontiguousarray(recording.frames)
    sampled = np.where(task.are_broken(*size), np.uint16(0), frames) if task.broken_taxels else frames
    flat = frames.reshape(len(frames), -1)
    truth = np.zeros(flat.shape[1], dtype=np.float32)
    live = recording.live.ravel()
    skin = _skin_of(task)
    dead = None if skin.dead_taxels is None else DeadTaxels(skin.dead_taxels, skin.geometry)
    known = calibration.Calibration(skin.geometry, live, float(task.touch_counts), skin.assumed_noise_counts)
    scores = np.zeros(FRAME_SCORES)
    step = task.sample_us * 1e-6 * recording.rate_hz
    contact_since_s: float | None = None
    begin_s, number = 0.0, 0
    while number == 0 or (begin_s + task.duration_s) * recording.rate_hz <= len(frames) - 1:
        indices, counts = sampler.frame(sampled, begin_s * recording.rate_hz, step)
        end_s = begin_s + task.duration_s
        measured_s = task.duration_s
        if SCHEMES[task.sampling.scheme].repeats:
            # As the node does, see `SampleFrame.once`.
            kept = last_samples(indices)
            measured_s *= len(kept) / len(indices)
            indices, counts = indices[kept], counts[kept]
        number += 1
        begin_s = number * task.period_s
        began = time.perf_counter()
        if dead is not None:
            try:
                indices, counts = dead.left_out(indices, counts)
            except ArrayError:
                continue
        image = method.step(indices, counts, end_s, measured_s)
        if dead is not None:
            dead.fill(image, method.sigma)
        spent_us = 1e6 * (time.perf_counter() - began)
        interpolate(flat, end_s * recording.rate_hz, truth)
        touch = float(task.touch_counts)
        in_contact = score_image(image.ravel(), truth, live, task.sampling.cols, touch, scores)
        errors = np.zeros(calibration.SUMS)
        if in_contact and method.sigma is not None:
            errors = known.errors(image.ravel(), method.sigma.ravel(), truth)
        if not in_contact:
            contact_since_s = None
        elif contact_since_s is None:
            contact_since_s = end_s
        yield _Frame(image, end_s, spent_us, scores, errors, in_contact, end_s - (contact_since_s or 0.0))
