# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings that stand in for a board: frames of samples out of files."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import RecordingError
from acts_core.files import (
    RATES,
    UNPACKED_BYTES_MAX,
    FramesFile,
    is_rate,
    is_there,
    load_frames,
    npz_names,
    path_of,
    read_npz,
)
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import (
    MEASUREMENT_US,
    REPEATING,
    SCHEME_NUMBERS,
    Sampler,
    SamplingConfig,
    SkinMap,
    measure_in,
)

BOARD_RATE_HZ = 1000.0
"""Frames per second at which recorded full frames are sampled unless something else is asked."""


class Recording(Protocol):
    """Frames that can be gone through again and again."""

    def frames(self) -> Iterator[SampleFrame]:
        """One pass. `board_us` is the time of the recording, from any zero.

        Raises `RecordingError` where the recording is damaged.
        """


class SeekableRecording(Protocol):
    """A recording that need not be gone through from its beginning."""

    @property
    def length_us(self) -> int:
        """From the first frame to the last, as far as can be known without reading all [us]."""

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        """One pass; see `Recording.frames`.

        Parameters
        ----------
        from_us : int
            Leave out what is earlier, counted from the first frame [us].
        """


@dataclass(frozen=True)
class ReplayOptions:
    """What is to be replayed.

    Attributes
    ----------
    path : Path
        A bag (folder, MCAP or SQLite file) or an npz file.
    topic : str
        Topic of a bag; empty for its only one of type TactileSamples.
    frames_hz : float
        Frames per second of full frames; 0 for the file's own `rate_hz`.
    sampling : callable
        From rows and columns to how full frames are sampled.
    rate_cap_hz : float
        At most so many samplings per second of full frames; 0 for `BOARD_RATE_HZ`.
    skin_map : callable
        From rows and columns to how the taxels of full frames lie on the skin.
    """

    path: Path
    topic: str = ""
    frames_hz: float = 0.0
    sampling: Callable[[int, int], SamplingConfig] = lambda rows, cols: SamplingConfig(rows=rows, cols=cols)
    rate_cap_hz: float = 0.0
    skin_map: Callable[[int, int], SkinMap | None] = lambda rows, cols: None


def open_recording(options: ReplayOptions) -> SeekableRecording:
    """Open a recording, and read enough of it to know that it can be replayed.

    Raises
    ------
    RecordingError
        The file is missing, damaged, or lacks what is needed.
    SettingsError, ArrayError
        Its array cannot be sampled as asked.
    """
    path = path_of(str(options.path), error=RecordingError)
    if not is_there(path, error=RecordingError):
        raise RecordingError(f"there is no recording '{path}'; give a bag (folder, .mcap or .db3) or an .npz file")
    if path.suffix == ".npz":
        if "indices" in npz_names(path):
            return RecordedSamples.load(path)
        content = load_frames(path, limit_bytes=UNPACKED_BYTES_MAX)
        rows, cols = content.frames.shape[1:]
        if max(rows, cols) > MAX_SIDE:
            raise RecordingError(f"{path}: frames of {rows} x {cols} taxels; an array has up to {MAX_SIDE} each way")
        return SampledFrames(
            content,
            _rate_of(content, options.frames_hz, path),
            options.sampling(rows, cols),
            options.rate_cap_hz,
            options.skin_map(rows, cols),
        )
    if path.is_dir() or path.suffix in (".mcap", ".db3"):
        # Late: rosbags is needed for bags alone.
        try:
            from acts_driver.replay.bag_recording import BagRecording
        except ModuleNotFoundError as error:
            raise RecordingError(
                f"'{path}' is a bag, which needs ROS's packages to be read ({error.name} is missing here); "
                "give an .npz file, or start this in the environment of ACTS (./acts run ...)"
            ) from error

        return BagRecording(path, options.topic)
    raise RecordingError(
        f"'{path}' is no recording that can be replayed: needed is a bag (folder, .mcap or .db3), or an .npz file "
        "with samples (indices, counts) or full frames (frames, rate_hz)"
    )


