"""Recorded full frames in an npz file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import RecordingError
from acts_core.npz_file import read_npz


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
        First frame and number of frames of each recording; one recording when the file does not say.
    rate_hz : float or None
        Frames per second; None when the file does not say.
    label : tuple of str
        What each recording shows; empty when the file does not say.
    """

    frames: NDArray[np.uint16]
    live: NDArray[np.bool_]
    start: NDArray[np.int64]
    length: NDArray[np.int64]
    rate_hz: float | None = None
    label: tuple[str, ...] = ()

    def peak_frames(self) -> NDArray[np.uint16]:
        """The frame with the largest sum of each recording; np.ndarray [shape=(n_recordings, rows, cols)]."""
        sums = self.frames.reshape(len(self.frames), -1).sum(axis=1, dtype=np.int64)
        peaks = [s + int(np.argmax(sums[s : s + n])) for s, n in zip(self.start, self.length, strict=True)]
        return self.frames[peaks]


def load_frames(path: Path) -> FramesFile:
    """Read a file of frames.

    Raises
    ------
    RecordingError
        When it cannot be read or its arrays do not fit together.
    """
    needed = "needed is an npz file with an array `frames` (n, rows, cols)"
    content = read_npz(
        path, ("frames", "live", "start", "length", "rate_hz", "label"), error=RecordingError, hint=needed
    )
    if "frames" not in content:
        raise RecordingError(f"{path}: no array `frames`; {needed}")
    frames = content["frames"]
    if frames.ndim != 3 or not len(frames) or not np.issubdtype(frames.dtype, np.number):
        raise RecordingError(f"{path}: frames {frames.shape}, {frames.dtype}: needed are numbers (n, rows, cols)")
    # Written so that NaN fails too.
    if not (np.all(frames >= 0) and np.all(frames <= COUNT_MAX)):
        raise RecordingError(f"{path}: frames must lie between 0 and {COUNT_MAX} ADC counts, without NaN")
    live = content.get("live", np.ones(frames.shape[1:], dtype=bool)).astype(bool)
    start = np.atleast_1d(content.get("start", np.array([0]))).astype(np.int64)
    length = np.atleast_1d(content.get("length", np.array([len(frames)]))).astype(np.int64)
    if live.shape != frames.shape[1:]:
        raise RecordingError(f"{path}: live {live.shape} does not fit frames {frames.shape}")
    if start.shape != length.shape or np.any(start < 0) or np.any(length < 1) or np.any(start + length > len(frames)):
        raise RecordingError(f"{path}: start and length do not mark recordings within {len(frames)} frames")
    rate_hz = None
    if "rate_hz" in content:
        given = content["rate_hz"]
        if given.size != 1 or given.dtype.kind not in "fiu" or not 0 < given.item() < np.inf:
            raise RecordingError(f"{path}: rate_hz = {given}: needed is one positive number of frames per second")
        rate_hz = float(given.item())
    label: tuple[str, ...] = ()
    if "label" in content:
        if content["label"].shape != start.shape or content["label"].dtype.kind != "U":
            raise RecordingError(
                f"{path}: label {content['label'].shape}: needed is a text for each of {start.size} recordings"
            )
        label = tuple(content["label"].tolist())
    return FramesFile(np.rint(frames).astype(np.uint16), live, start, length, rate_hz, label)
