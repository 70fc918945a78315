# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings of one insole or two, and the steps in them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import RATES, half_of_memory_bytes, is_rate, read_npz, recordings_of
from acts_recon.gait import FEET, Gait, GaitConfig, GaitTracker, Step, force_and_centre, summarise

Array = NDArray[np.float64]

_NEEDED = (
    "needed are `frames` (n, feet, rows, cols) or (n, rows, cols), with `t_s` (n) or `rate_hz`, and where there are "
    "several recordings `start` and `length`, or `rec_start` and `rec_len`, of each; or, of one foot, what "
    "`acts export BAG --to npz` writes"
)


@dataclass(frozen=True)
class InsoleRecording:
    """Frames of one insole, or of the left one and the right one.

    Attributes
    ----------
    name : str
    time_s : np.ndarray [shape=(n,), dtype=float64]
        Ascending.
    frames : np.ndarray [shape=(n, feet, rows, cols)]
        The toes at the first row.
    """

    name: str
    time_s: Array
    frames: NDArray[np.generic]


def read_insoles(path: Path) -> list[InsoleRecording]:
    """Read the recordings of a file; those of no frames are left out.

    Raises
    ------
    RecordingError
        When it cannot be read, its arrays do not fit together, or no recording has frames.
    """
    names = ("frames", "image", "t_s", "time_s", "rate_hz", "start", "length", "rec_start", "rec_len", "kind", "label")
    content = read_npz(path, names, error=RecordingError, hint=_NEEDED, limit_bytes=half_of_memory_bytes())
    frames = _frames(path, content)
    time_s = _time_s(path, content, len(frames))
    try:
        starts, lengths = recordings_of(path, content, len(frames))
    except RecordingError as error:
        raise RecordingError(f"{error}; the recordings do not fit: {_NEEDED}") from error
    labels = np.atleast_1d(content.get("kind", content.get("label", np.arange(starts.size))))
    labels = labels if labels.shape == starts.shape else np.arange(starts.size)
    found = []
    for number, (start, length, label) in enumerate(
        zip(starts.tolist(), lengths.tolist(), labels.tolist(), strict=True)
    ):
        if not length:
            continue
        part = np.s_[start : start + length]
        later = np.diff(time_s[part]) > 0
        if not later.all():
            wrong = start + 1 + int(np.argmin(later))
            raise RecordingError(
                f"{path}: the times of recording {number} do not ascend: the frame numbered {wrong} is of "
                f"{time_s[wrong]:.10g} s, the one before of {time_s[wrong - 1]:.10g} s; leave out frames that are not "
                "later than the one before, and mark several recordings by `start` and `length`"
            )
        name = f"{number} {label}" if labels.dtype.kind in "SU" else str(number)
        found.append(InsoleRecording(name, time_s[part], frames[part]))
    if not found:
        raise RecordingError(f"{path}: all recordings have the length 0: {_NEEDED}")
    return found


def _frames(path: Path, content: dict[str, NDArray[Any]]) -> NDArray[np.generic]:
    frames = content.get("frames", content.get("image"))
    if frames is None:
        raise RecordingError(f"{path}: no array `frames`; {_NEEDED}")
    shape = frames.shape
    if frames.ndim == 3:
        frames = frames[:, None]
    if frames.ndim != 4 or not frames.size or frames.shape[1] > len(FEET) or frames.dtype.kind not in "iuf":
        raise RecordingError(f"{path}: frames {shape}, {frames.dtype}: {_NEEDED}")
    # A sum is finite only where all of its numbers are, and takes no copy of the frames.
    finite = np.isfinite(frames.sum((1, 2, 3), dtype=np.float64))
    if not finite.all():
        raise RecordingError(
            f"{path}: {np.count_nonzero(~finite)} of {len(frames)} frames hold NaN or infinity, the first of them is "
            f"numbered {np.argmin(finite)}; needed are numbers: leave these frames out, and give the times of the "
            "others as `t_s`"
        )
    return frames


def _time_s(path: Path, content: dict[str, NDArray[np.generic]], count: int) -> Array:
    """Of each frame, by `t_s`, by the name that an export gives it, or by the rate."""
    for name in ("t_s", "time_s"):
        if name not in content:
            continue
        time_s = content[name]
        if time_s.shape != (count,) or time_s.dtype.kind not in "iuf":
            raise RecordingError(f"{path}: {name} {time_s.shape}, {time_s.dtype}: {_NEEDED}")
        finite = np.isfinite(time_s)
        if not finite.all():
            wrong = int(np.argmin(finite))
            raise RecordingError(
                f"{path}: {name} of the frame numbered {wrong} is {time_s[wrong]}; leave out such frames: {_NEEDED}"
            )
        return time_s.astype(np.float64)
    rate = content.get("rate_hz")
    if rate is None or not is_rate(rate):
        raise RecordingError(f"{path}: neither t_s nor one rate_hz, frames per second ({RATES}): {_NEEDED}")
    return np.arange(count) / float(rate.item())


@dataclass(frozen=True)
class FoundSteps:
    """What `GaitTracker` finds in a recording, sample by sample.

    Attributes
    ----------
    steps : tuple of lists of Step
        Of the left foot and of the right, those that begin and end in the recording.
    begun : tuple of int
        Further ones that begin, but do not end: 0 or 1 of each foot.
    gait : Gait
        Of all steps.
    force : tuple of np.ndarray
        The force curve of each foot that is there.
    """

    steps: tuple[list[Step], list[Step]]
    begun: tuple[int, int]
    gait: Gait
    force: tuple[Array, ...]


def find_steps(recording: InsoleRecording, length_m: float, width_m: float) -> FoundSteps:
    """Find the steps of a recording; the size is that of the insoles [m]."""
    config = GaitConfig()
    tracker = GaitTracker(config)
    feet = [force_and_centre(recording.frames[:, foot], length_m, width_m) for foot in range(recording.frames.shape[1])]
    rows = [list(zip(*(column.tolist() for column in foot), strict=True)) for foot in feet]
    steps: tuple[list[Step], list[Step]] = ([], [])
    for number, time_s in enumerate(recording.time_s.tolist()):
        for foot, of_foot in enumerate(rows):
            steps[foot].extend(tracker.step(foot, time_s, *of_foot[number]))
    for foot, told in enumerate(tracker.finish()):
        steps[foot].extend(told)
    begun = tuple(int(since_s is not None) for since_s in tracker.carries_since_s)
    gait = summarise(*steps, longest_stride_s=config.longest_stride_s)
    return FoundSteps(steps, (begun[0], begun[1]), gait, tuple(force for force, _, _ in feet))
