# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded full frames in an npz file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import RecordingError
from acts_core.files.npz_file import half_of_memory_bytes, read_npz

_CHUNK = 4096
"""Frames rounded at a time."""

_RATE_MIN_HZ, _RATE_MAX_HZ = 1e-3, 1e6
"""Other rates are mistakes: a recording at one of them lasts for months, or for less than a measurement."""

RATES = f"allowed are {_RATE_MIN_HZ:g} to {_RATE_MAX_HZ:g}"
"""Words for the rates of `is_rate` [Hz]."""


@dataclass(frozen=True)
class FramesFile:
    """Frames and how they belong together.

    Attributes
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        ADC counts, 0 to 1023.
    live : np.ndarray [shape=(rows, cols), dtype=bool]
        Where there is a taxel; all True when the file does not say.
    start, length : np.ndarray [shape=(n_recordings,), dtype=int64]
        First frame and number of frames of each recording; one recording when the file does not say. They may be
        called `rec_start` and `rec_len` in the file.
    rate_hz : float or None
        Frames per second; None when the file does not say.
    label : tuple of str
        What each recording shows; empty when the file does not say, or was not asked.
    """

    frames: NDArray[np.uint16]
    live: NDArray[np.bool_]
    start: NDArray[np.int64]
    length: NDArray[np.int64]
    rate_hz: float | None = None
    label: tuple[str, ...] = ()

    def peaks(self) -> list[int]:
        """Of each recording the index of the frame with most counts on live taxels."""
        sums = np.einsum("nrc,rc->n", self.frames, self.live, dtype=np.int64, casting="unsafe")
        return [int(s + np.argmax(sums[s : s + n])) for s, n in zip(self.start, self.length, strict=True)]

    def peak_frames(self) -> NDArray[np.uint16]:
        """The frames of `peaks`; np.ndarray [shape=(n, rows, cols)]."""
        return self.frames[self.peaks()]


def without_contact(largest_counts: int, touch_counts: float) -> str:
    """Words for frames in which nothing is pressed, which mostly have another unit.

    Parameters
    ----------
    largest_counts : int
        Largest count of all frames.
    touch_counts : float
        A taxel is pressed above this.
    """
    return (
        f"the largest count is {largest_counts}, and only what is above {touch_counts:g} is a contact, so there is "
        f"none; needed are ADC counts of 10 bits, 0 to {COUNT_MAX} (multiply volts by {COUNT_MAX} / full scale)"
    )


def load_frames(path: Path, *, labels: bool = False, limit_bytes: int | None = None) -> FramesFile:
    """Read a file of frames; recordings of no frames are left out.

    Parameters
    ----------
    path : Path
        An npz file.
    labels : bool
        Whether to read what each recording shows: text or numbers, as `label`.
    limit_bytes : int or None
        How much the arrays may take unpacked, and half as much again while frames are converted; None for half of the
        memory of this machine.

    Raises
    ------
    RecordingError
        When it cannot be read or its arrays do not fit together.
    """
    needed = (
        "needed is an npz file with an array `frames` (n, rows, cols), or what "
        "`acts export BAG --to npz --rate 100` writes"
    )
    names = ["frames", "image", "live", "start", "length", "rec_start", "rec_len", "rate_hz"]
    names += ["label"] if labels else []
    limit_bytes = half_of_memory_bytes() if limit_bytes is None else limit_bytes
    content = read_npz(path, names, error=RecordingError, hint=needed, limit_bytes=limit_bytes)
    given = content.get("frames", content.get("image"))
    if given is None:
        raise RecordingError(f"{path}: no array `frames`; {needed}")
    frames = _frames(path, given, limit_bytes)
    live = _live(path, content.get("live"), frames.shape)
    start, length = recordings_of(path, content, len(frames))
    label: tuple[str, ...] = ()
    if "label" in content:
        given = np.atleast_1d(content["label"])
        if given.shape != start.shape or given.dtype.kind not in "Uiu":
            raise RecordingError(
                f"{path}: label {given.shape}, {given.dtype}: needed is a text or a whole number for each of "
                f"{start.size} recordings"
            )
        label = tuple(given[length > 0].astype(str).tolist())
    start, length = start[length > 0], length[length > 0]
    if not start.size:
        raise RecordingError(f"{path}: no recording has a frame; `length` says how many each of them has")
    rate_hz = rate_hz_of(path, content["rate_hz"]) if "rate_hz" in content else None
    return FramesFile(frames, live, start, length, rate_hz, label)