class SampledFrames:
    """Full frames, sampled as a board would sample the skin while it lives through them.

    Values between two recorded frames are interpolated. A frame sees the skin as it is at the end of its last
    measurement.

    Parameters
    ----------
    content : FramesFile
        The frames.
    frames_hz : float
        Frames per second.
    sampling : SamplingConfig
        How the taxels are chosen; every pass begins with a new `Sampler`.
    rate_cap_hz : float
        At most so many samplings per second; 0 for `BOARD_RATE_HZ`.
    skin_map : SkinMap or None
        See `acts_core.sampling.Sampler`.
    """

    def __init__(
        self,
        content: FramesFile,
        frames_hz: float,
        sampling: SamplingConfig,
        rate_cap_hz: float,
        skin_map: SkinMap | None,
    ) -> None:
        self._map = skin_map
        self._frames = content.frames
        self._frames_hz = frames_hz
        self._sampling = sampling
        self._duration_us = sampling.frame_size * MEASUREMENT_US
        self._period_us = max(1e6 / (rate_cap_hz or BOARD_RATE_HZ), self._duration_us)
        self._count = max(1, int(len(self._frames) / self._frames_hz * 1e6 / self._period_us))

    @property
    def length_us(self) -> int:
        """See `SeekableRecording.length_us`."""
        return round((self._count - 1) * self._period_us)

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        """One pass; see `SeekableRecording.frames`."""
        sampler = Sampler(self._sampling, self._map)
        scheme = Scheme(SCHEME_NUMBERS[self._sampling.scheme])
        for sequence in range(math.ceil(from_us / self._period_us), self._count):
            end_us = sequence * self._period_us + self._duration_us
            indices, counts = sampler.frame(measure_in(self._at(end_us)))
            yield SampleFrame(
                sequence=sequence,
                board_us=round(end_us),
                duration_us=round(self._duration_us),
                scheme=scheme,
                rows=self._sampling.rows,
                cols=self._sampling.cols,
                overruns=0,
                indices=indices,
                counts=counts,
            )

    def _at(self, time_us: float) -> NDArray[np.uint16]:
        before, share = divmod(time_us * 1e-6 * self._frames_hz, 1.0)
        last = len(self._frames) - 1
        if before >= last:
            return self._frames[last]
        first, second = self._frames[int(before)], self._frames[int(before) + 1]
        return np.rint(first * (1 - share) + second * share).astype(np.uint16)


class RecordedSamples:
    """Frames of samples out of an npz file.

    Needed are `indices` and `counts` (n, m), and either `stamp_ns` (n,) or `rate_hz`; optional are `sequence` (n,),
    `duration_us`, `scheme` (a name or number), `rows` and `cols` (32).

    Attributes
    ----------
    first_ns : int or None
        `stamp_ns` of the first frame; None where the file has none.
    """

    def __init__(
        self,
        indices: NDArray[np.uint16],
        counts: NDArray[np.uint16],
        board_us: NDArray[np.int64],
        sequence: NDArray[np.int64],
        size: tuple[int, int],
        scheme: Scheme,
        duration_us: int,
        first_ns: int | None = None,
    ) -> None:
        self._indices = indices
        self._counts = counts
        self._board_us = board_us
        self._sequence = sequence
        self._size = size
        self._scheme = scheme
        self._duration_us = duration_us
        self.first_ns = first_ns

    @classmethod
    def load(cls, path: Path) -> RecordedSamples:
        """Read a file.

        Raises
        ------
        RecordingError
            It cannot be read, or its arrays do not fit together.
        """
        content = read_npz(path, error=RecordingError, hint="longer ones as a bag, which is not read whole")
        for name in ("indices", "counts"):
            if name not in content or content[name].ndim != 2 or content[name].dtype.kind not in "iu":
                raise RecordingError(f"{path}: needed are whole numbers indices (n, m) and counts (n, m)")
        indices, counts = content["indices"], content["counts"]
        n = len(indices)
        if indices.shape != counts.shape or not indices.size:
            raise RecordingError(
                f"{path}: indices {indices.shape} and counts {counts.shape}: needed is (n, m) for both"
            )
        size = (_whole(path, content, "rows", 32, 1, MAX_SIDE), _whole(path, content, "cols", 32, 1, MAX_SIDE))
        scheme = _scheme(path, content)
        ordered = np.sort(indices, axis=1)
        is_twice = scheme not in REPEATING and (ordered[:, 1:] == ordered[:, :-1]).any()
        if ordered.min() < 0 or ordered.max() >= size[0] * size[1] or is_twice:
            raise RecordingError(f"{path}: indices must be taxels of {size[0]} x {size[1]}, none twice in a frame")
        if counts.min() < 0 or counts.max() > COUNT_MAX:
            raise RecordingError(f"{path}: counts must lie between 0 and {COUNT_MAX}")
        sequence = content.get("sequence", np.arange(n))
        if sequence.shape != (n,) or sequence.dtype.kind not in "iu":
            raise RecordingError(f"{path}: sequence {sequence.shape}: needed are {n} whole numbers")
        return cls(
            indices.astype(np.uint16),
            counts.astype(np.uint16),
            _times_us(path, content, n),
            sequence.astype(np.int64),
            size,
            scheme,
            _whole(path, content, "duration_us", round(indices.shape[1] * MEASUREMENT_US), 0, 2**32 - 1),
            int(content["stamp_ns"][0]) if "stamp_ns" in content else None,
        )

    @property
    def length_us(self) -> int:
        """See `SeekableRecording.length_us`."""
        return int(self._board_us[-1] - self._board_us[0])

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        """One pass; see `SeekableRecording.frames`."""
        for row in range(int(np.searchsorted(self._board_us, self._board_us[0] + from_us)), len(self._indices)):
            yield SampleFrame(
                sequence=int(self._sequence[row]),
                board_us=int(self._board_us[row]),
                duration_us=self._duration_us,
                scheme=self._scheme,
                rows=self._size[0],
                cols=self._size[1],
                overruns=0,
                indices=self._indices[row],
                counts=self._counts[row],
            )


