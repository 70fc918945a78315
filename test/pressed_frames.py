# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a pressed skin measures."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def press(
    row: float, col: float, width: float = 2.5, peak: float = 800, shape: tuple[int, int] = (32, 32)
) -> NDArray[np.uint16]:
    """A round contact; counts of that shape."""
    r, c = np.indices(shape)
    return np.rint(peak * np.exp(-((r - row) ** 2 + (c - col) ** 2) / (2 * width**2))).astype(np.uint16)


def disc_recording(folder: Path) -> Path:
    """A recording of a disc of 21 taxels pressed at rest, off the centre, where 55 samples see all of it."""
    rows, cols = np.mgrid[:32, :32]
    disc = np.where(np.hypot(rows - 8, cols - 24) < 2.6, 700, 0).astype(np.uint16)
    path = folder / "disc.npy"
    np.save(path, np.repeat(disc[np.newaxis], 4, axis=0))
    return path
