"""Samples recordings as a board would, has a method recover them, and scores every frame."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import RecordingError
from acts_core.frames_file import FramesFile
from acts_core.sampling import SamplingConfig
from acts_recon.dictionary import Dictionary
from acts_tools.evaluate.board_sampler import BoardSampler
from acts_tools.evaluate.methods import Method, method_named
from acts_tools.evaluate.scores import FRAME_SCORES, FrameScores, score_image
from acts_tools.evaluate.truth import ContactStart, contact_starts, interpolate

ONSET_S = 0.020
"""How long a contact counts as new; these frames are reported apart."""

SAMPLE_US = 17.877
"""Published time of one measurement: 55,936 a second."""


@dataclass(frozen=True)
class Task:
    """One line of the report.

    Attributes
    ----------
    sampling : SamplingConfig
        Its `threshold_counts` is the search's.
    method : str
        See `acts_tools.evaluate.methods.METHODS`.
    rate_hz : float
        Frames begin no closer than this; a frame of many taxels takes longer.
    touch_counts : int
        A taxel above it is pressed.
    sample_us : float
        Time of one measurement.
    """

    sampling: SamplingConfig
    method: str
    rate_hz: float = 1000.0
    touch_counts: int = 50
    sample_us: float = SAMPLE_US

    @property
    def duration_s(self) -> float:
        """From the beginning of the first measurement of a frame to the end of the last [s]."""
        config = self.sampling
        m = config.rows * config.cols if config.scheme == "raster" else config.m
        return m * self.sample_us * 1e-6

    @property
    def period_s(self) -> float:
        """From frame to frame [s]."""
        return max(1.0 / self.rate_hz, self.duration_s)


class _Notices:
    """Which of a recording's new contacts the images have shown so far, and how late."""

    def __init__(self, starts: Sequence[ContactStart], rate_hz: float, touch_counts: int) -> None:
        self._waiting = sorted(starts, key=lambda start: start.onset)
        self._rate_hz = rate_hz
        self._touch_counts = touch_counts
        self._open: list[ContactStart] = []
        self.delays_ms: list[float] = []
        self.missed = 0

    def look(self, image: NDArray[np.float32], end_s: float) -> None:
        position = end_s * self._rate_hz
        while self._waiting and self._waiting[0].onset <= position:
            self._open.append(self._waiting.pop(0))
        still_open = []
        for start in self._open:
            late_ms = 1e3 * (end_s - start.onset / self._rate_hz)
            if image[start.taxels].max() > self._touch_counts:
                self.delays_ms.append(late_ms)
            elif position > start.end:
                # It went unnoticed: at least so late.
                self.delays_ms.append(late_ms)
                self.missed += 1
            else:
                still_open.append(start)
        self._open = still_open


def evaluate(recorded: FramesFile, task: Task, dictionary: Dictionary) -> dict[str, object]:
    """Score one task on all recordings of a file.

    Returns
    -------
    dict
        An entry of the report's `results`.

    Raises
    ------
    RecordingError
        When the file does not say how fast the frames were recorded.
    """
    recorded_hz = recorded.rate_hz
    if recorded_hz is None:
        raise RecordingError("the frames have no rate_hz: needed is how many of them were recorded per second")
    geometry = ArrayGeometry(rows=task.sampling.rows, cols=task.sampling.cols)
    method = method_named(task.method)(geometry, dictionary, task.touch_counts)
    settled, onset = FrameScores(), FrameScores()
    durations_us: list[float] = []
    delays_ms: list[float] = []
    missed = 0
    for start, length in zip(recorded.start, recorded.length, strict=True):
        frames = np.ascontiguousarray(recorded.frames[start : start + length])
        notices = _Notices(contact_starts(frames, recorded.live, task.touch_counts), recorded_hz, task.touch_counts)
        method.reset()
        for image, scores, since_s, spent_us, end_s in _play(frames, recorded_hz, recorded.live, task, method):
            durations_us.append(spent_us)
            notices.look(image, end_s)
            if scores is not None:
                (onset if since_s < ONSET_S else settled).add(scores)
        delays_ms += notices.delays_ms
        missed += notices.missed
    return {
        "scheme": task.sampling.scheme,
        "m": task.sampling.m,
        "method": task.method,
        **settled.summary(),
        "notice_ms": _percentiles(delays_ms, 50, 99),
        "contacts": len(delays_ms),
        "contacts_missed": missed,
        "frame_us": {"median": float(np.median(durations_us)), "p99": float(np.percentile(durations_us, 99))},
        "rate_hz": 1.0 / task.period_s,
        "onset": onset.summary(),
    }


def _play(
    frames: NDArray[np.uint16], recorded_hz: float, live_taxels: NDArray[np.bool_], task: Task, method: Method
) -> Iterator[tuple[NDArray[np.float32], NDArray[np.float64] | None, float, float, float]]:
    """Yield image, scores (None without contact), time since the contact began [s], time spent [us], and end [s]."""
    sampler = BoardSampler(task.sampling)
    flat = frames.reshape(len(frames), -1)
    truth = np.zeros(flat.shape[1], dtype=np.float32)
    live = live_taxels.ravel()
    scores = np.zeros(FRAME_SCORES)
    cols = task.sampling.cols
    step = task.sample_us * 1e-6 * recorded_hz
    contact_since_s: float | None = None
    begin_s, number = 0.0, 0
    while (begin_s + task.duration_s) * recorded_hz <= len(frames) - 1:
        indices, counts = sampler.frame(frames, begin_s * recorded_hz, step)
        end_s = begin_s + task.duration_s
        began = time.perf_counter()
        image = method.step(indices, counts, end_s, task.duration_s).ravel()
        spent_us = 1e6 * (time.perf_counter() - began)
        interpolate(flat, end_s * recorded_hz, truth)
        in_contact = score_image(image, truth, live, cols, float(task.touch_counts), scores)
        if not in_contact:
            contact_since_s = None
        elif contact_since_s is None:
            contact_since_s = end_s
        yield image, scores if in_contact else None, end_s - (contact_since_s or 0.0), spent_us, end_s
        number += 1
        begin_s = number * task.period_s


def _percentiles(values: Sequence[float], low: int, high: int) -> dict[str, float | None]:
    if not values:
        return {f"p{low}": None, f"p{high}": None}
    return {f"p{low}": float(np.percentile(values, low)), f"p{high}": float(np.percentile(values, high))}