def _rate_of(content: FramesFile, given_hz: float, path: Path) -> float:
    """Frames per second of full frames: as given, or 0 for the file's own."""
    rate_hz = given_hz or content.rate_hz
    if rate_hz is None:
        raise RecordingError(
            f"{path}: rate_hz is missing, the number of frames per second; add it to the file, or export the bag again "
            "with --rate 100; for a driver, its parameter replay_frames_hz says it as well"
        )
    if not is_rate(np.array(rate_hz)):
        raise RecordingError(f"{path}: {rate_hz:g} frames per second; {RATES}")
    return rate_hz


def _times_us(path: Path, content: dict[str, NDArray[Any]], n: int) -> NDArray[np.int64]:
    if "stamp_ns" in content:
        stamps = content["stamp_ns"]
        if stamps.shape != (n,) or stamps.dtype.kind not in "iu" or (stamps[1:] <= stamps[:-1]).any():
            raise RecordingError(
                f"{path}: stamp_ns {stamps.shape}, {stamps.dtype}: needed are {n} ascending whole numbers"
            )
        # Differences of uint64 are right for every type, also where the stamps themselves fit no int64.
        since_first_ns = stamps.astype(np.uint64) - stamps[0].astype(np.uint64)
        return (since_first_ns // 1000).astype(np.int64)
    rate_hz = content.get("rate_hz", np.array(0.0))
    if not is_rate(rate_hz):
        raise RecordingError(f"{path}: needed is stamp_ns (n,) or rate_hz, frames per second; {RATES}")
    return np.rint(np.arange(n) * (1e6 / rate_hz.item())).astype(np.int64)


def _scheme(path: Path, content: dict[str, NDArray[Any]]) -> Scheme:
    given = content.get("scheme", np.array(0))
    value = given.item() if given.size == 1 else None
    if value in SCHEME_NUMBERS:
        return Scheme(SCHEME_NUMBERS[value])
    if isinstance(value, int) and value in list(Scheme):
        return Scheme(value)
    raise RecordingError(
        f"{path}: scheme {_shown(given)}: needed is one of {', '.join(SCHEME_NUMBERS)}, or a number of Scheme"
    )


def _whole(path: Path, content: dict[str, NDArray[Any]], name: str, default: int, lowest: int, highest: int) -> int:
    given = content.get(name, np.array(default))
    if given.size != 1 or given.dtype.kind not in "iu" or not lowest <= given.item() <= highest:
        raise RecordingError(f"{path}: {name} = {_shown(given)}: needed is a whole number from {lowest} to {highest}")
    return int(given.item())


def _shown(given: NDArray[Any]) -> str:
    """A single value; of others the shape, because a recording has thousands."""
    return f"{given.item()}" if given.size == 1 else f"an array of shape {given.shape}"
