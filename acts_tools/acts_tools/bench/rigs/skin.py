"""A pressed skin for the virtual board, so that frames hold what frames of a real touch hold."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from acts_core.array import COUNT_MAX

_SIDE = 32
_FRAMES = 200
_RADIUS = 8.0
_SPREAD = 2.5


def pressed(folder: Path) -> tuple[str, ...]:
    """Write a recording and return the virtual board's options that play it without end.

    A press the size of a fingertip, 600 counts at its peak, goes round the skin five times a second.

    Parameters
    ----------
    folder : Path
        Where the recording goes.
    """
    angle = 2 * np.pi * np.arange(_FRAMES)[:, None, None] / _FRAMES
    row, col = np.mgrid[:_SIDE, :_SIDE]
    centre = (_SIDE - 1) / 2
    distance2 = (row - centre - _RADIUS * np.sin(angle)) ** 2 + (col - centre - _RADIUS * np.cos(angle)) ** 2
    counts = 600.0 * np.exp(-distance2 / (2 * _SPREAD**2))
    path = folder / "pressed.npy"
    np.save(path, np.clip(np.rint(counts), 0, COUNT_MAX).astype(np.uint16))
    return "--recording", str(path), "--loop"
