# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Convert recordings of real arrays to the plain frames file that the virtual board replays.

Two kinds of npz files are read. Evaluation files are named as for `acts_core.files.load_frames`: ``frames`` (n, rows,
cols), or ``image`` as in an export of a bag, of 0 to 1023, ``rate_hz``, and optionally ``start`` and ``length`` (and
``label``) of the recordings in them.
Figure files have single ``frames`` (n, rows, cols) of 0 to 1023, not all of them integers, with ``names``, ``kind``
and which taxels were ``measured``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import RecordingError
from acts_core.files.frames_file import rate_hz_of, recordings_of
from acts_core.files.npz_file import half_of_memory_bytes, read_npz
from acts_core.files.whole_file import write_array, write_whole


@dataclass(frozen=True)
class ExportedRecording:
    """Result of an export.

    Attributes
    ----------
    path : Path
        The npy file.
    frames, rows, cols : int
        Its shape.
    rate_hz : float
        Frames per second at which it was recorded; `DEFAULT_RATE_HZ` for single frames.
    labels : tuple of str
        Name of every exported frame (single frames, before repetition) or recording; empty where the file names none.
    """

    path: Path
    frames: int
    rows: int
    cols: int
    rate_hz: float
    labels: tuple[str, ...]


DEFAULT_RATE_HZ = 1.0
"""Rate of single frames, which are recorded without one: slow enough to look at each [Hz]."""


_RATE_HINT = "; add it, or export the bag again with --rate 100"


def export_recording(
    npz_path: Path,
    out_npy: Path,
    *,
    recordings: Sequence[int] | None = None,
    label: str | None = None,
    kind: str | None = None,
    max_frames: int | None = None,
    repeat: int = 1,
) -> ExportedRecording:
    """Write frames as a C-order uint16 npy file (n, rows, cols).

    Parameters
    ----------
    npz_path : Path
        An evaluation file or a figure file.
    out_npy : Path
        Replaced if it exists; never left half written.
    recordings : sequence of int or None
        Indices of recordings of an evaluation file, or of frames of a figure file, in this order; None for all.
    label : str or None
        Only recordings with this label, or frames with this name.
    kind : str or None
        Only frames of this kind of a figure file, for example "full_raster".
    max_frames : int or None
        Largest number of frames before repetition, from the first on.
    repeat : int
        Number of copies of every frame, one after the other.

    Returns
    -------
    ExportedRecording

    Raises
    ------
    RecordingError
        When the file cannot be read, lacks an array, contains anything but counts of measured taxels, or no frame is
        selected.
    """
    if repeat < 1 or (max_frames is not None and max_frames < 1):
        raise RecordingError(f"repeat = {repeat}, max_frames = {max_frames}: allowed is 1 or more")
    content = _load(npz_path)
    frames = _need(content, "frames", npz_path)
    if frames.ndim != 3 or not 1 <= frames.shape[1] <= MAX_SIDE or not 1 <= frames.shape[2] <= MAX_SIDE:
        raise RecordingError(f"{npz_path}: frames of shape {frames.shape}; needed is (n, rows, cols), up to {MAX_SIDE}")
    if "kind" in content:
        chosen, labels = _choose_frames(content, len(frames), recordings, label, kind, npz_path)
        rate_hz, labels = DEFAULT_RATE_HZ, labels[:max_frames]
        _require_measured(content, frames, chosen[:max_frames], npz_path)
    else:
        if kind is not None:
            raise RecordingError(f"{npz_path}: has no kind of frames to choose {kind!r} from")
        chosen, labels = _choose_recordings(content, len(frames), recordings, label, max_frames, npz_path)
        rate_hz = rate_hz_of(npz_path, _need(content, "rate_hz", npz_path, hint=_RATE_HINT))
    chosen = chosen[:max_frames]
    if not len(chosen):
        raise RecordingError(f"{npz_path}: no frames are selected")
    counts = np.repeat(_counts(frames[chosen], npz_path), repeat, axis=0)
    with write_whole(out_npy, error=RecordingError, hint="its folder must exist") as file:
        write_array(file, counts)
    return ExportedRecording(out_npy, len(counts), counts.shape[1], counts.shape[2], rate_hz, labels)


