# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The truth while a recording is sampled: interpolated frames, and the starts of contacts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from acts_core.kernels import kernel


@kernel
def interpolate(frames: NDArray[np.uint16], position: float, out: NDArray[np.float32]) -> None:
    """Interpolate the image that an ADC would read at one time.

    Parameters
    ----------
    frames : np.ndarray [shape=(n, taxels), dtype=uint16]
    position : float
        Time in frames; constant before the first and after the last.
    out : np.ndarray [shape=(taxels,), dtype=float32]
        Overwritten: rounded counts, interpolated linearly between the frames before and after.
    """
    last = len(frames) - 1
    position = min(max(position, 0.0), float(last))
    before = min(int(position), last)
    after = min(before + 1, last)
    share = position - before
    for taxel in range(out.size):
        first = float(frames[before, taxel])
        out[taxel] = np.floor(first + share * (float(frames[after, taxel]) - first) + 0.5)


@dataclass(frozen=True)
class ContactStart:
    """A region that becomes pressed while neither it nor its neighbours were pressed.

    Attributes
    ----------
    onset : float
        Time at which its first taxel exceeds the threshold, in frames of the recording.
    end : float
        Last frame of the recording up to which one of its taxels is pressed without interruption.
    alone : bool
        Whether nothing else was pressed in the frame before.
    taxels : np.ndarray [shape=(k,), dtype=int64]
        Its taxels in the first recorded frame with it, and their scored neighbours.
    """

    onset: float
    end: float
    alone: bool
    taxels: NDArray[np.int64]


_EIGHT = np.ones((3, 3), dtype=bool)
_CHUNK = 4096


def contact_starts(frames: NDArray[np.uint16], live: NDArray[np.bool_], threshold_counts: int) -> list[ContactStart]:
    """Every new contact of a recording, also beside existing contacts, but not those of its first frame.

    Parameters
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
    live : np.ndarray [shape=(rows, cols), dtype=bool]
    threshold_counts : int
        A taxel above it is pressed.
    """
    starts = []
    for number in _with_new_touch(frames, live, threshold_counts):
        pressed, pressed_before = (frames[[number, number - 1]] > threshold_counts) & live
        labels, count = ndimage.label(pressed, structure=_EIGHT)
        near_before = ndimage.binary_dilation(pressed_before, structure=_EIGHT)
        for label in range(1, count + 1):
            blob = labels == label
            if (blob & near_before).any():
                continue
            before, now = frames[number - 1][blob].astype(float), frames[number][blob].astype(float)
            # Rounded up: a taxel at the threshold is not pressed, and images have integer counts.
            share = float(np.min((threshold_counts + 0.5 - before) / (now - before)))
            end = number
            while end + 1 < len(frames) and (frames[end + 1][blob] > threshold_counts).any():
                end += 1
            around = ndimage.binary_dilation(blob, structure=_EIGHT) & live
            alone = not pressed_before.any()
            starts.append(ContactStart(number - 1 + share, float(end), alone, np.flatnonzero(around)))
    return starts


def _with_new_touch(frames: NDArray[np.uint16], live: NDArray[np.bool_], threshold_counts: int) -> Iterator[int]:
    """Indices of frames with a pressed taxel that was not pressed before; all others can be skipped."""
    # In pieces, because a comparison at once would double the memory of a long recording.
    for begin in range(0, len(frames), _CHUNK):
        pressed = (frames[begin : begin + _CHUNK + 1] > threshold_counts) & live
        any_new = (pressed[1:] & ~pressed[:-1]).any(axis=(1, 2))
        yield from (begin + 1 + np.flatnonzero(any_new)).tolist()
