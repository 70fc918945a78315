# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A recording of a pressed skin for the virtual board, so that frames are like those of a real touch."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from acts_core.array import COUNT_MAX

_SIDE = 32
_FRAMES = 200
_RADIUS = 8.0
_SPREAD = 2.5


def pressed(folder: Path) -> tuple[str, ...]:
    """Write a recording and return the virtual board's options that play it in a loop.

    A press of a fingertip's size, with a peak of 600 counts, circles on the skin five times a second.

    Parameters
    ----------
    folder : Path
        Folder for the recording.
    """
    angle = 2 * np.pi * np.arange(_FRAMES)[:, None, None] / _FRAMES
    row, col = np.mgrid[:_SIDE, :_SIDE]
    centre = (_SIDE - 1) / 2
    distance2 = (row - centre - _RADIUS * np.sin(angle)) ** 2 + (col - centre - _RADIUS * np.cos(angle)) ** 2
    counts = 600.0 * np.exp(-distance2 / (2 * _SPREAD**2))
    path = folder / "pressed.npy"
    np.save(path, np.clip(np.rint(counts), 0, COUNT_MAX).astype(np.uint16))
    return "--recording", str(path), "--loop"