def _load(path: Path) -> dict[str, NDArray]:
    needed = "needed is an npz file with frames and rate_hz"
    content = read_npz(path, error=RecordingError, hint=needed, limit_bytes=half_of_memory_bytes())
    # As an export of a bag names them.
    return {"frames": content["image"], **content} if "image" in content else content


def _need(content: dict[str, NDArray], name: str, path: Path, hint: str = "") -> NDArray:
    if name not in content:
        raise RecordingError(f"{path}: has no array {name!r}, only {', '.join(sorted(content)) or 'nothing'}{hint}")
    return content[name]


def _require_measured(content: dict[str, NDArray], frames: NDArray, chosen: NDArray[np.intp], path: Path) -> None:
    """Refuse frames of a figure file of which not every taxel was measured."""
    measured = _need(content, "measured", path)
    if measured.shape != frames.shape or measured.dtype.kind not in "biuf":
        raise RecordingError(
            f"{path}: measured of shape {measured.shape}, {measured.dtype}: needed is true or false for each taxel of "
            f"frames of {frames.shape}"
        )
    if not measured[chosen].all():
        raise RecordingError(f"{path}: some of the frames are subsampled; choose others, e.g. kind='full_raster'")


def _choose_recordings(
    content: dict[str, NDArray],
    count: int,
    recordings: Sequence[int] | None,
    label: str | None,
    max_frames: int | None,
    path: Path,
) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    start, length = recordings_of(path, content, count)
    names = _names(content, "label", len(start), path)
    which = _which(len(start), names, recordings, label, "recordings", path)
    parts = [np.arange(start[i], start[i] + length[i]) for i in which]
    chosen = np.concatenate(parts) if parts else np.empty(0, dtype=np.intp)
    # Of recordings that `max_frames` leaves out there is no label either.
    begins = np.cumsum([0, *(part.size for part in parts)])
    kept = [i for i, begin in zip(which, begins, strict=False) if max_frames is None or begin < max_frames]
    return chosen, tuple(names[i] for i in kept) if names else ()


def _choose_frames(
    content: dict[str, NDArray],
    count: int,
    recordings: Sequence[int] | None,
    label: str | None,
    kind: str | None,
    path: Path,
) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    names, kinds = _names(content, "names", count, path), _names(content, "kind", count, path)
    which = _which(count, names, recordings, label, "frames", path)
    if kind is not None:
        if kind not in kinds:
            raise RecordingError(f"{path}: no frame of kind {kind!r}; there are {', '.join(sorted(set(kinds)))}")
        which = [i for i in which if kinds[i] == kind]
    return np.array(which, dtype=np.intp), tuple(names[i] for i in which) if names else ()


def _names(content: dict[str, NDArray], name: str, count: int, path: Path) -> list[str]:
    if name not in content:
        return []
    values = content[name]
    if values.shape != (count,):
        raise RecordingError(f"{path}: {name} of shape {values.shape}; needed is one for each, ({count},)")
    return [str(value) for value in values]


def _which(
    count: int, names: list[str], wanted: Sequence[int] | None, label: str | None, what: str, path: Path
) -> list[int]:
    which = list(range(count)) if wanted is None else list(wanted)
    for index in which:
        if not 0 <= index < count:
            raise RecordingError(f"{path}: no number {index} among {count} {what}")
    if label is None:
        return which
    if label not in names:
        raise RecordingError(
            f"{path}: nothing is called {label!r}; there are {', '.join(sorted(set(names))) or 'no names'}"
        )
    return [index for index in which if names[index] == label]


def _counts(frames: NDArray, path: Path) -> NDArray[np.uint16]:
    if frames.dtype.kind not in "iuf":
        raise RecordingError(f"{path}: frames of type {frames.dtype}; needed are counts")
    if not np.isfinite(frames).all():
        raise RecordingError(f"{path}: frames with NaN or infinity; needed are counts from 0 to {COUNT_MAX}")
    rounded = np.rint(frames)
    if rounded.min() < 0 or rounded.max() > COUNT_MAX:
        raise RecordingError(
            f"{path}: counts from {rounded.min():g} to {rounded.max():g}; allowed are 0 to {COUNT_MAX}"
        )
    return np.ascontiguousarray(rounded, dtype=np.uint16)
