# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A field that is a known function of taxel and time, so that every sample of every frame can be checked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.frames import SampleFrame

SIDE = 32
SAMPLE_NS = 17_877
_STEP = 6
_PERIOD = 341
"""Frames of the recording, one a millisecond: `_PERIOD * _STEP` counts up from 0 to 1023 and down again."""
_TOLERANCE = 0.52
"""Rounding to whole counts, and of the frame's times to whole microseconds."""


def field() -> NDArray[np.uint16]:
    """Counts of every taxel at every millisecond; np.ndarray [shape=(_PERIOD, SIDE, SIDE)]."""
    taxel = np.arange(SIDE * SIDE).reshape(1, SIDE, SIDE)
    phase = (37 * taxel + _STEP * np.arange(_PERIOD).reshape(-1, 1, 1)) % (_PERIOD * _STEP)
    return np.minimum(phase, _PERIOD * _STEP - phase).clip(0, 1023).astype(np.uint16)


FIELD = field().reshape(_PERIOD, SIDE * SIDE).astype(np.float64)


def options(folder: Path) -> tuple[str, ...]:
    """Options with which a virtual board shows this field, without noise."""
    path = folder / "known.npy"
    np.save(path, field())
    return "--recording", str(path), "--loop", "--noise-counts", "0", "--sample-us", str(SAMPLE_NS / 1000)


def wrong_samples(frame: SampleFrame, end_ns: int) -> int:
    """How many samples of a frame are not those of the field.

    Parameters
    ----------
    frame : SampleFrame
        As published.
    end_ns : int
        End of its last measurement, since the recording began.
    """
    start_ns = end_ns - 1000 * frame.duration_us
    position = (start_ns + SAMPLE_NS * np.arange(len(frame.indices))) * 1e-6 % _PERIOD
    before = position.astype(np.int64) % _PERIOD
    part = position % 1.0
    expected = FIELD[before, frame.indices] * (1 - part) + FIELD[(before + 1) % _PERIOD, frame.indices] * part
    return int((np.abs(frame.counts - expected) > _TOLERANCE).sum())


def measured_at_ns(frame: SampleFrame, field_epoch_ns: int, board_epochs_ns: Sequence[int]) -> int | None:
    """When a frame's measurement ended, if all its samples are right.

    Parameters
    ----------
    frame : SampleFrame
        As published.
    field_epoch_ns : int
        When the recording began, on the host's monotonic clock.
    board_epochs_ns : sequence of int
        The same for board time 0, of every life of the board.

    Returns
    -------
    int or None
        On the host's monotonic clock [ns]; None where a sample is wrong under every epoch.
    """
    assert len(frame.indices) == len(frame.counts) == len(set(frame.indices.tolist())) > 0
    # A jump back of the board's clock looks like a wrap of its 32 bits.
    board_us = (frame.board_us + 2**31) % 2**32 - 2**31
    for epoch_ns in board_epochs_ns:
        end_ns = epoch_ns + 1000 * board_us
        if wrong_samples(frame, end_ns - field_epoch_ns) == 0:
            return end_ns
    return None