def _frames(path: Path, given: NDArray, limit_bytes: int) -> NDArray[np.uint16]:
    if given.ndim != 3 or not given.size or given.dtype.kind not in "iuf":
        raise RecordingError(f"{path}: frames {given.shape}, {given.dtype}: needed are numbers (n, rows, cols)")
    is_copied = given.dtype != np.uint16 or not given.flags.c_contiguous
    both_bytes = given.nbytes + given.size * np.dtype(np.uint16).itemsize
    # Half as much again as the file may hold: with the file's array, frames of one byte each take three times as much.
    if is_copied and both_bytes > limit_bytes * 3 // 2:
        raise RecordingError(
            f"{path}: frames of {given.dtype} take {both_bytes / 1e6:.0f} MB while they become uint16; allowed are "
            f"{limit_bytes * 1.5e-6:.0f} MB; save them as uint16, the last index running fastest"
        )
    # Neither a comparison nor a copy of the whole: recordings may fill half of the memory. Written so that NaN fails.
    if not 0 <= given.min() <= given.max() <= COUNT_MAX:
        raise RecordingError(
            f"{path}: frames hold {given.min()} to {given.max()}; they must lie between 0 and {COUNT_MAX} ADC counts, "
            f"without NaN ({_remedy(given)})"
        )
    if given.dtype.kind != "f":
        return np.ascontiguousarray(given, dtype=np.uint16)
    frames = np.empty(given.shape, dtype=np.uint16)
    for begin in range(0, len(given), _CHUNK):
        frames[begin : begin + _CHUNK] = np.rint(given[begin : begin + _CHUNK])
    return frames


def _remedy(given: NDArray) -> str:
    """What to do with frames that are no counts of 10 bits."""
    if np.isnan(given.min()):
        return "leave out frames that hold NaN; where a taxel always does, write 0 and mark it false in `live`"
    if given.min() < 0:
        return "set to 0 what is below, as where a baseline was subtracted"
    return "divide counts of 12 bits by 4"


def _live(path: Path, given: NDArray | None, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    if given is None:
        return np.ones(shape[1:], dtype=bool)
    if given.shape != shape[1:]:
        raise RecordingError(f"{path}: live {given.shape} does not fit frames {shape}")
    if given.dtype.kind not in "biuf" or np.isnan(given).any():
        raise RecordingError(f"{path}: live, {given.dtype}: needed are true and false, or 1 and 0")
    if not given.any():
        raise RecordingError(f"{path}: no taxel is live; needed are taxels that `live` marks as true, or no `live`")
    return given.astype(bool)


def recordings_of(path: Path, content: dict[str, NDArray[Any]], n: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First frame and number of frames of each recording in an npz file; one of all frames when it does not say.

    Parameters
    ----------
    path : Path
        The file, for messages.
    content : dict
        Its arrays: `start` and `length`, or `rec_start` and `rec_len`.
    n : int
        Number of frames of all recordings.

    Raises
    ------
    RecordingError
        When they are no whole numbers, or mark frames that are not there.
    """
    start = np.atleast_1d(content.get("start", content.get("rec_start", np.array([0]))))
    length = np.atleast_1d(content.get("length", content.get("rec_len", np.array([n]))))
    for name, given in (("start", start), ("length", length)):
        # As numbers of frames they are whole; a float that is none of them fails, NaN too.
        if given.ndim != 1 or given.dtype.kind not in "iuf" or not np.all(given == np.floor(given)):
            raise RecordingError(
                f"{path}: {name} {given.shape}, {given.dtype}: needed is one whole number for each recording"
            )
    if start.shape != length.shape:
        raise RecordingError(
            f"{path}: start has {start.size} numbers, length {length.size}: needed is one for every recording"
        )
    # Compared before they are converted: what int64 does not hold would come out as something else.
    outside = (start < 0) | (start > n) | (length < 0) | (length > n)
    if not outside.any():
        start, length = start.astype(np.int64), length.astype(np.int64)
        outside = start + length > n
    if outside.any():
        first = int(np.argmax(outside))
        raise RecordingError(
            f"{path}: start and length do not mark recordings within {n} frames: the one numbered {first} starts at "
            f"{start[first]} and has {length[first]}; none can reach beyond the {n} frames"
        )
    return start, length


def rate_hz_of(path: Path, given: NDArray[Any]) -> float:
    """Frames per second by the array `rate_hz` of an npz file.

    Raises
    ------
    RecordingError
        When it is no rate, see `is_rate`.
    """
    if not is_rate(given):
        raise RecordingError(f"{path}: rate_hz = {given} frames per second; {RATES}: needed is one positive number")
    return float(given.item())


def is_rate(rate_hz: NDArray[Any]) -> bool:
    """Whether an array holds one number, and it can be frames per second."""
    is_number = rate_hz.size == 1 and rate_hz.dtype.kind in "fiu"
    return is_number and bool(_RATE_MIN_HZ <= rate_hz.item() <= _RATE_MAX_HZ)
